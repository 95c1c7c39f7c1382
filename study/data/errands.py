"""Errands: what a request needs from the database, as a generator of prepared statements.

An errand yields a statement with its values and is sent the rows; it returns what came of it. So
the same words run alone or among others in one transaction, straight on SQLite or, on PostgreSQL,
all side by side in a pipeline: one way to the server and back for all of them.

An errand asks first and writes last. One that raises before it has written takes nothing back; one
that fails later is undone, and those beside it are run again without it.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
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


class _SpoiltError(Exception):
    """An errand failed after it wrote: the whole batch is taken back."""


def run(connection: Connection, makes: Sequence[Make[Any]]) -> list[Outcome]:
    """Run errands in the connection's transaction; an error is that of its errand alone."""
    driver = _driver(connection)
    if len(makes) > 1:
        driver.execute("SAVEPOINT batch")
        try:
            outcomes = [_straight(connection, make) for make in makes]
        except Exception:
            driver.execute("ROLLBACK TO SAVEPOINT batch")
        else:
            driver.execute("RELEASE SAVEPOINT batch")
            return outcomes
    return [_apart(connection, make) for make in makes]


def look(connection: Connection, make: Make[T]) -> T:
    """Run one errand that only reads; raises its error."""
    found: T = _straight(connection, make).get()
    return found


class Eyes:
    """A connection that is kept for reading: one state of the database for each errand."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def look(self, make: Make[T]) -> T:
        """Run one errand that only reads; raises its error."""
        driver = _driver(self._connection)
        driver.execute("BEGIN")
        try:
            return look(self._connection, make)
        finally:
            driver.execute("COMMIT")

    def close(self) -> None:
        """Give the connection back."""
        self._connection.close()


def _apart(connection: Connection, make: Make[Any]) -> Outcome:
    """Run one errand so that what it wrote can be taken back."""
    driver = _driver(connection)
    driver.execute("SAVEPOINT errand")
    try:
        outcome = _straight(connection, make)
    except Exception as error:
        driver.execute("ROLLBACK TO SAVEPOINT errand")
        outcome = Outcome(error=_cause(error))
    driver.execute("RELEASE SAVEPOINT errand")
    return outcome


def _cause(error: Exception) -> Exception:
    cause = error.__cause__
    return cause if isinstance(error, _SpoiltError) and isinstance(cause, Exception) else error


def _straight(connection: Connection, make: Make[Any]) -> Outcome:
    """Run one errand from its first statement to its last."""
    errand, has_written, found = make(), False, None
    while True:
        try:
            ask = errand.send(found)
        except StopIteration as end:
            return Outcome(end.value)
        except Exception as error:
            if has_written:
                raise _SpoiltError from error
            return Outcome(error=error)
        has_written = has_written or not isinstance(ask, tuple) or ask[0].writes
        found = _answer(connection, ask)


def _answer(connection: Connection, ask: Ask) -> Any:
    """Run what an errand asks for; returns the rows, or what the function returned."""
    if not isinstance(ask, tuple):
        return _in_session(connection, ask)
    statement, values = ask
    driver, dialect = _driver(connection), connection.dialect
    try:
        return statement.rows(statement.send(driver, dialect, values), dialect)
    except dialect.loaded_dbapi.DataError as error:  # no column holds this
        raise UnusablePayloadError(f"no database can store this: {error}") from error


def _driver(connection: Connection) -> Any:
    return connection.connection.dbapi_connection


def _in_session(connection: Connection, act: Callable[[Session], Any]) -> Any:
    with (
        Session(
            connection, expire_on_commit=False, join_transaction_mode="create_savepoint"
        ) as session,
        session.begin(),
    ):
        return act(session)
