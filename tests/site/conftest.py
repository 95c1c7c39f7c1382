"""A small study with real, tiny clips, and its site on a real port."""

from __future__ import annotations

import hashlib
import re
import socket
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
import uvicorn
from imageio_ffmpeg import write_frames
from playwright.sync_api import Browser, BrowserContext, Page, expect, sync_playwright
from sqlalchemy import select

from renderer.clip import ClipSpec
from renderer.manifest import ClipRecord, Manifest, write_manifest
from renderer.sources import code_version
from study.data import events, export, jobs, participants, researchers, studies
from study.data.database import Database, open_database
from study.data.schema import ResearcherRow
from study.design.definition import StudyDefinition, parse_definition, read_definition
from study.settings import Settings
from study.site.app import create_app
from study.site.signatures import simulation_token

WIDTH, HEIGHT, FPS, FRAMES = 320, 180, 30, 15
PASSWORD = "correct horse battery"


def small_definition(**changes: Any) -> StudyDefinition:
    """The thesis's study with one practice clip, two trials, one tiny size, half a second each."""
    data = read_definition("thesis").model_dump(mode="json", exclude_unset=True)
    data |= {
        "key": "small",
        "translations": {},  # tests change words
        "sizes": [f"{WIDTH}x{HEIGHT}"],
        "clips": data["clips"][:2],
        "orbit": {"duration_s": FRAMES / FPS, "fps": FPS, "directions": ["rightward"]},
        # A loaded machine drops frames: whether a play counts is asked where a test is about it.
        "certificate": {"retries": 0},
    }
    return parse_definition(data | changes)


@pytest.fixture(scope="session")
def make_video(tmp_path_factory: pytest.TempPathFactory) -> Callable[[int], bytes]:
    """Return H.264 videos that differ by a number: a moving bar on mid-grey."""
    folder = tmp_path_factory.mktemp("videos")

    def make(number: int) -> bytes:
        path = folder / f"{number}.mp4"
        if not path.exists():
            encoder = write_frames(
                path,
                (WIDTH, HEIGHT),
                fps=FPS,
                codec="libx264",
                macro_block_size=1,
                output_params=["-map_metadata", "-1"],
            )
            encoder.send(None)
            for frame in range(FRAMES):
                picture = np.full((HEIGHT, WIDTH, 3), 128, np.uint8)
                picture[20 + 5 * number : 40 + 5 * number, frame * 20 : frame * 20 + 30] = 230
                encoder.send(picture.tobytes())
            encoder.close()
        return path.read_bytes()

    return make


@dataclass
class Site:
    """A running site and what a test needs to look behind it."""

    url: str
    db: Database
    study: studies.Study
    settings: Settings

    @property
    def by_name(self) -> str:
        """The same site under a host name: to browsers no secure context."""
        return self.url.replace("127.0.0.1", "study.test")

    def guest(self, **headers: str) -> Guest:
        """Return a browser that nobody has used."""
        return Guest(self.url, **headers)

    def people(self) -> list[participants.Participant]:
        """Return everybody who takes part, in order of arrival."""
        names = export.tables(self.db, self.study).participants["participant"]
        found = [participants.by_public_id(self.db, self.study, name) for name in names]
        return [person for person in found if person is not None]

    @property
    def simulation(self) -> dict[str, str]:
        """The header that proves a simulated participant."""
        return {"X-Ocularist-Simulation": simulation_token(self.settings.secret_key())}


def fill_shelf(
    site_folder: Path, definition: StudyDefinition, make: Callable[[int], bytes]
) -> None:
    """Put a tiny video for every clip of a study on the shelf, with its manifest."""
    site_folder.mkdir(parents=True, exist_ok=True)
    manifest = Manifest()
    for number, wanted in enumerate(definition.wanted_specs()):
        manifest.add(_record(wanted.spec, site_folder, make(number)))
    write_manifest(manifest, site_folder)


