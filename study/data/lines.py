"""Lines of errands that wait for a transaction, first come first served.

It knows who waits and whom to tell what; transactions are the writer's (``study.data.writer``).
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any, Final, Literal

from study.data.errands import Eyes, Make, Outcome

MOST: Final = 200
"""Errands in one transaction: who came first must not wait for ever while others keep coming."""
GATHER_S: Final = 0.01
"""So long a transaction waits at most for those whose requests have come but are not read yet."""
QUIET_TURNS: Final = 3
"""Turns of the event loop in which nobody joined: a request takes two to be read."""
Purpose = Literal["write", "gate", "look"]
Waiting = tuple[Make[Any], asyncio.Future[Any]]


@dataclass
class Line:
    """Errands that wait in one event loop for one purpose, each with the future of its sender."""

    purpose: Purpose
    waiting: list[Waiting] = field(default_factory=list)
    task: asyncio.Task[None] | None = None
    eyes: Eyes | None = None
    beside: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="writer")
    )

    def take(self, most: int = MOST) -> list[Waiting]:
        """Take those who are next."""
        taken, self.waiting = self.waiting[:most], self.waiting[most:]
        return taken


async def gather(line: Line) -> None:
    """Let those join who are just being read: beginning and ending costs as much as ten answers.

    Where little comes this waits for some turns of the loop, which take microseconds.
    """
    latest, count, quiet = time.monotonic() + GATHER_S, len(line.waiting), 0
    while quiet < QUIET_TURNS and count < MOST and time.monotonic() < latest:
        await asyncio.sleep(0)
        quiet = quiet + 1 if len(line.waiting) == count else 0
        count = len(line.waiting)


def tell(taken: Sequence[Waiting], outcomes: Sequence[Outcome]) -> None:
    """Tell everybody how their errand has ended."""
    for (_, future), outcome in zip(taken, outcomes, strict=True):
        if future.done():  # whoever asked has gone
            continue
        if outcome.error is None:
            future.set_result(outcome.value)
        else:
            future.set_exception(outcome.error)


def refuse(taken: Sequence[Waiting], error: BaseException) -> None:
    """Tell everybody that nothing was stored; what is no mere error ends the writer's work too."""
    for _, future in taken:
        if future.done():
            continue
        if isinstance(error, Exception):
            future.set_exception(error)
        else:
            future.cancel()
    if not isinstance(error, Exception):
        raise error
