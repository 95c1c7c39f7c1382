"""Batches: errands of many in one transaction, each with its own end.

On SQLite one runs after the other. On PostgreSQL they go in step: what all of them ask for next is
sent in one pipeline, one way to the server and back. Two errands of one sender do not go in step:
the second sees what the first has written.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import Connection

from study.data.errands import (
    Ask,
    Make,
    Outcome,
    SpoiltError,
    Under,
    answer,
    driver_of,
    in_session,
    straight,
)


def run(connection: Connection, makes: Sequence[Make[Any]]) -> list[Outcome]:
    """Run errands in the connection's transaction; an error is that of its errand alone."""
    driver = driver_of(connection)
    if len(makes) > 1:
        driver.execute("SAVEPOINT batch")
        try:
            outcomes = _together(connection, makes)
        except Exception:
            driver.execute("ROLLBACK TO SAVEPOINT batch")
        else:
            driver.execute("RELEASE SAVEPOINT batch")
            return outcomes
    return [_apart(connection, make) for make in makes]


def _apart(connection: Connection, make: Make[Any]) -> Outcome:
    """Run one errand so that what it wrote can be taken back."""
    driver = driver_of(connection)
    driver.execute("SAVEPOINT errand")
    try:
        outcome = straight(connection, make)
    except Exception as error:
        driver.execute("ROLLBACK TO SAVEPOINT errand")
        outcome = Outcome(error=_cause(error))
    driver.execute("RELEASE SAVEPOINT errand")
    return outcome


def _cause(error: Exception) -> Exception:
    cause = error.__cause__
    return cause if isinstance(error, SpoiltError) and isinstance(cause, Exception) else error


def _together(connection: Connection, makes: Sequence[Make[Any]]) -> list[Outcome]:
    if connection.dialect.name != "postgresql":
        return [straight(connection, make) for make in makes]
    ended: dict[int, Outcome] = {}
    waiting = list(range(len(makes)))
    while waiting:
        waiting = _in_step(connection, {n: makes[n] for n in waiting}, ended)
    return [ended[n] for n in range(len(makes))]


def _in_step(
    connection: Connection, makes: Mapping[int, Make[Any]], ended: dict[int, Outcome]
) -> list[int]:
    """Run errands to their ends, step by step; returns those of senders who have another here."""
    under = {n: Under(make()) for n, make in makes.items()}
    steps = {n: one.go_on(None) for n, one in under.items()}
    found = _ask_all(connection, _asks(steps, ended))
    senders: set[Any] = set()
    later = []
    for n in sorted(found):
        sender = getattr(found[n][0], "id", None) if found[n] else None
        if sender is not None and sender in senders:
            later.append(n)
            del found[n]
        senders.add(sender)
    while found:
        steps = {n: under[n].go_on(rows) for n, rows in found.items()}
        found = _ask_all(connection, _asks(steps, ended))
    return later


def _asks(steps: Mapping[int, Ask | Outcome], ended: dict[int, Outcome]) -> dict[int, Ask]:
    """Keep how some have ended; return what the others ask for."""
    ended |= {n: step for n, step in steps.items() if isinstance(step, Outcome)}
    return {n: step for n, step in steps.items() if not isinstance(step, Outcome)}


def _ask_all(connection: Connection, asks: Mapping[int, Ask]) -> dict[int, Any]:
    """Run what many ask for; returns the rows of each."""
    if len(asks) == 1:
        return {n: answer(connection, ask) for n, ask in asks.items()}
    driver, dialect = driver_of(connection), connection.dialect
    # In one order in all processes: two who wait for each other's rows would wait for ever.
    plain = {n: ask for n, ask in asks.items() if isinstance(ask, tuple)}
    order = sorted(plain, key=lambda n: str(next(iter(plain[n][1].values()), "")))
    with driver.pipeline():
        cursors = {n: plain[n][0].send(driver, dialect, plain[n][1]) for n in order}
    found = {n: plain[n][0].rows(cursor, dialect) for n, cursor in cursors.items()}
    rare = {n: ask for n, ask in asks.items() if not isinstance(ask, tuple)}
    return found | {n: in_session(connection, ask) for n, ask in rare.items()}
