"""A browser of sorts for simulated participants: cookies, redirects, forms, the outbox's posts.

Made of the standard library alone. It knows pages and nothing of studies.
"""

from __future__ import annotations

import json
import urllib.error
import urllib.request
from collections.abc import Mapping
from dataclasses import dataclass, field
from html.parser import HTMLParser
from http.cookiejar import CookieJar
from typing import Any, Final
from urllib.parse import urlencode, urljoin, urlsplit

from study.site.signatures import SIMULATION_HEADER

TIMEOUT_S: Final = 30.0


class BotError(RuntimeError):
    """A simulated participant cannot go on; the message says where and why."""


@dataclass
class Page:
    """What a bot reads off a page: hidden fields, data attributes, the completion code."""

    url: str
    hidden: dict[str, str] = field(default_factory=dict)
    data: dict[str, str] = field(default_factory=dict)
    completion_code: str = ""

    @property
    def path(self) -> str:
        """The page's address without the site's."""
        return urlsplit(self.url).path


class _Reader(HTMLParser):
    """Fills a Page from its source."""

    def __init__(self, page: Page) -> None:
        super().__init__()
        self.page = page
        self._is_code = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        if tag == "input" and given.get("type") == "hidden":
            self.page.hidden[given["name"]] = given["value"]
        if tag in ("body", "main"):
            self.page.data |= {
                name.removeprefix("data-"): value
                for name, value in given.items()
                if name.startswith("data-")
            }
        self._is_code = given.get("id") == "completion-code"

    def handle_data(self, data: str) -> None:
        if self._is_code:
            self.page.completion_code = data.strip()
            self._is_code = False


class Browser:
    """A browser of sorts: it keeps cookies, follows redirects and reads forms."""

    def __init__(self, url: str, simulation_token: str) -> None:
        self.url = url
        self.simulation_token = simulation_token
        jar = urllib.request.HTTPCookieProcessor(CookieJar())
        self._opener = urllib.request.build_opener(jar)
        self.page = Page(url)

    def get(self, path: str) -> Page:
        """Open a page."""
        headers = {SIMULATION_HEADER: self.simulation_token}
        return self._open(urllib.request.Request(urljoin(self.url, path), headers=headers))

    def post(self, path: str, fields: Mapping[str, Any]) -> Page:
        """Send a form of the page that is open, its hidden fields included."""
        body = urlencode({**self.page.hidden, **fields}, doseq=True).encode()
        headers = {SIMULATION_HEADER: self.simulation_token}
        return self._open(urllib.request.Request(urljoin(self.url, path), body, headers))

    def report(self, entry: Mapping[str, Any]) -> None:
        """Report what happened as the pages' outbox does."""
        headers = {"Content-Type": "application/json", "X-CSRF-Token": self.page.data["csrf"]}
        body = json.dumps(entry).encode()
        request = urllib.request.Request(urljoin(self.url, "/events"), body, headers)
        if not json.loads(self.read(request)).get("ok"):
            raise BotError(f"{self.page.path}: the site did not take {entry}")

    def read(self, request: urllib.request.Request) -> bytes:
        """Return the body of an answer; raises BotError when there is none."""
        return self._send(request)[1]

    def _open(self, request: urllib.request.Request) -> Page:
        url, body = self._send(request)
        self.page = Page(url)
        _Reader(self.page).feed(body.decode())
        return self.page

    def _send(self, request: urllib.request.Request) -> tuple[str, bytes]:
        where = f"{request.get_method()} {request.full_url}"
        try:
            with self._opener.open(request, timeout=TIMEOUT_S) as answer:
                return answer.url, answer.read()
        except urllib.error.HTTPError as error:
            with error:
                raise BotError(f"{where}: the site answered {error.code}") from None
        except OSError as error:
            raise BotError(f"{where}: no answer ({error}); is the site running?") from None
