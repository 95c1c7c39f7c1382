"""What the dashboard shows of the figures: the last set, its files, what is being done about it."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import select

from study.data.database import Database
from study.data.figures_due import find_set, is_claimed, newest
from study.data.schema import FigureFileRow


@dataclass(frozen=True)
class FigureSet:
    """What there is of one kind of answers, and what is being done about it.

    ``summary`` is None while nothing has been drawn; ``is_stale`` says that answers have come since
    (or that none of those that came has been drawn); ``error`` is why the last drawing failed.
    """

    id: int | None
    summary: Mapping[str, Any] | None
    as_of: datetime | None
    is_being_made: bool
    is_stale: bool
    error: str | None
    failed_at: datetime | None


def latest(db: Database, study_id: int, kind: str) -> FigureSet:
    """Return what there is of one kind of a study's answers now."""
    with db.reading() as session:
        row = find_set(session, study_id, kind)
        answers = newest(session, study_id, kind)
        if row is None:
            return FigureSet(None, None, None, False, bool(answers), None, None)
        return FigureSet(
            id=row.id,
            summary=row.summary,
            as_of=row.as_of,
            is_being_made=is_claimed(row, db.now()),
            is_stale=bool(answers) and answers != row.seen,
            error=row.error,
            failed_at=row.failed_at,
        )


def content(db: Database, set_id: int, name: str) -> bytes | None:
    """Return one file of a set, None where it has none of that name."""
    with db.reading() as session:
        row = session.get(FigureFileRow, (set_id, name))
        return None if row is None else zlib.decompress(row.content)


def names(db: Database, set_id: int) -> tuple[str, ...]:
    """Return the names of a set's files."""
    wanted = select(FigureFileRow.name).where(FigureFileRow.set_id == set_id)
    with db.reading() as session:
        return tuple(session.scalars(wanted.order_by(FigureFileRow.name)))
