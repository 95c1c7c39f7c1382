"""Trouble around requests: cut connections, doubled forms, reloads, a server killed and restarted.

Everything that happens is drawn from a seed and counted by what it was and where.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections import Counter
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from study.load.proxy import Cut, Proxy
from study.load.site import LoadedSite
from study.load.visit import Send, Visit
from study.load.wire import Answered, Wire

CUTS: Final[tuple[Cut, ...]] = ("request", "unheard", "answer")
MISCHIEF: Final = (*CUTS, "doubled", "at once", "reload")
KILL: Final = "kill"


@dataclass
class Killer:
    """Kills one site and starts it again; while it does, others wait for it to be back.

    ``due`` are the kinds of requests in whose middle it is still to be killed, each once.
    """

    site: LoadedSite
    due: list[str]
    kills: int = 0
    _busy: asyncio.Lock = field(default_factory=asyncio.Lock)

    def wants(self, kind: str) -> bool:
        """Say whether to kill it in a request of this kind; asked once, it will be done."""
        if kind not in self.due or self._busy.locked():
            return False
        self.due.remove(kind)
        return True

    async def kill(self) -> None:
        """Kill the site and start it again."""
        async with self._busy:
            self.site.kill()
            self.kills += 1
            self.site.start()
            await self.site.wait()


@dataclass
class Trouble:
    """One person's trouble: ``share`` of their requests have some."""

    proxy: Proxy
    killer: Killer
    rng: np.random.Generator
    share: float
    seen: Counter[tuple[str, str]]

    async def around(self, visit: Visit, kind: str, send: Send) -> Answered:
        """Send the request, perhaps with trouble."""
        if self.killer.wants(kind):
            return await self._killed(kind, send)
        if self.rng.random() >= self.share:
            return await send()
        what = self.draw(kind)
        if what in CUTS:
            return await self._cut(next(cut for cut in CUTS if cut == what), send)
        if what == "doubled":
            await send()
            return await send()
        if what == "at once":
            return await self._at_once(visit, send)
        with contextlib.suppress(OSError):
            await visit.wire.get(visit.path)
        return await send()

    def draw(self, kind: str) -> str:
        """Draw what happens to a request of this kind: one of those that happened least to it.

        So even what comes once per person, such as the consent, meets every trouble in a crowd.
        """
        fewest = min(self.seen[what, kind] for what in MISCHIEF)
        what = str(self.rng.choice([one for one in MISCHIEF if self.seen[one, kind] == fewest]))
        self.seen[what, kind] += 1
        return what

    async def _killed(self, kind: str, send: Send) -> Answered:
        """Kill the server a moment after the request went out."""
        self.seen[KILL, kind] += 1
        request = asyncio.ensure_future(send())
        await asyncio.sleep(float(self.rng.uniform(0, 0.02)))
        await self.killer.kill()
        return await request

    async def _cut(self, cut: Cut, send: Send) -> Answered:
        self.proxy.cut = cut
        try:
            return await send()
        finally:
            self.proxy.cut = None

    async def _at_once(self, visit: Visit, send: Send) -> Answered:
        """Send the same twice in the same moment, as a double click does."""
        own = visit.wire
        second = Wire(own.url, headers=own.headers, cookies=dict(own.cookies))
        requests = [send()]
        visit.wire = second
        requests.append(send())
        visit.wire = own
        answers = await asyncio.gather(*requests, return_exceptions=True)
        second.close()
        first = answers[0]
        if isinstance(first, BaseException):
            raise first
        return first
