"""A crowd on a site: so many simulated people at once, one coming as soon as another is done."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from study.design.definition import StudyDefinition
from study.load.person import Person
from study.load.processor import processor_s
from study.load.visit import CLIP_PAGE, Acknowledged
from study.load.wire import Wire

ANSWERS: Final = ("answer", "questionnaire")
KINDS: Final[Mapping[str, tuple[str, ...]]] = {
    "answer": ("answer",),
    "questionnaire": ("questionnaire",),
    "play": ("play",),
    "clip page": (CLIP_PAGE,),
    "joining": ("page", "consent", "form"),
}
"""What tables call requests; joining is all before the first clip and after the last one."""


@dataclass
class Timings:
    """How long requests took, by kind, and what went wrong, between two moments.

    ``there`` people had come to the clips when it began; ``site_s`` and ``crowd_s`` are the
    processor seconds of both in that time.
    """

    seconds: dict[str, list[float]] = field(default_factory=dict)
    errors: dict[str, int] = field(default_factory=dict)
    began: float = math.inf
    ended: float = math.inf
    there: int = 0
    site_s: float = math.nan
    crowd_s: float = math.nan

    def note(self, kind: str, seconds: float, status: int) -> None:
        """Count one request that ended now, if it ended while we measure."""
        if not self.began <= time.perf_counter() < self.ended:
            return
        if status == 0 or status >= 400:
            name = f"{kind}: {status or 'no answer'}"
            self.errors[name] = self.errors.get(name, 0) + 1
        else:
            self.seconds.setdefault(kind, []).append(seconds)

    @property
    def elapsed_s(self) -> float:
        """How long it was measured."""
        return self.ended - self.began

    def rate(self, *kinds: str) -> float:
        """Return the requests of these kinds per second; of all kinds when none is named."""
        return self.pooled(*kinds).size / self.elapsed_s

    def processor_ms(self, seconds: float, *kinds: str) -> float:
        """Return processor milliseconds per request of these kinds; nan where there was none."""
        count = self.pooled(*kinds).size
        return seconds * 1000 / count if count else float("nan")

    def pooled(self, *kinds: str) -> np.ndarray:
        """Return the seconds of all requests of these kinds; of all kinds when none is named."""
        names = kinds or tuple(self.seconds)
        found = [np.asarray(self.seconds.get(kind, ())) for kind in names]
        return np.concatenate(found) if found else np.zeros(0)

    def quantile_ms(self, share: float, *kinds: str) -> float:
        """Return a quantile in milliseconds; nan where nothing was measured."""
        pooled = self.pooled(*kinds)
        return float(np.quantile(pooled, share)) * 1000 if pooled.size else float("nan")


@dataclass
class Crowd:
    """``people`` at once for ``seconds``, once all of them have come to the clips.

    ``pause_s`` is the mean time that a person takes between two requests, 0 for none. ``servers``
    are the numbers of the programs whose processor time is the site's.
    """

    url: str
    definition: StudyDefinition
    people: int
    seconds: float
    arrival_s: float = 60.0
    pause_s: float = 0.0
    uses_outbox: bool = True
    seed: int = 1
    headers: Mapping[str, str] = field(default_factory=dict)
    servers: tuple[int, ...] = ()
    timings: Timings = field(default_factory=Timings)
    stored: list[Acknowledged] = field(default_factory=list)
    _there: set[int] = field(default_factory=set)

    async def run(self, report: Callable[[int], None] = lambda _done: None) -> Timings:
        """Let them take part until the time is over; those under way stop where they are."""
        places = [asyncio.create_task(self._place(n, report)) for n in range(self.people)]
        clock = asyncio.create_task(self._measure())
        # Places never end by themselves: whatever ends first is the time, or an error.
        await asyncio.wait([clock, *places], return_when=asyncio.FIRST_COMPLETED)
        failed = [place.exception() for place in places if place.done()]
        for task in (clock, *places):
            task.cancel()
        await asyncio.gather(clock, *places, return_exceptions=True)
        for error in failed:
            if error is not None:
                raise error
        return self.timings

    async def _measure(self) -> None:
        """Wait until everybody is at the clips, or long enough, then measure."""
        deadline = time.perf_counter() + self.arrival_s
        while len(self._there) < self.people and time.perf_counter() < deadline:
            await asyncio.sleep(0.05)
        self.timings.there = len(self._there)
        self.timings.began = time.perf_counter()
        self.timings.ended = self.timings.began + self.seconds
        site_s, crowd_s = processor_s(*self.servers), time.process_time()
        await asyncio.sleep(self.seconds)
        self.timings.site_s = processor_s(*self.servers) - site_s
        self.timings.crowd_s = time.process_time() - crowd_s

    async def _place(self, number: int, report: Callable[[int], None]) -> None:
        """Fill one place: somebody comes as soon as the one before is done."""
        rng = np.random.default_rng([self.seed, number])
        await asyncio.sleep(float(rng.uniform(0, 2)))

        def note(kind: str, seconds: float, status: int) -> None:
            if kind in ("play", *ANSWERS):
                self._there.add(number)
            self.timings.note(kind, seconds, status)

        while True:
            person = Person(
                Wire(self.url, headers=self.headers),
                rng,
                note=note,
                pause_s=self.pause_s,
                definition=self.definition,
                uses_outbox=self.uses_outbox,
            )
            self.stored.append(person.stored)
            try:
                await person.walk()
            finally:
                person.wire.close()
            report(len(self.stored))
