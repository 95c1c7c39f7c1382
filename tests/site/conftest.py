"""Fixtures of the site: a small study with real, tiny clips, its site on a real port, browsers."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect, sync_playwright
from sqlalchemy import select

from study.data import jobs, researchers, studies
from study.data.database import Database, open_database
from study.data.schema import ResearcherRow
from study.design.definition import StudyDefinition
from study.settings import Settings

sys.path.append(str(Path(__file__).parent))
from guests import PASSWORD, Guest
from serving import Serving, Site, finish_jobs
from small_study import fill_shelf, small_definition, write_video
from visits import Visit


@pytest.fixture(scope="session")
def make_video(tmp_path_factory: pytest.TempPathFactory) -> Callable[[int], bytes]:
    """Return H.264 videos that differ by a number: a moving bar on mid-grey."""
    folder = tmp_path_factory.mktemp("videos")

    def make(number: int) -> bytes:
        path = folder / f"{number}.mp4"
        if not path.exists():
            write_video(path, number)
        return path.read_bytes()

    return make


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


@pytest.fixture
def visit(page: Page, site: Site) -> Visit:
    """Somebody new in a real browser."""
    return Visit(page, site)