def _record(spec: ClipSpec, folder: Path, video: bytes) -> ClipRecord:
    (folder / f"{spec.clip_id}.mp4").write_bytes(video)
    return ClipRecord(
        clip_id=spec.clip_id,
        spec=spec.to_dict(),
        file=f"{spec.clip_id}.mp4",
        file_sha256=hashlib.sha256(video).hexdigest(),
        file_bytes=len(video),
        raw_sha256="0" * 64,
        frame_count=FRAMES,
        width=WIDTH,
        height=HEIGHT,
        fps=FPS,
        iris_px=[[58.0, 58.5]] * FRAMES,
        visible_px=[[900, 910]] * FRAMES,
        psnr_db=[41.0, 42.0],
        ssim=[0.991, 0.992],
        frame_ms_median=12.0,
        render_s=1.5,
        gl_renderer="a test",
        gl_version="4.5",
        code_version=code_version(),
    )


def finish_jobs(db: Database) -> None:
    """Mark every queued clip as rendered."""
    while (job := jobs.claim(db, worker="test")) is not None:
        jobs.finish(db, job, worker="test", record={"frame_count": FRAMES})


@pytest.fixture
def small_study() -> Callable[..., StudyDefinition]:
    """Return what makes the small study, with changes at the top of its file."""
    return small_definition


@pytest.fixture
def definition() -> StudyDefinition:
    """The study of the test; a test that needs another one overrides it."""
    return small_definition()


@pytest.fixture
def are_clips_ready() -> bool:
    """Say whether the clips are rendered when the site starts."""
    return True


