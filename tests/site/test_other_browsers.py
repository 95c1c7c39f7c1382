"""Sessions in browsers as people have them: Firefox, WebKit as GTK has it, a Chromium that hides.

Driven without packages of their own: Firefox by Marionette, its remote protocol; the others by the
drivers that Debian packages. Playwright, which drives Chromium in the other tests, keeps every page
visible and in focus; by its driver alone a tab is hidden when another one is opened. Where a
browser or driver is not installed its test is skipped and says so.
"""

from __future__ import annotations

import itertools
import json
import os
import shutil
import socket
import subprocess
import time
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Protocol

import pytest

from study.data import completion, events, export
from study.design.certificate import Verdict, judge

pytestmark = [pytest.mark.long, pytest.mark.parametrize("database_kind", ["sqlite"])]

WAIT_S = 90.0  # a loaded machine is no failure
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # W3C WebDriver, 12.2: the key of an element
FIREFOX = ("firefox-esr", "firefox")
PREFERENCES = {
    "datareporting.policy.dataSubmissionEnabled": False,
    "app.update.enabled": False,
    "browser.shell.checkDefaultBrowser": False,
    "full-screen-api.warning.timeout": 0,
}


class Browser(Protocol):
    """What a test does with a browser, by the words of W3C WebDriver."""

    def ask(self, command: str, **values: Any) -> Any:
        """Give a command and return its value."""
        ...


@dataclass
class Firefox:
    """Firefox by Marionette: JSON with its length before it, over a plain socket."""

    connection: socket.socket

    def __post_init__(self) -> None:
        self.connection.settimeout(WAIT_S)
        self.numbers = itertools.count(1)
        self._hear()  # it greets
        self.ask("NewSession", capabilities={})

    def ask(self, command: str, **values: Any) -> Any:
        message = json.dumps([0, next(self.numbers), f"WebDriver:{command}", values]).encode()
        self.connection.sendall(f"{len(message)}:".encode() + message)
        [_, _, error, result] = self._hear()
        assert error is None, f"{command}: {error}"
        return result.get("value", result) if isinstance(result, dict) else result

    def _hear(self) -> Any:
        digits = b""
        while (byte := self.connection.recv(1)) != b":":
            assert byte, "Firefox has gone"
            digits += byte
        length, message = int(digits), b""
        while len(message) < length:
            message += self.connection.recv(length - len(message))
        return json.loads(message)


@dataclass
class Driven:
    """A browser by its driver: W3C WebDriver over HTTP."""

    url: str
    options: dict[str, Any]

    PATHS: ClassVar[dict[str, str]] = {
        "Navigate": "url",
        "ExecuteScript": "execute/sync",
        "FindElement": "element",
        "ElementClick": "element/{id}/click",
        "AddCookie": "cookie",
        "NewWindow": "window/new",
        "SwitchToWindow": "window",
        "MinimizeWindow": "window/minimize",
        "SetWindowRect": "window/rect",
    }

    def __post_init__(self) -> None:
        found = self._post("session", {"capabilities": {"alwaysMatch": self.options}})
        self.session = f"session/{found['sessionId']}"

    def ask(self, command: str, **values: Any) -> Any:
        path = self.PATHS[command].format(id=values.pop("id", ""))
        return self._post(f"{self.session}/{path}", values)

    def _post(self, path: str, values: dict[str, Any]) -> Any:
        data = json.dumps(values).encode()
        request = urllib.request.Request(f"{self.url}/{path}", data)
        with urllib.request.urlopen(request, timeout=WAIT_S) as answer:
            return json.load(answer)["value"]


def mini_browser() -> Path | None:
    found = sorted(Path("/usr/lib").glob("*/webkit2gtk-*/MiniBrowser"))
    return found[-1] if found else None


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as free:
        return int(free.getsockname()[1])


def wait_for(what: str, ask: Callable[[], Any]) -> Any:
    """Ask until there is an answer."""
    deadline = time.monotonic() + WAIT_S
    while time.monotonic() < deadline:
        if found := ask():
            return found
        time.sleep(0.05)  # another program is asked, and nothing tells when it is there
    raise AssertionError(f"{what} did not come in {WAIT_S:g} s")


