"""What differs between SQLite and PostgreSQL when a connection is made or a transaction begins.

Both are set to write to the disk before a transaction has ended, whatever their defaults are.
"""

from __future__ import annotations

import os
import sqlite3
import time
from pathlib import Path
from typing import Any, Final

from sqlalchemy import Engine, create_engine, event
from sqlalchemy.engine import URL, Connection
from sqlalchemy.exc import DisconnectionError

BUSY_TIMEOUT_MS: Final = 30_000
DRIVER: Final = "postgresql+psycopg"
POOL: Final = {"pool_size": 20, "max_overflow": 20}
"""As many connections as the site has threads: nobody waits for one behind a waiting writer."""
PING_AFTER_S: Final = 1.0
_LONG_LIVED: Final = f"-c synchronous_commit=on -c lock_timeout={BUSY_TIMEOUT_MS}"


def make_engine(url: URL) -> Engine:
    """Return an engine whose transactions are durable.

    Raises ArgumentError or ModuleNotFoundError for a database that SQLAlchemy cannot talk to.
    """
    if url.get_backend_name() == "sqlite":
        return _sqlite(url)
    if url.drivername in ("postgres", "postgresql"):
        url = url.set(drivername=DRIVER)
    if url.get_backend_name() != "postgresql":
        return create_engine(url)
    engine = create_engine(
        url, connect_args={"options": _LONG_LIVED, "connect_timeout": 10}, **POOL
    )
    event.listen(engine, "checkout", _ping)
    event.listen(engine, "checkin", _stamp)
    return engine


def reading_engine(engine: Engine) -> Engine:
    """Return the engine for transactions that only read, from one consistent state."""
    if engine.dialect.name == "sqlite":
        return engine.execution_options(is_reading=True)
    # Elsewhere every statement would see its own moment; one state for all of them is promised.
    return engine.execution_options(isolation_level="REPEATABLE READ")


def _sqlite(url: URL) -> Engine:
    path = Path(url.database or "")
    path.parent.mkdir(parents=True, exist_ok=True)
    # Answers about eyesight are health data: nobody else on the machine may read the file.
    os.close(os.open(path, os.O_CREAT | os.O_RDWR, 0o600))
    # Writers of one group share a connection one after the other, each in its own thread.
    arguments = {"timeout": BUSY_TIMEOUT_MS / 1000, "check_same_thread": False}
    engine = create_engine(url, connect_args=arguments, **POOL)
    event.listen(engine, "connect", _set_up_sqlite)
    event.listen(engine, "begin", _begin_sqlite)
    return engine


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


def _stamp(_connection: Any, record: Any) -> None:
    record.info["used"] = time.monotonic()


def _ping(connection: Any, record: Any, _proxy: Any) -> None:
    """Try a connection that lay idle: the server may have been restarted meanwhile.

    One in constant use is not tried, which would cost a way there and back per transaction.
    """
    if time.monotonic() - record.info.get("used", time.monotonic()) < PING_AFTER_S:
        return
    import psycopg

    try:
        connection.execute("SELECT 1")
        connection.rollback()
    except psycopg.Error as error:
        raise DisconnectionError("the server closed this connection") from error
