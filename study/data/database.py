"""Open a database: engine, transactions, migrations. SQLite by default, PostgreSQL by URL.

What differs between the two is here and nowhere else. A transaction that has ended is on the disk.
"""

from __future__ import annotations

import os
import sqlite3
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from datetime import UTC, datetime
from importlib import resources
from pathlib import Path
from typing import Any, Final

from alembic import command
from alembic.config import Config
from alembic.util import CommandError
from sqlalchemy import Engine, create_engine, event, make_url, text
from sqlalchemy.engine import URL, Connection
from sqlalchemy.exc import ArgumentError, DBAPIError
from sqlalchemy.orm import Session

Clock = Callable[[], datetime]
BUSY_TIMEOUT_MS: Final = 30_000
MIGRATION_LOCK: Final = 71_202_611  # any number, the same for all who migrate one database


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
        self._reading_engine = _reading(engine)
        self._session: ContextVar[tuple[Session, bool] | None] = ContextVar("session", default=None)

    @contextmanager
    def reading(self) -> Iterator[Session]:
        """Give a session that reads one consistent state."""
        with self._transaction(self._reading_engine, is_writing=False) as session:
            yield session

    @contextmanager
    def writing(self) -> Iterator[Session]:
        """Give a session that may write; on SQLite it holds the one write lock from its start."""
        with self._transaction(self.engine, is_writing=True) as session:
            yield session

    @contextmanager
    def _transaction(self, engine: Engine, *, is_writing: bool) -> Iterator[Session]:
        outer = self._session.get()
        if outer is not None:
            session, may_write = outer
            if is_writing and not may_write:
                raise RuntimeError("a reading transaction cannot write; open it with writing()")
            yield session
            return
        with Session(engine, expire_on_commit=False) as session, session.begin():
            mark = self._session.set((session, is_writing))
            try:
                yield session
            finally:
                self._session.reset(mark)

    def close(self) -> None:
        """Close every connection."""
        self.engine.dispose()


def open_database(url: str, *, clock: Clock = utc_now) -> Database:
    """Open a database and bring its tables up to date.

    ``url`` is SQLAlchemy's ("sqlite:///study.sqlite3", "postgresql+psycopg://...") or the path of
    an SQLite file. Raises DatabaseError saying what is wrong with it.
    """
    parsed = _url(url)
    name = parsed.render_as_string(hide_password=True)
    try:
        engine = _engine(parsed)
        _migrate(engine)
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
        return make_url(text_)
    except (ArgumentError, ValueError) as error:
        raise DatabaseError(f"{text_}: not a database URL ({error})") from None


def _engine(url: URL) -> Engine:
    if url.get_backend_name() != "sqlite":
        try:
            return create_engine(url, pool_pre_ping=True)
        except ModuleNotFoundError as error:
            raise DatabaseError(
                f"{url}: the driver {error.name} is not installed; install it, or name another "
                "one: postgresql+psycopg://..."
            ) from None
    if not url.database or url.database == ":memory:":
        raise DatabaseError(f"{url}: an SQLite database has to be a file: sqlite:///study.sqlite3")
    path = Path(url.database)
    path.parent.mkdir(parents=True, exist_ok=True)
    # Answers about eyesight are health data: nobody else on the machine may read the file.
    os.close(os.open(path, os.O_CREAT | os.O_RDWR, 0o600))
    # As many connections as the site has threads: nobody waits for one behind a waiting writer.
    engine = create_engine(
        url, connect_args={"timeout": BUSY_TIMEOUT_MS / 1000}, pool_size=10, max_overflow=40
    )
    event.listen(engine, "connect", _set_up_sqlite)
    event.listen(engine, "begin", _begin_sqlite)
    return engine


def _reading(engine: Engine) -> Engine:
    if engine.dialect.name == "sqlite":
        return engine.execution_options(is_reading=True)
    # Elsewhere every statement would see its own moment; one state for all of them is promised.
    return engine.execution_options(isolation_level="REPEATABLE READ")


def _set_up_sqlite(connection: Any, _record: Any) -> None:
    # The driver would begin transactions late and only for some statements; _begin_sqlite does it.
    connection.isolation_level = None
    for pragma in (f"busy_timeout = {BUSY_TIMEOUT_MS}", "synchronous = FULL", "foreign_keys = ON"):
        connection.execute(f"PRAGMA {pragma}")
    _use_wal(connection)


def _use_wal(connection: Any) -> None:
    """Switch to write-ahead logging, which stays with the file once it is set.

    SQLite does not wait for this lock as it does for others: of several processes that open a new
    file at once all but one would be refused.
    """
    give_up = time.monotonic() + BUSY_TIMEOUT_MS / 1000
    while True:
        try:
            connection.execute("PRAGMA journal_mode = WAL")
            return
        except sqlite3.OperationalError as error:
            if "locked" not in str(error) or time.monotonic() > give_up:
                raise
            time.sleep(0.01)


def _begin_sqlite(connection: Connection) -> None:
    # A transaction that reads first and writes later fails when another wrote in between; taking
    # the write lock at once makes it wait instead.
    is_reading = connection.get_execution_options().get("is_reading", False)
    connection.exec_driver_sql("BEGIN" if is_reading else "BEGIN IMMEDIATE")


def _migrate(engine: Engine) -> None:
    """Bring the tables up to date; of several processes one migrates, the others wait."""
    with (
        resources.as_file(resources.files("study.data") / "migrations") as folder,
        engine.begin() as connection,
    ):
        if engine.dialect.name == "postgresql":
            connection.execute(text(f"SELECT pg_advisory_xact_lock({MIGRATION_LOCK})"))
        config = Config()
        config.set_main_option("script_location", str(folder).replace("%", "%%"))
        config.attributes["connection"] = connection
        command.upgrade(config, "head")
