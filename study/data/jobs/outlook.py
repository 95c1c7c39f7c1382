"""How far rendering is, and how long it will take."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Final

from renderer.clip import ClipSpec
from study.data.database import Database
from study.data.jobs.job import CLAIMED, DONE, FAILED, QUEUED, Job, all_jobs

_STATES: Final = (QUEUED, CLAIMED, DONE, FAILED)


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
