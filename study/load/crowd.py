"""A crowd on a site: so many simulated people at once, one coming as soon as another is done."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from study.design.definition import StudyDefinition
from study.load.person import Person
from study.load.visit import Acknowledged
from study.load.wire import Wire

ANSWERS = ("answer", "questionnaire")


@dataclass
class Timings:
    """How long requests took, by kind, and what went wrong, between two moments."""

    seconds: dict[str, list[float]] = field(default_factory=dict)
    errors: dict[str, int] = field(default_factory=dict)
    began: float = 0.0
    ended: float = 0.0

    def note(self, kind: str, seconds: float, status: int) -> None:
        """Count one request that ended now, if it ended while we measure."""
        if not self.began <= time.perf_counter() < (self.ended or float("inf")):
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
    """``people`` at once for ``seconds``, after a warm-up in which they all arrive.

    ``pause_s`` is the mean time that a person takes between two requests, 0 for none.
    """

    url: str
    definition: StudyDefinition
    people: int
    seconds: float
    warm_up_s: float = 3.0
    pause_s: float = 0.0
    uses_outbox: bool = True
    seed: int = 1
    headers: Mapping[str, str] = field(default_factory=dict)
    timings: Timings = field(default_factory=Timings)
    stored: list[Acknowledged] = field(default_factory=list)

    async def run(self, report: Callable[[int], None] = lambda _done: None) -> Timings:
        """Let them take part until the time is over; those under way stop where they are."""
        self.timings.began = time.perf_counter() + self.warm_up_s
        self.timings.ended = self.timings.began + self.seconds
        places = [asyncio.create_task(self._place(n, report)) for n in range(self.people)]
        late = asyncio.create_task(asyncio.sleep(self.warm_up_s + self.seconds))
        # Places never end by themselves: whatever ends first is the time, or an error.
        await asyncio.wait([late, *places], return_when=asyncio.FIRST_COMPLETED)
        failed = [place.exception() for place in places if place.done()]
        for task in (late, *places):
            task.cancel()
        await asyncio.gather(late, *places, return_exceptions=True)
        for error in failed:
            if error is not None:
                raise error
        return self.timings

    async def _place(self, number: int, report: Callable[[int], None]) -> None:
        """Fill one place: somebody comes as soon as the one before is done."""
        rng = np.random.default_rng([self.seed, number])
        await asyncio.sleep(float(rng.uniform(0, self.warm_up_s / 2)))
        while True:
            person = Person(
                Wire(self.url, headers=self.headers),
                rng,
                note=self.timings.note,
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
