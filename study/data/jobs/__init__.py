"""Jobs: the clips to render, claimed by workers one at a time and never by two.

A claim is a lease. A worker that dies leaves its lease behind: it runs out, or another worker on
the same machine sees that the process is gone and frees it at once.
"""

from study.data.jobs.claims import claim, fail, finish, release, report
from study.data.jobs.job import CLAIMED, DONE, FAILED, QUEUED, Job, all_jobs, by_clip
from study.data.jobs.outlook import Summary, summary
from study.data.jobs.queue import (
    LEASE,
    MAX_ATTEMPTS,
    enqueue,
    requeue,
    requeue_dead,
    requeue_expired,
)

__all__ = [
    "CLAIMED",
    "DONE",
    "FAILED",
    "LEASE",
    "MAX_ATTEMPTS",
    "QUEUED",
    "Job",
    "Summary",
    "all_jobs",
    "by_clip",
    "claim",
    "enqueue",
    "fail",
    "finish",
    "release",
    "report",
    "requeue",
    "requeue_dead",
    "requeue_expired",
    "summary",
]
