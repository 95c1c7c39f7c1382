"""What waits to be rendered, and how it comes to wait again."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from datetime import datetime, timedelta
from typing import Final

from sqlalchemy import select

from study.data.database import Database
from study.data.jobs.job import CLAIMED, FAILED, QUEUED
from study.data.schema import JobRow
from study.design.definition import WantedClip

LEASE: Final = timedelta(seconds=90)
MAX_ATTEMPTS: Final = 3


def enqueue(db: Database, wanted: Iterable[WantedClip]) -> int:
    """Queue the clips that are not queued yet, in the given order; returns how many were new.

    A clip whose rendering failed before is queued again.
    """
    added = 0
    with db.writing() as session:
        known = {row.clip_id: row for row in session.scalars(select(JobRow))}
        last = max((row.priority for row in known.values()), default=0)
        for clip in wanted:
            row = known.get(clip.spec.clip_id)
            if row is None:
                added += 1
                row = _new_row(clip, last + added, db.now())
                known[row.clip_id] = row
                session.add(row)
            elif row.state == FAILED:
                _queue(row)
    return added


def requeue_expired(db: Database) -> int:
    """Queue the jobs again whose lease ran out; returns how many."""
    with db.writing() as session:
        rows = session.scalars(
            select(JobRow)
            .where(JobRow.state == CLAIMED, JobRow.lease_until < db.now())
            .with_for_update(skip_locked=True)
        ).all()
        for row in rows:
            _give_up(row, "its worker stopped reporting")
        return len(rows)


def requeue_dead(db: Database, is_dead: Callable[[str], bool]) -> int:
    """Queue the jobs again whose worker ``is_dead`` says is gone; returns how many."""
    with db.writing() as session:
        rows = session.scalars(
            select(JobRow).where(JobRow.state == CLAIMED).with_for_update(skip_locked=True)
        ).all()
        dead = [row for row in rows if row.claimed_by and is_dead(row.claimed_by)]
        for row in dead:
            _give_up(row, "its worker was killed")
        return len(dead)


def requeue(db: Database, clip_ids: Collection[str]) -> int:
    """Queue these clips again whatever became of them, except those being rendered now."""
    with db.writing() as session:
        rows = session.scalars(
            select(JobRow).where(JobRow.clip_id.in_(clip_ids), JobRow.state != CLAIMED)
        ).all()
        for row in rows:
            _queue(row)
        return len(rows)


def _new_row(clip: WantedClip, priority: int, now: datetime) -> JobRow:
    return JobRow(
        clip_id=clip.spec.clip_id,
        spec=clip.spec.to_dict(),
        size=str(clip.size),
        orbit_direction=clip.orbit_direction,
        state=QUEUED,
        priority=priority,
        attempts=0,
        progress=0.0,
        created_at=now,
    )


def _queue(row: JobRow) -> None:
    row.attempts, row.error, row.record = 0, None, None
    free(row)


def _give_up(row: JobRow, reason: str) -> None:
    row.error = reason
    free(row)
    if row.attempts >= MAX_ATTEMPTS:
        row.state = FAILED


def free(row: JobRow) -> None:
    """Let a job wait for whoever claims it next."""
    row.state, row.progress = QUEUED, 0.0
    row.claimed_by, row.lease_until, row.finished_at = None, None, None
