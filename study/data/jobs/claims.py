"""One worker's hold on one job: claimed, kept alive, ended in one way or another."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from sqlalchemy import select
from sqlalchemy.orm import Session

from study.data.database import Database
from study.data.jobs.job import CLAIMED, DONE, FAILED, QUEUED, Job, job_of
from study.data.jobs.queue import LEASE, MAX_ATTEMPTS, free, requeue_expired
from study.data.schema import JobRow

MAX_ERROR_CHARS: Final = 4000


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
        return job_of(row)


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
            free(row)


def _mine(session: Session, job: Job, worker: str) -> JobRow | None:
    row = session.get_one(JobRow, job.id, with_for_update=True, populate_existing=True)
    return row if row.state == CLAIMED and row.claimed_by == worker else None
