"""A visit to the pages in which nothing is lost: what a browser and its outbox do, without one.

An entry is sent again under its key until the site says that it is stored. A page whose answer
never came is opened again, as somebody would who reloads.
"""

from __future__ import annotations

import asyncio
import itertools
import json
import re
import time
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Final, Protocol

import numpy as np

from study.load.wire import Answered, Wire

RETRY_S: Final = (0.05, 0.1, 0.2, 0.4, 0.8)
MAX_TRIES: Final = 200
PARTICIPANT_COOKIE: Final = "ocularist_participant"
CLIP_PAGE: Final = "clip page"
LATER: Final = (408, 425, 429, 500, 502, 503, 504)
Send = Callable[[], Awaitable[Answered]]
Note = Callable[[str, float, int], None]
"""Hears the kind of a request, its seconds, and its status (0: no answer came)."""


class StuckError(RuntimeError):
    """A simulated person cannot go on; the message says where and why."""


class Mischief(Protocol):
    """What may happen around a request; the ordinary one does nothing."""

    async def around(self, visit: Visit, kind: str, send: Send) -> Answered:
        """Send the request, perhaps twice, perhaps while something breaks."""
        ...


class Peace:
    """Nothing happens but what was asked for."""

    async def around(self, visit: Visit, kind: str, send: Send) -> Answered:
        """Send the request once."""
        del visit, kind
        return await send()


@dataclass
class Acknowledged:
    """What the site said is stored: forms by position, entries by key, and the final code."""

    entries: dict[str, dict[str, Any]] = field(default_factory=dict)
    forms: dict[int, dict[str, str]] = field(default_factory=dict)
    name: str = ""
    code: str = ""


@dataclass
class Visit:
    """One browser on the pages: where it is, what the page says, what was acknowledged.

    ``pause_s`` is the mean time between two requests; 0 means none. ``tries`` are those for one
    request before the visit is given up.
    """

    wire: Wire
    rng: np.random.Generator
    note: Note = lambda _kind, _seconds, _status: None
    mischief: Mischief = field(default_factory=Peace)
    pause_s: float = 0.0
    tries: int = MAX_TRIES
    stored: Acknowledged = field(default_factory=Acknowledged)
    path: str = "/consent"
    page: str = ""
    _asked: str = ""
    _keys: itertools.count[int] = field(default_factory=itertools.count)

    async def open(self, path: str) -> None:
        """Open a page and follow where it leads."""
        for _ in range(10):
            answered = await self.sent("page", partial(self._get, path))
            if answered.status not in (302, 303):
                self.path, self.page = path, answered.text
                if answered.status >= 400:
                    raise StuckError(f"{path}: the site answered {answered.status}")
                return
            path = _path(answered)
        raise StuckError(f"{path}: the pages lead in a circle")

    async def post(self, path: str, fields: Mapping[str, object], kind: str = "form") -> None:
        """Send a form of the open page once, and open what it leads to.

        If no answer comes it may have been stored or not: the person reloads and sees.
        """
        proof = {"csrf": self.found(r'name="csrf" value="([^"]*)"')} if self._has_csrf else {}
        sent = {**proof, **fields}
        try:
            answered = await self._once(kind, lambda: self.wire.post_form(path, sent))
        except OSError:
            await self.open(self._back)
            return
        if answered.status in (302, 303):
            await self.open(_path(answered))
        elif answered.status in LATER:
            await asyncio.sleep(RETRY_S[-1])
            await self.open(self._back)
        else:
            raise StuckError(f"{path}: the site answered {answered.status} to a form")

    async def report(self, entry: Mapping[str, Any], kind: str) -> None:
        """Report an entry under a new key until the site says that it is stored."""
        keyed = {**entry, "key": f"k{next(self._keys)}-{int(self.rng.integers(2**40)):x}"}
        body = json.dumps(keyed).encode()
        headers = {"Content-Type": "application/json", "X-CSRF-Token": self.data("csrf")}
        answered = await self.sent(
            kind,
            lambda: self.wire.request("POST", "/events", body=body, headers=headers),
        )
        if answered.status != 200 or not json.loads(answered.body)["ok"]:
            raise StuckError(f"{self.path}: {keyed} was answered with {answered.status}")
        self.stored.entries[keyed["key"]] = keyed

    async def sent(self, kind: str, send: Send) -> Answered:
        """Send until an answer comes that is no mere "later"."""
        for attempt in itertools.count():
            try:
                answered = await self._once(kind, send)
                if answered.status not in LATER or attempt > self.tries:
                    return answered
            except OSError:
                if attempt > self.tries:
                    raise
            await asyncio.sleep(RETRY_S[min(attempt, len(RETRY_S) - 1)])
        raise AssertionError("unreachable")

    def _get(self, path: str) -> Awaitable[Answered]:
        self._asked = path
        # Over the wire of the moment: trouble may lay another one.
        return self.wire.get(path)

    async def _once(self, kind: str, send: Send) -> Answered:
        if self.pause_s:
            await asyncio.sleep(float(self.rng.exponential(self.pause_s)))
        started = time.perf_counter()
        try:
            answered = await self.mischief.around(self, kind, send)
        except OSError:
            self.note(self._noted(kind), time.perf_counter() - started, 0)
            raise
        self.note(self._noted(kind), time.perf_counter() - started, answered.status)
        return answered

    def _noted(self, kind: str) -> str:
        """Tell the pages of clips, which come most, from the others."""
        return CLIP_PAGE if kind == "page" and self._asked.startswith("/trial/") else kind

    @property
    def _back(self) -> str:
        return "/continue" if PARTICIPANT_COOKIE in self.wire.cookies else "/consent"

    @property
    def _has_csrf(self) -> bool:
        return 'name="csrf"' in self.page

    def key(self) -> str:
        """Return the key that the open page's form carries, or a new one."""
        found = re.search(r'name="key" value="([^"]*)"', self.page)
        return found[1] if found else f"f{next(self._keys)}"

    def data(self, name: str) -> str:
        """Return a data attribute of the open page."""
        return self.found(rf'data-{name}="([^"]*)"')

    def found(self, pattern: str) -> str:
        """Return the first group of a pattern in the open page; raises StuckError without one."""
        found = re.search(pattern, self.page)
        if found is None:
            raise StuckError(f"{self.path}: the page has nothing like {pattern}")
        return found[1]


def _path(answered: Answered) -> str:
    """Return where an answer leads, without the site's address."""
    return re.sub(r"^https?://[^/]+", "", answered.headers.get("location", "/"))
