"""The dashboard's figures: who draws them, and what was drawn.

A claim is a lease as a job's is: one drawer has it at a time, and one that was killed loses it.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, Final

from sqlalchemy import delete, select, text
from sqlalchemy.orm import Session

from study.data.database import Database
from study.data.figures_due import KINDS, is_due, newest, shown_studies
from study.data.schema import FigureFileRow, FigureSetRow

LEASE: Final = timedelta(seconds=90)
MAX_ERROR_CHARS: Final = 4000


@dataclass(frozen=True)
class Claim:
    """One set of figures that is this drawer's to make, from answers up to ``seen``."""

    id: int
    study_id: int
    kind: str
    seen: str
    as_of: datetime


def due(db: Database) -> list[tuple[int, str]]:
    """Return the studies (their ids) and kinds of answers that figures have to be drawn of now."""
    with db.reading() as session:
        return [
            (study_id, kind)
            for study_id in shown_studies(session)
            for kind in KINDS
            if is_due(session, study_id, kind, db.now())
        ]


def claim(db: Database, *, worker: str) -> Claim | None:
    """Claim the next set that is due for ``worker`` (a name of its own); None where none is."""
    for study_id, kind in due(db):
        with db.writing() as session:
            _ensure(session, study_id, kind)
            row = session.scalars(
                select(FigureSetRow)
                .where(FigureSetRow.study_id == study_id, FigureSetRow.kind == kind)
                .with_for_update(skip_locked=True)
                .execution_options(populate_existing=True)
            ).one_or_none()
            now = db.now()
            if row is None or not is_due(session, study_id, kind, now):
                continue
            row.claimed_by, row.lease_until, row.started_at = worker, now + LEASE, now
            return Claim(row.id, study_id, kind, newest(session, study_id, kind), now)
    return None


def claimed(db: Database, *, worker: str) -> Claim | None:
    """Return what ``worker`` has claimed, None where the claim is lost; as of now."""
    with db.reading() as session:
        row = session.scalar(select(FigureSetRow).where(FigureSetRow.claimed_by == worker))
        if row is None:
            return None
        seen = newest(session, row.study_id, row.kind)
        return Claim(row.id, row.study_id, row.kind, seen, db.now())


def renew(db: Database, own: Claim, *, worker: str) -> bool:
    """Renew the lease; False when the claim is no longer this worker's."""
    with db.writing() as session:
        row = _mine(session, own, worker)
        if row is not None:
            row.lease_until = db.now() + LEASE
        return row is not None


def store(
    db: Database,
    own: Claim,
    *,
    worker: str,
    summary: Mapping[str, Any],
    files: Mapping[str, bytes],
) -> bool:
    """Put a set in the place of the one before it; False when the claim was lost meanwhile."""
    packed = {name: zlib.compress(content, 6) for name, content in files.items()}
    with db.writing() as session:
        row = _mine(session, own, worker)
        if row is None:
            return False
        now = db.now()
        row.took_s = (now - row.started_at).total_seconds() if row.started_at else None
        row.as_of, row.seen, row.summary = own.as_of, own.seen, dict(summary)
        row.error = row.failed_at = None
        _free(row)
        session.execute(delete(FigureFileRow).where(FigureFileRow.set_id == row.id))
        session.add_all(
            FigureFileRow(set_id=row.id, name=name, content=content)
            for name, content in packed.items()
        )
        return True


def fail(db: Database, own: Claim, *, worker: str, error: str) -> None:
    """Store why a set could not be drawn; the one before it stays. It is tried again later."""
    with db.writing() as session:
        row = _mine(session, own, worker)
        if row is not None:
            row.error, row.failed_at = error[-MAX_ERROR_CHARS:], db.now()
            _free(row)


def release(db: Database, own: Claim, *, worker: str) -> None:
    """Give a claim back undrawn, as a worker does that is told to stop."""
    with db.writing() as session:
        row = _mine(session, own, worker)
        if row is not None:
            _free(row)


def free_dead(db: Database, is_dead: Callable[[str], bool]) -> int:
    """Free the claims of workers that ``is_dead`` says are gone; returns how many."""
    held = select(FigureSetRow).where(FigureSetRow.claimed_by.is_not(None))
    with db.reading() as session:  # most often there is nothing to write
        names = {row.claimed_by for row in session.scalars(held) if row.claimed_by}
    dead = {name for name in names if is_dead(name)}
    if not dead:
        return 0
    with db.writing() as session:
        rows = session.scalars(held.where(FigureSetRow.claimed_by.in_(dead))).all()
        for row in rows:
            _free(row)
        return len(rows)


def forget(session: Session, study_id: int) -> None:
    """Delete every set of a study, as when somebody withdraws who is in them."""
    # Locked first: whoever stores a set at this moment ends before, and is forgotten too.
    query = select(FigureSetRow.id).where(FigureSetRow.study_id == study_id).with_for_update()
    sets = session.scalars(query).all()
    session.execute(delete(FigureFileRow).where(FigureFileRow.set_id.in_(sets)))
    session.execute(delete(FigureSetRow).where(FigureSetRow.id.in_(sets)))


def _ensure(session: Session, study_id: int, kind: str) -> None:
    """Have a row for the set; another worker may make it at the same moment."""
    session.execute(
        text(
            "INSERT INTO figure_sets (study_id, kind) VALUES (:study_id, :kind) "
            "ON CONFLICT (study_id, kind) DO NOTHING"
        ),
        {"study_id": study_id, "kind": kind},
    )


def _mine(session: Session, own: Claim, worker: str) -> FigureSetRow | None:
    row = session.get(FigureSetRow, own.id, with_for_update=True, populate_existing=True)
    return row if row is not None and row.claimed_by == worker else None


def _free(row: FigureSetRow) -> None:
    row.claimed_by = row.lease_until = row.started_at = None
