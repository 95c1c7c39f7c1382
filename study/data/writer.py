"""The writer: errands of many requests at once, in one transaction and with one wait for the disk.

Whoever comes while a transaction waits for the disk is in the next one. On SQLite the statements
run on the event loop's own thread: each takes some microseconds, less than another thread would
wait for the interpreter, and only what may wait (the turn to write, the disk) runs in a thread
beside it. On PostgreSQL every statement waits for the server, so the whole batch runs beside it,
and those who only read are gathered as well, in a line of their own.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import AbstractContextManager, asynccontextmanager
from typing import Any, Final, TypeVar
from weakref import WeakKeyDictionary

from sqlalchemy import Connection

from study.data.batches import run
from study.data.database import Database
from study.data.errands import Make, Outcome
from study.data.lines import MOST, Line, Purpose, Waiting, gather, refuse, tell

T = TypeVar("T")
AT_ONCE: Final = 20
"""Errands on the event loop's thread, some milliseconds, before others have their turn on it."""
Lines = dict[Purpose, Line]


class Writer:
    """Runs errands that write; ``write`` returns once what its errand wrote is on the disk."""

    def __init__(self, db: Database) -> None:
        self._db = db
        self._lines: WeakKeyDictionary[asyncio.AbstractEventLoop, Lines] = WeakKeyDictionary()

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

    def _line(self, purpose: Purpose) -> Line:
        loop = asyncio.get_running_loop()
        lines = self._lines.get(loop) or self._lines.setdefault(loop, {})
        return lines.get(purpose) or lines.setdefault(purpose, Line(purpose))

    async def _work(self, line: Line) -> None:
        """Run batch after batch until nobody waits."""
        batch = self._batch_here if self._db.group else self._batch_beside
        try:
            while line.waiting:
                await gather(line)
                await batch(line)
        finally:
            line.task = None

    async def _batch_here(self, line: Line) -> None:
        """Run some errands at a time: whoever comes meanwhile still joins the transaction."""
        taken: list[Waiting] = []
        outcomes: list[Outcome] = []
        try:
            async with self._transaction(line) as connection:
                while line.waiting and len(taken) < MOST:
                    some = line.take(AT_ONCE)
                    taken += some
                    outcomes += run(connection, [make for make, _ in some])
                    await asyncio.sleep(0)
        except BaseException as error:
            refuse(taken or line.take(), error)
        else:
            tell(taken, outcomes)

    async def _batch_beside(self, line: Line) -> None:
        taken = line.take()
        makes = [make for make, _ in taken]
        loop = asyncio.get_running_loop()
        own = self._db.glance if line.purpose == "look" else self._db.batch
        try:
            outcomes = await loop.run_in_executor(line.beside, _whole, own, makes)
        except BaseException as error:
            refuse(taken, error)
        else:
            tell(taken, outcomes)

    @asynccontextmanager
    async def _transaction(self, line: Line) -> AsyncIterator[Connection]:
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
