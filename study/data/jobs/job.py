"""One job as it was read, and the reading of jobs."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import select

from renderer.clip import ClipSpec
from study.data.database import Database
from study.data.schema import JobRow

QUEUED, CLAIMED, DONE, FAILED = "queued", "claimed", "done", "failed"


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


def all_jobs(db: Database, clip_ids: Collection[str] | None = None) -> list[Job]:
    """Return the jobs in rendering order: all, or those of some clips."""
    query = select(JobRow).order_by(JobRow.priority)
    if clip_ids is not None:
        query = query.where(JobRow.clip_id.in_(clip_ids))
    with db.reading() as session:
        return [job_of(row) for row in session.scalars(query)]


def by_clip(db: Database, clip_id: str) -> Job | None:
    """Return the job of a clip, or None."""
    with db.reading() as session:
        row = session.scalar(select(JobRow).where(JobRow.clip_id == clip_id))
        return None if row is None else job_of(row)


def job_of(row: JobRow) -> Job:
    """Return a row as it stands now."""
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
