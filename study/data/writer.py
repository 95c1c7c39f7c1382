"""The writer: errands of many requests at once, in one transaction and with one wait for the disk.

Whoever comes while a transaction waits for the disk is in the next one. On SQLite the statements
run on the event loop's own thread: each takes some microseconds, less than another thread would
wait for the interpreter, and only what may wait (the turn to write, the disk) runs in a thread
beside it. On PostgreSQL every statement waits for the server, so the whole batch runs beside it,
and those who only read are gathered as well, in a line of their own.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager, asynccontextmanager
from dataclasses import dataclass, field
from typing import Any, Final, Literal, TypeVar
from weakref import WeakKeyDictionary

from sqlalchemy import Connection

from study.data.batches import run
from study.data.database import Database
from study.data.errands import Eyes, Make, Outcome

T = TypeVar("T")
MOST: Final = 100
"""Errands in one transaction: on SQLite everybody else waits for so many at the longest."""
GATHER_S: Final = 0.01
"""So long a transaction waits at most for those whose requests have come but are not read yet."""
QUIET_TURNS: Final = 3
"""Turns of the event loop in which nobody joined: a request takes two to be read."""


Purpose = Literal["write", "gate", "look"]


@dataclass
class _Line:
    """Errands that wait in one event loop for one purpose, each with the future of its sender."""

    purpose: Purpose
    waiting: list[tuple[Make[Any], asyncio.Future[Any]]] = field(default_factory=list)
    task: asyncio.Task[None] | None = None
    eyes: Eyes | None = None
    beside: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="writer")
    )

    def take(self) -> list[tuple[Make[Any], asyncio.Future[Any]]]:
        """Take those who are next."""
        taken, self.waiting = self.waiting[:MOST], self.waiting[MOST:]
        return taken


_Lines = dict[Purpose, _Line]


class Writer:
    """Runs errands that write; ``write`` returns once what its errand wrote is on the disk."""

    def __init__(self, db: Database) -> None:
        self._db = db
        self._lines: WeakKeyDictionary[asyncio.AbstractEventLoop, _Lines] = WeakKeyDictionary()

    async def write(self, make: Make[T], *, is_gated: bool = False) -> T:
        """Run an errand among those of others; raises its own error, or why nothing was stored.

        ``is_gated`` says that it asks for a study's row first. Such errands have a line of their
        own where a server is asked: whoever held a participant's row and waited for the study's
        would wait for ever for one who has that and waits for the participant's.
        """
        return await self._join("gate" if is_gated and self._db.group is None else "write", make)

    async def look(self, make: Make[T]) -> T:
        """Run an errand that only reads: at once on SQLite, else among those of others."""
        if self._db.group is None:
            return await self._join("look", make)
        line = self._line("look")
        if line.eyes is None:
            line.eyes = self._db.eyes()
        return line.eyes.look(make)

    def close(self) -> None:
        """Let the last batches end."""
        for line in [line for lines in list(self._lines.values()) for line in lines.values()]:
            line.beside.shutdown()
            if line.eyes is not None:
                line.eyes.close()

    async def _join(self, purpose: Purpose, make: Make[T]) -> T:
        """Wait in a line, and begin to work it off if nobody does."""
        loop, line = asyncio.get_running_loop(), self._line(purpose)
        future: asyncio.Future[T] = loop.create_future()
        line.waiting.append((make, future))
        if line.task is None:
            line.task = loop.create_task(self._work(line))
        return await future

    def _line(self, purpose: Purpose) -> _Line:
        loop = asyncio.get_running_loop()
        lines = self._lines.get(loop) or self._lines.setdefault(loop, {})
        return lines.get(purpose) or lines.setdefault(purpose, _Line(purpose))

    async def _work(self, line: _Line) -> None:
        """Run batch after batch until nobody waits."""
        batch = self._batch_here if self._db.group else self._batch_beside
        try:
            while line.waiting:
                await _gather(line)
                await batch(line)
        finally:
            line.task = None

    async def _batch_here(self, line: _Line) -> None:
        taken: list[tuple[Make[Any], asyncio.Future[Any]]] = []
        try:
            async with self._transaction(line) as connection:
                taken = line.take()
                outcomes = run(connection, [make for make, _ in taken])
        except BaseException as error:
            _refuse(taken or line.take(), error)
        else:
            _tell(taken, outcomes)

    async def _batch_beside(self, line: _Line) -> None:
        taken = line.take()
        makes = [make for make, _ in taken]
        loop = asyncio.get_running_loop()
        own = self._db.glance if line.purpose == "look" else self._db.batch
        try:
            outcomes = await loop.run_in_executor(line.beside, _whole, own, makes)
        except BaseException as error:
            _refuse(taken, error)
        else:
            _tell(taken, outcomes)

    @asynccontextmanager
    async def _transaction(self, line: _Line) -> AsyncIterator[Connection]:
        """Begin and end a transaction in the thread beside, where waiting holds up nobody."""
        loop = asyncio.get_running_loop()
        own = self._db.batch()
        connection = await loop.run_in_executor(line.beside, own.__enter__)
        try:
            yield connection
        except BaseException as error:
            how = (type(error), error, error.__traceback__)
            await loop.run_in_executor(line.beside, own.__exit__, *how)
            raise
        await loop.run_in_executor(line.beside, own.__exit__, None, None, None)


def _whole(
    own: Callable[[], AbstractContextManager[Connection]], makes: Sequence[Make[Any]]
) -> list[Outcome]:
    with own() as connection:
        return run(connection, makes)


async def _gather(line: _Line) -> None:
    """Let those join who are just being read: beginning and ending costs as much as ten answers.

    Where little comes this waits for some turns of the loop, which take microseconds.
    """
    latest, count, quiet = time.monotonic() + GATHER_S, len(line.waiting), 0
    while quiet < QUIET_TURNS and count < MOST and time.monotonic() < latest:
        await asyncio.sleep(0)
        quiet = quiet + 1 if len(line.waiting) == count else 0
        count = len(line.waiting)


def _tell(
    taken: Sequence[tuple[Make[Any], asyncio.Future[Any]]], outcomes: Sequence[Outcome]
) -> None:
    for (_, future), outcome in zip(taken, outcomes, strict=True):
        if future.done():  # whoever asked has gone
            continue
        if outcome.error is None:
            future.set_result(outcome.value)
        else:
            future.set_exception(outcome.error)


def _refuse(taken: Sequence[tuple[Make[Any], asyncio.Future[Any]]], error: BaseException) -> None:
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
