"""Jobs: the clips to render, claimed by workers one at a time and never by two.

A claim is a lease. A worker that dies leaves its lease behind: it runs out, or another worker on
the same machine sees that the process is gone and frees it at once.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, Final

from sqlalchemy import select
from sqlalchemy.orm import Session

from renderer.clip import ClipSpec
from study.data.database import Database
from study.data.schema import JobRow
from study.design.definition import WantedClip

QUEUED, CLAIMED, DONE, FAILED = "queued", "claimed", "done", "failed"
LEASE: Final = timedelta(seconds=90)
MAX_ATTEMPTS: Final = 3
MAX_ERROR_CHARS: Final = 4000


@dataclass(frozen=True)
class Job:
    """One clip to render, as of the moment it was read. ``progress`` runs from 0 to 1."""

    id: int
    clip_id: str
    spec: ClipSpec
    size: str
    orbit_direction: str
    state: str
    priority: int
    attempts: int
    progress: float
    claimed_by: str | None
    error: str | None
    record: Mapping[str, Any] | None
    started_at: datetime | None
    finished_at: datetime | None


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


def claim(db: Database, *, worker: str) -> Job | None:
    """Claim the next job for ``worker`` (a name of its own), or None when nothing waits.

    Jobs whose lease ran out count as waiting.
    """
    now = db.now()
    with db.writing() as session:
        requeue_expired(db)
        row = session.scalars(
            select(JobRow)
            .where(JobRow.state == QUEUED)
            .order_by(JobRow.priority)
            .limit(1)
            .with_for_update(skip_locked=True)
        ).one_or_none()
        if row is None:
            return None
        row.state, row.claimed_by, row.lease_until = CLAIMED, worker, now + LEASE
        row.attempts += 1
        row.progress, row.error, row.started_at = 0.0, None, now
        return _job(row)


def report(db: Database, job: Job, *, worker: str, progress: float) -> bool:
    """Renew the lease and store the progress; False when the job is no longer this worker's."""
    with db.writing() as session:
        row = _mine(session, job, worker)
        if row is None:
            return False
        row.progress = max(row.progress, min(1.0, max(0.0, progress)))
        row.lease_until = db.now() + LEASE
        return True


def finish(db: Database, job: Job, *, worker: str, record: Mapping[str, Any]) -> bool:
    """Mark a job as done with what is known of its clip; False when it was another worker's."""
    with db.writing() as session:
        row = _mine(session, job, worker)
        if row is None:
            return False
        row.state, row.progress, row.record = DONE, 1.0, dict(record)
        row.claimed_by, row.lease_until, row.finished_at = None, None, db.now()
        return True


def fail(db: Database, job: Job, *, worker: str, error: str) -> str | None:
    """Store why a job failed. It is tried again up to MAX_ATTEMPTS times; returns its new state."""
    with db.writing() as session:
        row = _mine(session, job, worker)
        if row is None:
            return None
        row.error = error[-MAX_ERROR_CHARS:]
        row.state = FAILED if row.attempts >= MAX_ATTEMPTS else QUEUED
        row.claimed_by, row.lease_until, row.finished_at = None, None, db.now()
        return row.state


def release(db: Database, job: Job, *, worker: str) -> None:
    """Give a job back unrendered, as a worker does that is told to stop; costs no attempt."""
    with db.writing() as session:
        row = _mine(session, job, worker)
        if row is not None:
            row.attempts -= 1
            _free(row)


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


def all_jobs(db: Database, clip_ids: Collection[str] | None = None) -> list[Job]:
    """Return the jobs in rendering order: all, or those of some clips."""
    query = select(JobRow).order_by(JobRow.priority)
    if clip_ids is not None:
        query = query.where(JobRow.clip_id.in_(clip_ids))
    with db.reading() as session:
        return [_job(row) for row in session.scalars(query)]


def by_clip(db: Database, clip_id: str) -> Job | None:
    """Return the job of a clip, or None."""
    with db.reading() as session:
        row = session.scalar(select(JobRow).where(JobRow.clip_id == clip_id))
        return None if row is None else _job(row)


@dataclass(frozen=True)
class Summary:
    """How far rendering is. ``left_s`` estimates the time left from the clips done so far."""

    queued: int
    claimed: int
    done: int
    failed: int
    progress: float
    left_s: float | None

    @property
    def total(self) -> int:
        """All jobs."""
        return self.queued + self.claimed + self.done + self.failed


def summary(db: Database, clip_ids: Collection[str] | None = None) -> Summary:
    """Summarise the jobs: all, or those of some clips (of one study, of one arm)."""
    found = all_jobs(db, clip_ids)
    count = {state: sum(job.state == state for job in found) for state in _STATES}
    share = sum(1.0 if job.state == DONE else job.progress for job in found)
    return Summary(**count, progress=share / len(found) if found else 1.0, left_s=_left_s(found))


_STATES: Final = (QUEUED, CLAIMED, DONE, FAILED)


def _left_s(found: list[Job]) -> float | None:
    """Estimate the time left: seconds per pixel of the finished clips x pixels not drawn yet."""
    timed = [
        ((job.finished_at - job.started_at).total_seconds(), _pixels(job.spec))
        for job in found
        if job.state == DONE and job.finished_at and job.started_at and job.record
    ]
    drawn = sum(pixels for _, pixels in timed)
    left = sum(
        _pixels(job.spec) * (1 - job.progress) for job in found if job.state in (QUEUED, CLAIMED)
    )
    workers = max(1, sum(job.state == CLAIMED for job in found))
    return left * sum(seconds for seconds, _ in timed) / drawn / workers if drawn else None


def _pixels(spec: ClipSpec) -> int:
    return spec.width * spec.height * spec.frame_count


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


def _mine(session: Session, job: Job, worker: str) -> JobRow | None:
    row = session.get_one(JobRow, job.id, with_for_update=True, populate_existing=True)
    return row if row.state == CLAIMED and row.claimed_by == worker else None


def _queue(row: JobRow) -> None:
    row.attempts, row.error, row.record = 0, None, None
    _free(row)


def _give_up(row: JobRow, reason: str) -> None:
    row.error = reason
    _free(row)
    if row.attempts >= MAX_ATTEMPTS:
        row.state = FAILED


def _free(row: JobRow) -> None:
    row.state, row.progress = QUEUED, 0.0
    row.claimed_by, row.lease_until, row.finished_at = None, None, None


def _job(row: JobRow) -> Job:
    return Job(
        id=row.id,
        clip_id=row.clip_id,
        spec=ClipSpec.from_dict(row.spec),
        size=row.size,
        orbit_direction=row.orbit_direction,
        state=row.state,
        priority=row.priority,
        attempts=row.attempts,
        progress=row.progress,
        claimed_by=row.claimed_by,
        error=row.error,
        record=row.record,
        started_at=row.started_at,
        finished_at=row.finished_at,
    )
