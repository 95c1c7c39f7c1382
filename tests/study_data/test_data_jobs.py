"""Jobs: claimed in order, by one worker each, and never lost."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

from study.data import jobs
from study.data.database import Database
from study.data.jobs import Job
from study.data.studies import Study
from study.design.definition import parse_definition


@pytest.fixture
def queue(db: Database, study: Study) -> list[str]:
    """Queue the study's clips; return their ids in rendering order."""
    wanted = study.definition.wanted_specs()
    jobs.enqueue(db, wanted)
    return [clip.spec.clip_id for clip in wanted]


def claim(db: Database, worker: str = "w") -> Job:
    job = jobs.claim(db, worker=worker)
    assert job is not None
    return job


def test_jobs_come_in_rendering_order(db: Database, queue: list[str], study: Study) -> None:
    claimed = [claim(db) for _ in queue]
    assert [job.clip_id for job in claimed] == queue
    assert [job.spec for job in claimed] == [w.spec for w in study.definition.wanted_specs()]
    assert jobs.claim(db, worker="w") is None


def test_a_clip_is_queued_once(db: Database, queue: list[str], study: Study) -> None:
    assert jobs.enqueue(db, study.definition.wanted_specs()) == 0
    assert len(jobs.all_jobs(db)) == len(queue) == 16


def test_another_study_queues_only_its_new_clips_behind(
    db: Database, queue: list[str], raw: dict[str, Any]
) -> None:
    raw["key"] = "other"
    raw["clips"].append({"id": "c", "distance": "near", "left": "own", "right": "ultra"})
    other = parse_definition(raw)
    assert jobs.enqueue(db, other.wanted_specs()) == 4
    assert [job.clip_id for job in jobs.all_jobs(db)][:16] == queue


def test_only_its_worker_may_report_and_finish_a_job(db: Database, queue: list[str]) -> None:
    job = claim(db, "mine")
    assert job.clip_id == queue[0]
    assert not jobs.report(db, job, worker="other", progress=0.5)
    assert not jobs.finish(db, job, worker="other", record={})
    assert jobs.fail(db, job, worker="other", error="no") is None
    assert jobs.report(db, job, worker="mine", progress=0.5)
    assert jobs.finish(db, job, worker="mine", record={"file": "a.mp4"})
    assert not jobs.finish(db, job, worker="mine", record={})
    done = jobs.by_clip(db, job.clip_id)
    assert done is not None
    assert (done.state, done.progress, done.record) == ("done", 1.0, {"file": "a.mp4"})


def test_progress_never_goes_back(db: Database, queue: list[str]) -> None:
    job = claim(db)
    for share in (0.3, 0.1, 7.0):
        jobs.report(db, job, worker="w", progress=share)
    found = jobs.by_clip(db, queue[0])
    assert found is not None
    assert found.progress == 1.0


def test_a_lease_that_ran_out_frees_its_job(db: Database, queue: list[str], clock: Any) -> None:
    lost = claim(db, "dead")
    clock.move(seconds=89)
    assert claim(db, "second").clip_id == queue[1]
    clock.move(seconds=2)
    again = claim(db, "third")
    assert again.clip_id == lost.clip_id == queue[0]
    assert again.attempts == 2
    assert not jobs.finish(db, lost, worker="dead", record={})


def test_a_heartbeat_keeps_the_lease(db: Database, queue: list[str], clock: Any) -> None:
    job = claim(db, "slow")
    for _ in range(5):
        clock.move(seconds=80)
        assert jobs.report(db, job, worker="slow", progress=0.1)
        assert jobs.requeue_expired(db) == 0
    kept = jobs.by_clip(db, queue[0])
    assert kept is not None
    assert kept.claimed_by == "slow"


def test_a_failing_clip_is_tried_three_times_and_then_given_up(
    db: Database, queue: list[str], study: Study
) -> None:
    states = [jobs.fail(db, claim(db), worker="w", error="x" * 5000 + "the end") for _ in range(3)]
    assert states == ["queued", "queued", "failed"]
    failed = jobs.by_clip(db, queue[0])
    assert failed is not None
    assert failed.error is not None
    assert failed.error.endswith("the end")
    assert len(failed.error) == 4000
    assert claim(db).clip_id == queue[1]
    jobs.enqueue(db, study.definition.wanted_specs())
    assert claim(db).clip_id == queue[0]


def test_a_clip_that_kills_its_workers_is_given_up_too(db: Database, queue: list[str]) -> None:
    for attempt in range(1, 4):
        assert claim(db, f"killed-{attempt}").clip_id == queue[0]
        assert jobs.requeue_dead(db, lambda worker: worker.startswith("killed")) == 1
    failed = jobs.by_clip(db, queue[0])
    assert failed is not None
    assert (failed.state, failed.error) == ("failed", "its worker was killed")
    assert claim(db, "alive").clip_id == queue[1]
    assert jobs.requeue_dead(db, lambda worker: worker.startswith("killed")) == 0


def test_a_job_given_back_costs_no_attempt(db: Database, queue: list[str]) -> None:
    for _ in range(5):
        jobs.release(db, claim(db), worker="w")
    job = claim(db)
    assert (job.clip_id, job.attempts) == (queue[0], 1)


def test_summary_counts_and_estimates(db: Database, queue: list[str], clock: Any) -> None:
    assert jobs.summary(db).left_s is None
    for _ in range(4):
        job = claim(db)
        clock.move(seconds=10)
        jobs.finish(db, job, worker="w", record={"file": "x"})
    job = claim(db)
    jobs.report(db, job, worker="w", progress=0.5)
    found = jobs.summary(db)
    assert (found.queued, found.claimed, found.done, found.failed) == (11, 1, 4, 0)
    assert found.total == 16
    assert found.progress == pytest.approx(4.5 / 16)
    # 3.5 small clips at 10 s, 8 with four times the pixels at 40 s.
    assert found.left_s == pytest.approx(3.5 * 10 + 8 * 40)
    first = jobs.summary(db, set(queue[:4]))
    assert (first.done, first.total, first.progress) == (4, 4, 1.0)


def test_many_workers_share_the_queue_without_claiming_a_job_twice(
    db: Database, queue: list[str]
) -> None:
    def work(number: int) -> list[str]:
        mine = []
        while (job := jobs.claim(db, worker=f"w{number}")) is not None:
            mine.append(job.clip_id)
            assert jobs.finish(db, job, worker=f"w{number}", record={})
        return mine

    with ThreadPoolExecutor(4) as pool:
        claimed = [clip_id for mine in pool.map(work, range(4)) for clip_id in mine]
    assert sorted(claimed) == sorted(queue)
    assert jobs.summary(db).done == 16
