"""A browser without scripts, and what a participant or a researcher does in it."""

from __future__ import annotations

import re
from typing import Any

import httpx
from small_study import FRAMES

PASSWORD = "correct horse battery"


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