@contextmanager
def running(*command: str, **environment: str) -> Iterator[subprocess.Popen[bytes]]:
    """Run a program until the block ends."""
    process = subprocess.Popen(
        command,
        env={**os.environ, **environment},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        yield process
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, 15)
        process.wait(WAIT_S)


def connected(port: int) -> socket.socket | None:
    try:
        return socket.create_connection(("127.0.0.1", port))
    except OSError:
        return None


@contextmanager
def firefox(folder: Path, **preferences: Any) -> Iterator[Browser]:
    name = next(filter(shutil.which, FIREFOX), None)
    if name is None:
        pytest.skip("Firefox is not installed (apt install firefox-esr)")
    port = free_port()
    told = {**PREFERENCES, "marionette.port": port, **preferences}
    lines = [f'user_pref("{key}", {json.dumps(value)});' for key, value in told.items()]
    (folder / "user.js").write_text("\n".join(lines))
    arguments = ("--headless", "--marionette", "--no-remote", "--profile", str(folder))
    with running(name, *arguments, HOME=str(folder)), ExitStack() as stack:
        yield Firefox(stack.enter_context(wait_for("Firefox", lambda: connected(port))))


@contextmanager
def webkit(folder: Path) -> Iterator[Browser]:
    driver, screen = shutil.which("WebKitWebDriver"), shutil.which("Xvfb")
    if not (driver and screen and mini_browser()):
        pytest.skip("WebKit is not installed (apt install webkit2gtk-driver xvfb)")
    port = free_port()
    display = f":{port}"
    with (
        running(screen, display, "-screen", "0", "1366x768x24"),
        running(driver, f"--port={port}", DISPLAY=display, HOME=str(folder)),
    ):
        wait_for("the screen", Path(f"/tmp/.X11-unix/X{port}").exists)
        wait_for("the driver", lambda: connected(port)).close()
        options = {"binary": str(mini_browser()), "args": ["--automation"]}
        yield Driven(f"http://127.0.0.1:{port}", {"webkitgtk:browserOptions": options})


@contextmanager
def chromium(folder: Path) -> Iterator[Browser]:
    driver = shutil.which("chromedriver")
    if driver is None:
        pytest.skip("Chromium's driver is not installed (apt install chromium-driver)")
    port = free_port()
    switches = ["headless=new", "no-sandbox", "disable-dev-shm-usage", f"user-data-dir={folder}"]
    options = {"binary": shutil.which("chromium"), "args": switches}
    with running(driver, f"--port={port}"):
        wait_for("the driver", lambda: connected(port)).close()
        yield Driven(f"http://127.0.0.1:{port}", {"goog:chromeOptions": options})


@dataclass
class Person:
    """Somebody at a browser, who does what the pages say."""

    browser: Browser

    def script(self, body: str) -> Any:
        return self.browser.ask("ExecuteScript", script=body, args=[])

    def wait_until(self, condition: str) -> None:
        wait_for(condition, lambda: self.script(f"return Boolean({condition})"))

    def wait_for_stage(self, *states: str) -> None:
        stage = "document.querySelector('.stage')?.dataset.state"
        self.wait_until(f"{json.dumps(states)}.includes({stage})")

    def press(self, selector: str) -> None:
        self.wait_until(f"document.querySelector({json.dumps(selector)})?.checkVisibility()")
        found = self.browser.ask("FindElement", using="css selector", value=selector)
        self.browser.ask("ElementClick", id=found[ELEMENT])

    def wait_for_page(self, path: str) -> None:
        self.wait_until(f"location.pathname === '{path}' && document.readyState === 'complete'")

    def take_part(self, url: str, trials: int) -> None:
        self.browser.ask("Navigate", url=url)
        self.press("a[href='/consent']")
        self.wait_for_page("/consent")
        for number in (1, 2):
            self.press(f"input[name=agree][value='{number}']")
        self.press("form[action='/consent'] [type=submit]")
        self.wait_for_page("/about-you")
        self.press("form [type=submit]")
        self.wait_for_page("/instructions")
        self.press("form [type=submit]")
        self.wait_for_page("/preparing")
        self.press("form button")
        for number in range(1, trials + 1):
            self.wait_until(f"location.pathname === '/trial/{number}'")
            self.watch_and_rate()
        after = "/thanks" if trials == 3 else f"/trial/{trials + 1}"
        self.wait_until(f"location.pathname === '{after}'")

    def watch_and_rate(self) -> None:
        self.press("[data-when=ready] [data-play]")
        self.wait_for_stage("watched")
        self.press("[data-when=watched] [data-to-questions]")
        for name, value in {"rating_left": 2, "rating_right": 4, "comparison": 1}.items():
            self.press(f"input[name={name}][value='{value}']")
        self.press("input[name=noticed][value=no]")
        self.press("form [type=submit]")


