"""Errands: what a request needs from the database, as a generator of prepared statements.

An errand yields a statement with its values and is sent the rows; it returns what came of it. So
the same words run alone or among others in one transaction, straight on SQLite or, on PostgreSQL,
all side by side in a pipeline: one way to the server and back for all of them.

An errand asks first who sent it, for the row on which others about them wait, and writes last. One
that raises before it has written takes nothing back; one that fails later is undone, and those
beside it are run again without it (``study.data.batches``).
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Any, TypeVar

from sqlalchemy import Connection
from sqlalchemy.orm import Session

from study.data.prepared import Prepared, Values
from study.data.refusals import UnusablePayloadError

T = TypeVar("T")
Ask = tuple[Prepared, Values] | Callable[[Session], Any]
"""A statement with its values; or, for what is rare, a function of a session."""
Errand = Generator[Ask, Any, T]
Make = Callable[[], Errand[T]]
"""Begins an errand, anew each time: it may have to be run twice."""


@dataclass(frozen=True)
class Outcome:
    """What an errand returned, or the error that it ended with."""

    value: Any = None
    error: Exception | None = None

    def get(self) -> Any:
        """Return the value or raise the error."""
        if self.error is not None:
            raise self.error
        return self.value


class SpoiltError(Exception):
    """An errand failed after it wrote: the whole batch is taken back."""


def look(connection: Connection, make: Make[T]) -> T:
    """Run one errand that only reads; raises its error."""
    found: T = straight(connection, make).get()
    return found


class Eyes:
    """A connection that is kept for reading: one state of the database for each errand."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def look(self, make: Make[T]) -> T:
        """Run one errand that only reads; raises its error."""
        driver = driver_of(self._connection)
        driver.execute("BEGIN")
        try:
            return look(self._connection, make)
        finally:
            driver.execute("COMMIT")

    def close(self) -> None:
        """Give the connection back."""
        self._connection.close()


@dataclass
class Under:
    """An errand under way."""

    errand: Errand[Any]
    has_written: bool = False

    def go_on(self, found: Any) -> Ask | Outcome:
        """Give it what was found; returns what it asks for next, or how it ended.

        Raises SpoiltError if it fails after it has written.
        """
        try:
            ask = self.errand.send(found)
        except StopIteration as end:
            return Outcome(end.value)
        except Exception as error:
            if self.has_written:
                raise SpoiltError from error
            return Outcome(error=error)
        self.has_written = self.has_written or not isinstance(ask, tuple) or ask[0].writes
        return ask


def straight(connection: Connection, make: Make[Any]) -> Outcome:
    """Run one errand from its first statement to its last."""
    under = Under(make())
    ask = under.go_on(None)
    while not isinstance(ask, Outcome):
        ask = under.go_on(answer(connection, ask))
    return ask


def answer(connection: Connection, ask: Ask) -> Any:
    """Run what an errand asks for; returns the rows, or what the function returned."""
    if not isinstance(ask, tuple):
        return in_session(connection, ask)
    statement, values = ask
    driver, dialect = driver_of(connection), connection.dialect
    try:
        return statement.rows(statement.send(driver, dialect, values), dialect)
    except dialect.loaded_dbapi.DataError as error:  # no column holds this
        raise UnusablePayloadError(f"no database can store this: {error}") from error


def driver_of(connection: Connection) -> Any:
    """Return the driver's own connection."""
    return connection.connection.dbapi_connection


def in_session(connection: Connection, act: Callable[[Session], Any]) -> Any:
    """Call a function with a session in the connection's transaction."""
    with (
        Session(
            connection, expire_on_commit=False, join_transaction_mode="create_savepoint"
        ) as session,
        session.begin(),
    ):
        return act(session)
