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
        self._turn = threading.Lock()
        self._count = threading.Lock()
        self._waiting = 0
        self._group: _Group | None = None

    @property
    def waiting(self) -> int:
        """How many wait for their turn."""
        with self._count:
            return self._waiting

    @contextmanager
    def writing(self) -> Iterator[Session]:
        """Give a session that may write; what it wrote is on the disk when the block has ended."""
        with self.connection() as connection, _own_part(connection) as session:
            yield session

    @contextmanager
    def connection(self) -> Iterator[Connection]:
        """Give the group's connection; whoever fails takes back what they wrote by themselves.

        What was written is on the disk when the block has ended.
        """
        self._take_turn()
        try:
            group = self._join()
            try:
                yield group.connection
                group.size += 1
            finally:
                if self._nobody_follows(group):
                    self._end(group)
        finally:
            self._turn.release()
        group.ended.wait()
        if group.error is not None:
            raise _lost(group.error) from group.error

    def _take_turn(self) -> None:
        with self._count:
            self._waiting += 1
        try:
            self._turn.acquire()
        finally:
            with self._count:
                self._waiting -= 1

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
        with self._count:
            return self._waiting == 0 or group.size >= LARGEST

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
