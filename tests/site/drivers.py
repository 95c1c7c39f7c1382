"""Browsers as people have them, driven without packages of their own.

Firefox by Marionette, its remote protocol; the others by the drivers that Debian packages. Where a
browser or driver is not installed its test fails and says what installs it.
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
        pytest.fail("Firefox is not installed; make test-long installs firefox-esr")
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
        pytest.fail("WebKit is not installed; make test-long installs webkit2gtk-driver, xvfb")
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
        pytest.fail("make test-long installs chromium-driver, which is not installed")
    port = free_port()
    switches = ["headless=new", "no-sandbox", "disable-dev-shm-usage", f"user-data-dir={folder}"]
    options = {"binary": shutil.which("chromium"), "args": switches}
    with running(driver, f"--port={port}"):
        wait_for("the driver", lambda: connected(port)).close()
        yield Driven(f"http://127.0.0.1:{port}", {"goog:chromeOptions": options})
