"""Limits: how often somebody may do something, counted for all server processes together.

Nobody who takes part comes near them; they keep a program from filling the disk. ``who`` is a
keyed hash, so that no address is stored.
"""

from __future__ import annotations

import logging
import math
from dataclasses import dataclass
from datetime import timedelta
from typing import Any, Final

from sqlalchemy import ColumnElement, Delete, case, delete, select
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.exc import OperationalError

from study.data.database import Database
from study.data.refusals import TooManyError
from study.data.schema import LimitRow

log = logging.getLogger("ocularist.data")


@dataclass(frozen=True)
class Limit:
    """At most ``most`` times within ``per``, which begins with the first time."""

    kind: str
    most: int
    per: timedelta


JOINING: Final = Limit("joining", 600, timedelta(minutes=10))
"""Newcomers from one address: a full lecture hall behind one address stays below."""
REPORTING: Final = Limit("reporting", 600, timedelta(minutes=1))
"""What one participant's browser reports: nobody answers half as fast."""


def count(db: Database, limit: Limit, who: str, *, times: int = 1) -> None:
    """Count that somebody does it so many times more; raises TooManyError if it is too often."""
    now = db.now()
    insert = _insert(db).values(kind=limit.kind, who=who, since=now, count=times)
    is_over = LimitRow.since <= now - limit.per
    query = insert.on_conflict_do_update(
        index_elements=["kind", "who"],
        set_={
            "count": case((is_over, times), else_=LimitRow.count + times),
            "since": case((is_over, now), else_=LimitRow.since),
        },
    ).returning(LimitRow.count, LimitRow.since)
    with db.writing() as session:
        total, since = session.execute(query).one()
        session.execute(_forgetting(limit, is_over, who))
    if total > limit.most:
        raise TooManyError(max(1, math.ceil((since + limit.per - now).total_seconds())))


def forget(db: Database) -> None:
    """Forget everybody whose time is over: counting does so, too, but only when somebody comes."""
    now = db.now()
    try:
        with db.writing() as session:
            for limit in (JOINING, REPORTING):
                session.execute(_forgetting(limit, LimitRow.since <= now - limit.per))
    except OperationalError as error:  # the database is away: the next time will do
        log.warning("limits could not be forgotten yet (%s)", error)


def _forgetting(limit: Limit, is_over: ColumnElement[bool], who: str = "") -> Delete:
    """Forget those whose time is over, other than ``who``, but for rows in use.

    Two who forget each other would wait for each other, and PostgreSQL would break off one of them.
    """
    old = select(LimitRow.who).where(LimitRow.kind == limit.kind, is_over, LimitRow.who != who)
    return delete(LimitRow).where(
        LimitRow.kind == limit.kind, LimitRow.who.in_(old.with_for_update(skip_locked=True))
    )


def _insert(db: Database) -> Any:
    kinds = {"sqlite": sqlite.insert, "postgresql": postgresql.insert}
    return kinds[db.engine.dialect.name](LimitRow)