def plays(site: Any) -> list[tuple[dict[str, Any], Verdict]]:
    """Return what was recorded of every play, and the study's verdict on it."""
    [person] = site.people()
    rule = site.study.definition.certificate
    history = events.history(site.db, person)
    records = [dict(event.payload) for event in history if event.kind == "played"]
    return [(record, judge(record, rule)) for record in records]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Where the browser of the test keeps its own."""
    made = tmp_path / "profile"
    made.mkdir()
    return made


@pytest.mark.parametrize(("start", "counted_by"), [(firefox, "callbacks"), (webkit, "frames")])
def test_a_whole_session_runs_in_another_browser(
    site: Any, folder: Path, *, start: Any, counted_by: str
) -> None:
    with start(folder) as browser:
        person = Person(browser)
        person.take_part(site.url, trials=3)
        code = person.script("return document.querySelector('#completion-code').textContent.trim()")
    assert code == completion.code(site.db, site.people()[0])
    ratings = export.tables(site.db, site.study).ratings
    assert sorted(ratings["rating"]) == [2, 2, 2, 4, 4, 4]
    assert len(plays(site)) == 3
    for record, _ in plays(site):
        assert record["counted_by"] == counted_by
        assert (record["is_complete"], record["source"]) == (True, "memory")
        assert 1 <= record["presented_frames"] <= record["expected_frames"]
        assert (record["shown_scale"], record["is_on_grid"]) == (1, True)
        assert (record["hidden_ms"], record["dropped_frames"]) == (0, 0)


@pytest.mark.parametrize(
    ("preferences", "counted_by"),
    [({"layout.frame_rate": 10}, "callbacks"), ({"media.rvfc.enabled": False}, "quality")],
)
def test_firefox_proves_nothing_where_it_cannot_tell_what_it_showed(
    site: Any, folder: Path, *, preferences: dict[str, Any], counted_by: str
) -> None:
    """Ten pictures a second cannot show thirty frames, and decoded frames are not shown ones."""
    with firefox(folder, **preferences) as browser:
        Person(browser).take_part(site.url, trials=1)
    [(record, verdict)] = plays(site)
    assert record["counted_by"] == counted_by
    assert verdict.certified is not True
    assert "not-counted" in verdict.reasons


def other_tab(browser: Browser) -> None:
    browser.ask("SwitchToWindow", handle=browser.ask("NewWindow", type="tab")["handle"])


def minimised(browser: Browser) -> None:
    browser.ask("MinimizeWindow")


@pytest.mark.parametrize("hide", [other_tab, minimised])
def test_a_clip_in_a_tab_that_is_truly_hidden_does_not_count(
    site: Any, folder: Path, hide: Callable[[Browser], None]
) -> None:
    guest = site.guest()
    guest.walk_to_trial()
    name = "ocularist_participant"
    cookie = {"name": name, "value": guest.client.cookies[name]}
    guest.client.close()
    with chromium(folder) as browser:
        person = Person(browser)
        browser.ask("Navigate", url=site.url)
        browser.ask("AddCookie", cookie=cookie)
        browser.ask("Navigate", url=f"{site.url}/trial/1")
        person.wait_for_stage("ready")
        person.script("document.querySelector('video').playbackRate = 0.25")  # time to hide it
        person.press("[data-when=ready] [data-play]")
        hide(browser)
        wait_for("the play's record", lambda: plays(site))
    [(record, verdict)] = plays(site)
    assert (record["ended_by"], record["was_hidden"]) == ("hidden", True)
    assert verdict.certified is False
    assert {"incomplete", "hidden"} <= set(verdict.reasons)