@pytest.fixture(scope="session")
def password_hash(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The hash of PASSWORD, made once: hashing takes time on purpose."""
    db = open_database(str(tmp_path_factory.mktemp("hash") / "study.sqlite3"))
    researchers.add(db, "ada", PASSWORD)
    with db.reading() as session:
        found = session.scalars(select(ResearcherRow.password_hash)).one()
    db.close()
    return found


def add_ada(db: Database, password_hash: str) -> None:
    """Add the researcher ada, whose password is PASSWORD."""
    with db.writing() as session:
        session.add(ResearcherRow(name="ada", password_hash=password_hash, created_at=db.now()))


@pytest.fixture
def settings(tmp_path: Path, database_url: str) -> Settings:
    """Where the site of the test keeps everything."""
    return Settings(
        data_folder=tmp_path, database_url=database_url, media_folder=tmp_path / "clips"
    )


@pytest.fixture
def site(
    settings: Settings,
    password_hash: str,
    definition: StudyDefinition,
    make_video: Callable[[int], bytes],
    are_clips_ready: bool,
) -> Iterator[Site]:
    """Run the site in a thread, on a port of its own."""
    db = open_database(settings.database_url)
    add_ada(db, password_hash)
    study = studies.register(db, definition)
    jobs.enqueue(db, definition.wanted_specs())
    if are_clips_ready:
        fill_shelf(settings.media_folder, definition, make_video)
        finish_jobs(db)
    with Serving(settings, study) as url:
        yield Site(url, db, study, settings)
    db.close()


@pytest.fixture
def put_clips(make_video: Callable[[int], bytes]) -> Callable[[Site], None]:
    """Return what renders a site's clips, so to speak."""

    def put(site: Site) -> None:
        fill_shelf(site.settings.media_folder, site.study.definition, make_video)
        finish_jobs(site.db)

    return put


class Serving:
    """Serve a site until the block ends. Its socket listens at once, so nobody has to wait."""

    def __init__(self, settings: Settings, study: studies.Study) -> None:
        self.socket = socket.create_server(("127.0.0.1", 0))
        app = create_app(settings, study_id=study.id)
        self.server = uvicorn.Server(
            uvicorn.Config(app, log_level="critical", access_log=False, lifespan="on")
        )
        self.thread = threading.Thread(
            target=self.server.run, kwargs={"sockets": [self.socket]}, daemon=True
        )

    def __enter__(self) -> str:
        self.thread.start()
        return f"http://127.0.0.1:{self.socket.getsockname()[1]}"

    def __exit__(self, *_: object) -> None:
        self.server.should_exit = True
        self.thread.join(10)
        self.socket.close()


class Guest:
    """A browser without scripts: keeps cookies, follows redirects, remembers its last page."""

    def __init__(self, url: str, **headers: str) -> None:
        # A loaded machine is no failure.
        self.client = httpx.Client(base_url=url, follow_redirects=True, headers=headers, timeout=60)
        self.page = httpx.Response(204)

    def get(self, path: str) -> httpx.Response:
        """Open a page."""
        self.page = self.client.get(path)
        return self.page

    def post(self, path: str, **fields: Any) -> httpx.Response:
        """Send a form of the last page, with its proof."""
        for proof in ("csrf", "ticket"):
            if f'name="{proof}"' in self.page.text:
                fields = {proof: self.hidden(proof), **fields}
        self.page = self.client.post(path, data=fields)
        return self.page

    def hidden(self, name: str) -> str:
        """Return the value of a hidden field on the last page."""
        found = re.search(rf'name="{name}" value="([^"]*)"', self.page.text)
        assert found, f"no hidden field {name} on {self.page.url}"
        return found[1]

    def data(self, name: str) -> str:
        """Return the value of a data attribute on the last page."""
        found = re.search(rf'data-{name}="([^"]*)"', self.page.text)
        assert found, f"no attribute data-{name} on {self.page.url}"
        return found[1]

    @property
    def at(self) -> str:
        """The path of the last page."""
        return self.page.url.path

    def agree(self) -> httpx.Response:
        """Agree to the consent of the small study."""
        self.get("/consent")
        return self.post("/consent", version=self.hidden("version"), agree=["1", "2"])

    def walk_to_preparing(self) -> httpx.Response:
        """Go from consent to the clips."""
        self.agree()
        self.post("/about-you", age="33")
        return self.post("/instructions")

    def walk_to_trial(self) -> httpx.Response:
        """Go from consent to the practice trial."""
        self.walk_to_preparing()
        screen = {"screen_width_px": "1920", "screen_height_px": "1080", "pixel_ratio": "1"}
        return self.post("/preparing", **screen)

    def send(self, **entry: Any) -> httpx.Response:
        """Report an entry as the browser's outbox does; the last page stays."""
        headers = {"X-CSRF-Token": self.data("csrf")}
        return self.client.post("/events", json=entry, headers=headers)

    def watch(self, key: str = "play-1", **facts: Any) -> httpx.Response:
        """Report that the clip on the last page was watched to its end."""
        play = {
            "is_complete": True,
            "was_hidden": False,
            "expected_frames": FRAMES,
            "presented_frames": FRAMES,
            "dropped_frames": 0,
            "shown_scale": 1.0,
        }
        position = int(self.data("position"))
        return self.send(kind="play", key=f"{key}-{position}", position=position, play=play | facts)

    def finish(self, **answers: str) -> httpx.Response:
        """Send the whole questionnaire of the trial on the last page."""
        return self.post(self.at, key=self.hidden("key"), **answers)

    def sign_in(self, name: str = "ada", password: str = PASSWORD) -> httpx.Response:
        """Sign in at the dashboard."""
        self.get("/researcher/sign-in")
        return self.post("/researcher/sign-in", name=name, password=password)


@pytest.fixture
def guest(site: Site) -> Iterator[Guest]:
    """Somebody new at the site."""
    one = site.guest()
    yield one
    one.client.close()


WAIT_MS = 30_000  # a loaded machine is no failure


@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    """One browser for all tests of a module."""
    expect.set_options(timeout=WAIT_MS)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path="/usr/bin/chromium",
            args=[
                "--no-sandbox",
                "--disable-dev-shm-usage",
                "--host-resolver-rules=MAP study.test 127.0.0.1",
            ],
        )
        yield browser
        browser.close()


