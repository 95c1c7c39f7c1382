"""Group commit for SQLite: those who write while one waits for the disk share the next wait.

A commit takes as long as the disk needs, some milliseconds, and SQLite lets one connection write
at a time. So whoever finds others waiting hands the open transaction on to them; the last of them
commits for all. Nobody returns before what they wrote is on the disk. What one of them takes back,
after an error, is theirs alone.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Final

from sqlalchemy import Engine
from sqlalchemy.engine import Connection
from sqlalchemy.exc import OperationalError
from sqlalchemy.orm import Session

LARGEST: Final = 100
"""Writers in one group: who came first must not wait for ever while others keep coming."""
BETWEEN: Final = 4
"""Writers who may come before one who writes for many: else they would wait as long as many do."""


@dataclass
class _Group:
    """Writers who share one transaction; ``ended`` is set once it is on the disk, or lost."""

    connection: Connection
    size: int = 0
    ended: threading.Event = field(default_factory=threading.Event)
    error: BaseException | None = None


class GroupCommit:
    """Gives one session at a time for writing, and commits for as many as wait."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._lock = threading.Lock()
        self._turns = {first: threading.Condition(self._lock) for first in (True, False)}
        self._lined_up = {True: 0, False: 0}
        self._is_taken = False
        self._between = 0
        self._group: _Group | None = None

    @property
    def waiting(self) -> int:
        """How many wait for their turn."""
        with self._lock:
            return sum(self._lined_up.values())

    @contextmanager
    def writing(self) -> Iterator[Session]:
        """Give a session that may write; what it wrote is on the disk when the block has ended."""
        with self.connection() as connection, _own_part(connection) as session:
            yield session

    @contextmanager
    def connection(self, *, comes_first: bool = False) -> Iterator[Connection]:
        """Give the group's connection; whoever fails takes back what they wrote by themselves.

        What was written is on the disk when the block has ended. ``comes_first`` is for one who
        writes for many: next in line, and with nobody after them before the disk.
        """
        self._take_turn(comes_first)
        try:
            group = self._join()
            try:
                yield group.connection
                group.size += 1
            finally:
                if comes_first or self._nobody_follows(group):
                    self._end(group)
        finally:
            self._give_turn()
        group.ended.wait()
        if group.error is not None:
            raise _lost(group.error) from group.error

    def _take_turn(self, comes_first: bool) -> None:
        with self._lock:
            self._lined_up[comes_first] += 1
            try:
                self._turns[comes_first].wait_for(
                    lambda: not self._is_taken and self._is_next(comes_first)
                )
                self._is_taken = True
                self._between = 0 if comes_first else self._between + 1
            finally:
                self._lined_up[comes_first] -= 1

    def _is_next(self, comes_first: bool) -> bool:
        """Say whose turn it is: nobody waits for more than BETWEEN others and one who is first."""
        if not self._lined_up[not comes_first]:
            return True
        return comes_first == (self._between >= BETWEEN)

    def _give_turn(self) -> None:
        with self._lock:
            self._is_taken = False
            self._turns[self._lined_up[True] > 0 and self._is_next(True)].notify()

    def _join(self) -> _Group:
        if self._group is None:
            connection = self._engine.connect()
            try:
                connection.begin()
            except BaseException:
                connection.close()
                raise
            self._group = _Group(connection)
        return self._group

    def _nobody_follows(self, group: _Group) -> bool:
        return self.waiting == 0 or group.size >= LARGEST

    def _end(self, group: _Group) -> None:
        """Commit for all in the group; an error is everybody's."""
        self._group = None
        try:
            # After a full disk SQLite may have taken everything back by itself.
            if not getattr(group.connection.connection, "in_transaction", True):
                raise RuntimeError("the transaction was lost before its end")
            group.connection.commit()
        except BaseException as error:
            group.error = error
            group.connection.invalidate(error)  # whatever is left of it goes with the connection
        finally:
            group.connection.close()
            group.ended.set()


@contextmanager
def _own_part(connection: Connection) -> Iterator[Session]:
    with (
        Session(
            connection, expire_on_commit=False, join_transaction_mode="create_savepoint"
        ) as session,
        session.begin(),
    ):
        yield session


def _lost(error: BaseException) -> Exception:
    return OperationalError("COMMIT", None, error)
