"""Open a database: transactions. SQLite by default, PostgreSQL by URL.

A transaction that has ended is on the disk. What differs between the two kinds is in ``engines``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar
from datetime import UTC, datetime
from typing import Any, TypeVar

from alembic.util import CommandError
from sqlalchemy import Connection, Engine, make_url
from sqlalchemy.engine import URL
from sqlalchemy.exc import ArgumentError, DataError, DBAPIError
from sqlalchemy.orm import Session

from study.data.batches import run
from study.data.commits import GroupCommit
from study.data.engines import DRIVER, make_engine, reading_engine
from study.data.errands import Eyes, Make, look
from study.data.migrating import bring_up_to_date
from study.data.refusals import UnusablePayloadError

T = TypeVar("T")
Clock = Callable[[], datetime]


class DatabaseError(ValueError):
    """A database cannot be opened; the message says which and why."""


def utc_now() -> datetime:
    """Return the time now, in UTC."""
    return datetime.now(UTC)


class Database:
    """An open database with its clock.

    ``reading`` and ``writing`` give a session for one transaction; inside another transaction of
    the same thread or task they join it. What the outermost one wrote is stored when it ends.
    """

    def __init__(self, engine: Engine, *, clock: Clock = utc_now) -> None:
        self.engine = engine
        self.now = clock
        self.cache: dict[int, Any] = {}
        self.recent: dict[int, tuple[float, Any]] = {}
        self._reading_engine = reading_engine(engine)
        self.group = GroupCommit(engine) if engine.dialect.name == "sqlite" else None
        # Of a file connections stay good; fetching one from the pool takes longer than most looks.
        self._idle: list[Eyes] = []
        self._session: ContextVar[tuple[Session, bool] | None] = ContextVar("session", default=None)

    @contextmanager
    def reading(self) -> Iterator[Session]:
        """Give a session that reads one consistent state."""
        with self._joined(_alone(self._reading_engine), is_writing=False) as session:
            yield session

    @contextmanager
    def writing(self) -> Iterator[Session]:
        """Give a session that may write; on SQLite one does at a time.

        What was written is on the disk when the outermost block has ended.
        """
        own = self.group.writing() if self.group else _alone(self.engine)
        with self._joined(own, is_writing=True) as session:
            yield session

    @contextmanager
    def batch(self) -> Iterator[Connection]:
        """Give a connection for a transaction of many errands; see ``study.data.errands``.

        It joins no other transaction. What was written is on the disk when the block has ended.
        """
        with (
            self.group.connection(comes_first=True)
            if self.group
            else self.engine.begin() as connection
        ):
            yield connection

    def run(self, make: Make[T]) -> T:
        """Run one errand that may write, in a transaction of its own or inside the outer one."""
        with self.writing() as session:
            session.flush()
            found: T = run(session.connection(), [make])[0].get()
            session.expire_all()
            return found

    @contextmanager
    def inside(self, session: Session) -> Iterator[None]:
        """Let what is called in the block join the transaction of an errand's session."""
        mark = self._session.set((session, True))
        try:
            yield
        finally:
            self._session.reset(mark)

    def look(self, make: Make[T]) -> T:
        """Run one errand that only reads one consistent state."""
        outer = self._session.get()
        if outer is not None:
            outer[0].flush()
            return look(outer[0].connection(), make)
        if self.group is None:
            with self._reading_engine.begin() as connection:
                return look(connection, make)
        eyes = self._idle.pop() if self._idle else self.eyes()
        try:
            return eyes.look(make)
        finally:
            self._idle.append(eyes)

    @contextmanager
    def glance(self) -> Iterator[Connection]:
        """Give a connection for looks of many at one consistent state."""
        with self._reading_engine.begin() as connection:
            yield connection

    def eyes(self) -> Eyes:
        """Return a connection of one's own for reading, one errand after the other."""
        return Eyes(self._reading_engine.connect())

    @contextmanager
    def _joined(
        self, own: AbstractContextManager[Session], *, is_writing: bool
    ) -> Iterator[Session]:
        outer = self._session.get()
        if outer is not None:
            session, may_write = outer
            if is_writing and not may_write:
                raise RuntimeError("a reading transaction cannot write; open it with writing()")
            yield session
            return
        with own as session:
            mark = self._session.set((session, is_writing))
            try:
                yield session
            except DataError as error:  # no column holds this: a number too large, a NUL
                raise UnusablePayloadError(f"no database can store this: {error.orig}") from error
            finally:
                self._session.reset(mark)

    def close(self) -> None:
        """Close every connection."""
        while self._idle:
            self._idle.pop().close()
        self.engine.dispose()


@contextmanager
def _alone(engine: Engine) -> Iterator[Session]:
    with Session(engine, expire_on_commit=False) as session, session.begin():
        yield session


def open_database(url: str, *, clock: Clock = utc_now) -> Database:
    """Open a database and bring its tables up to date.

    ``url`` is SQLAlchemy's ("sqlite:///study.sqlite3", "postgresql+psycopg://...") or the path of
    an SQLite file. Raises DatabaseError saying what is wrong with it.
    """
    parsed = _url(url)
    name = parsed.render_as_string(hide_password=True)
    try:
        engine = make_engine(parsed)
        bring_up_to_date(engine)
    except ModuleNotFoundError as error:
        raise DatabaseError(
            f"{name}: the driver {error.name} is not installed; install it, or name another one: "
            f"{DRIVER}://..."
        ) from None
    except DBAPIError as error:
        reason = " ".join(str(error.orig).split())
        raise DatabaseError(f"{name}: cannot be opened ({reason})") from None
    except CommandError as error:
        raise DatabaseError(
            f"{name}: its tables were made by another version of Ocularist ({error})"
        ) from None
    except ArgumentError as error:
        raise DatabaseError(f"{name}: not a database that can be used ({error})") from None
    return Database(engine, clock=clock)


def _url(text_: str) -> URL:
    if "://" not in text_:
        return URL.create("sqlite", database=text_)
    try:
        url = make_url(text_)
    except (ArgumentError, ValueError) as error:
        raise DatabaseError(f"{text_}: not a database URL ({error})") from None
    if url.get_backend_name() == "sqlite" and url.database in (None, "", ":memory:"):
        raise DatabaseError(f"{url}: an SQLite database has to be a file: sqlite:///study.sqlite3")
    return url