@pytest.fixture
def context(chromium: Browser) -> Iterator[BrowserContext]:
    """A browser that nobody has used, on a screen with 1.5 device pixels per CSS pixel."""
    screen: Any = {"width": 900, "height": 640}
    one = chromium.new_context(viewport=screen, screen=screen, device_scale_factor=1.5)
    one.set_default_timeout(WAIT_MS)
    yield one
    one.close()


@pytest.fixture
def page(context: BrowserContext, site: Site) -> Iterator[Page]:
    """A page that notes every request to anywhere else and every error in a script."""
    one = context.new_page()
    foreign: list[str] = []
    errors: list[str] = []
    own = (f"{site.url}/", f"blob:{site.url}/", f"{site.by_name}/", f"blob:{site.by_name}/")
    one.on("request", lambda r: None if r.url.startswith(own) else foreign.append(r.url))
    one.on("pageerror", lambda error: errors.append(str(error)))
    yield one
    assert foreign == []
    assert errors == []


@dataclass
class Visit:
    """A participant in a real browser."""

    page: Page
    site: Site

    def to_preparing(self, url: str | None = None) -> None:
        """Go from the first page to the clips."""
        self.page.goto(url or self.site.url)
        self.page.get_by_role("link", name="Begin").click()
        agree = self.page.get_by_role("button", name="I agree and want to take part")
        expect(agree).to_be_visible()  # all() does not wait: on the page before there is no box
        for box in self.page.get_by_role("checkbox").all():
            box.check()
        agree.click()
        self.page.get_by_label("How old are you?").fill("33")
        self.page.get_by_role("button", name="Continue").click()
        self.page.get_by_role("button", name="I am ready").click()

    def to_trial(self, url: str | None = None) -> None:
        """Go from the first page to the practice trial."""
        self.to_preparing(url)
        self.page.get_by_role("button", name="Start with the whole screen").click()
        expect(self.page).to_have_url(f"{url or self.site.url}/trial/1")

    def straight_to_trial(self) -> None:
        """Open the practice trial as somebody who came there without a browser."""
        guest = self.site.guest()
        guest.walk_to_trial()
        name = "ocularist_participant"
        cookie: Any = {"name": name, "value": guest.client.cookies[name], "url": self.site.url}
        guest.client.close()
        self.page.context.add_cookies([cookie])
        self.page.goto(f"{self.site.url}/trial/1")

    def state(self, name: str) -> None:
        """Wait until the stage is in a state."""
        expect(self.page.locator(".stage")).to_have_attribute("data-state", name)

    def play(self) -> None:
        """Start the clip."""
        self.page.get_by_role("button", name="Play the clip").click()

    def watch(self) -> None:
        """Watch the clip to its end."""
        self.play()
        self.state("watched")

    def rate(self, left: int, right: int) -> None:
        """Answer every question but those for text."""
        self.page.locator(f"input[name=rating_left][value='{left}']").check()
        self.page.locator(f"input[name=rating_right][value='{right}']").check()
        self.page.locator("input[name=comparison][value='1']").check()
        self.page.locator("input[name=noticed][value=no]").check()

    def saved(self, text: str = "Saved") -> None:
        """Wait until the strip says something about what is saved."""
        expect(self.page.locator(".saved [role=status]")).to_have_text(text)

    def recorded(self, kind: str) -> list[dict[str, Any]]:
        """Return what the site has stored of one kind, oldest first."""
        person = self.site.people()[0]
        return [dict(e.payload) for e in events.history(self.site.db, person) if e.kind == kind]


@pytest.fixture
def visit(page: Page, site: Site) -> Visit:
    """Somebody new in a real browser."""
    return Visit(page, site)
