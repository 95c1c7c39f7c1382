"""The worker: renders what is wanted, once; survives crashes; stops when told."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import threading
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from renderer.clip import ClipSpec
from renderer.manifest import read_manifest, write_manifest
from study import worker
from study.data import jobs
from study.data.database import Database, open_database
from study.data.studies import Study
from study.worker import run_worker, stopping_on_signals
from study.worker_names import is_dead, worker_name

ROOT = Path(__file__).parents[2]


@pytest.fixture
def queue(db: Database, study: Study) -> list[str]:
    wanted = study.definition.wanted_specs()
    jobs.enqueue(db, wanted)
    return [clip.spec.clip_id for clip in wanted]


@pytest.fixture
def media(tmp_path: Path) -> Path:
    return tmp_path / "clips"


@pytest.fixture
def fast_beat(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(worker, "BEAT_S", 0.001)


def counting(render: Any, counts: Counter[str]) -> Any:
    lock = threading.Lock()

    def render_and_count(spec: ClipSpec, folder: Path, progress: Any) -> Any:
        with lock:
            counts[spec.clip_id] += 1
            return render(spec, folder, progress)

    return render_and_count


def test_every_clip_is_rendered_once_and_known_to_the_database(
    db: Database, queue: list[str], media: Path, render: Any
) -> None:
    counts: Counter[str] = Counter()
    assert run_worker(db, media, render=counting(render, counts), until_empty=True) == 16
    assert counts == dict.fromkeys(queue, 1)
    done = jobs.by_clip(db, queue[0])
    assert done is not None
    assert done.record is not None
    assert done.record["file"] == f"{queue[0]}.mp4"
    assert done.record["width"] == 320
    assert "visible_px" not in done.record
    assert jobs.summary(db).progress == 1.0


def test_a_clip_that_is_there_already_is_not_rendered_again(
    db: Database, queue: list[str], media: Path, render: Any
) -> None:
    job = jobs.by_clip(db, queue[0])
    assert job is not None
    render(job.spec, media, lambda _share: None)
    counts: Counter[str] = Counter()
    assert run_worker(db, media, render=counting(render, counts), until_empty=True) == 16
    assert counts[queue[0]] == 0
    assert sum(counts.values()) == 15


def test_a_second_run_renders_nothing(
    db: Database, queue: list[str], media: Path, render: Any
) -> None:
    assert queue
    run_worker(db, media, render=render, until_empty=True)
    counts: Counter[str] = Counter()
    assert run_worker(db, media, render=counting(render, counts), until_empty=True) == 0
    assert counts == {}


def test_a_finished_clip_whose_file_is_gone_is_rendered_again(
    db: Database, queue: list[str], media: Path, render: Any
) -> None:
    run_worker(db, media, render=render, until_empty=True)
    (media / f"{queue[3]}.mp4").unlink()
    counts: Counter[str] = Counter()
    assert run_worker(db, media, render=counting(render, counts), until_empty=True) == 1
    assert counts == {queue[3]: 1}


def make_older(media: Path) -> None:
    manifest = read_manifest(media)
    for record in manifest.clips.values():
        object.__setattr__(record, "code_version", "an older one")
    write_manifest(manifest, media)


def test_clips_of_an_older_renderer_are_renewed_only_until_somebody_began(
    db: Database, queue: list[str], media: Path, render: Any, walk: Any
) -> None:
    run_worker(db, media, render=render, until_empty=True)
    make_older(media)
    assert run_worker(db, media, render=render, until_empty=True) == len(queue)
    make_older(media)
    walk.begin()
    assert run_worker(db, media, render=render, until_empty=True) == 0


def test_a_clip_that_fails_is_tried_again_and_does_not_stop_the_others(
    db: Database, queue: list[str], media: Path, render: Any
) -> None:
    failures: Counter[str] = Counter()
    said: list[str] = []

    def fail_some(spec: ClipSpec, folder: Path, progress: Any) -> Any:
        if spec.clip_id == queue[0] or (spec.clip_id == queue[1] and not failures[queue[1]]):
            failures[spec.clip_id] += 1
            raise RuntimeError("out of memory")
        return render(spec, folder, progress)

    done = run_worker(db, media, render=fail_some, until_empty=True, poll_s=0.0, say=said.append)
    assert done == 15
    assert failures == {queue[0]: 3, queue[1]: 1}
    failed = jobs.by_clip(db, queue[0])
    assert failed is not None
    assert failed.state == "failed"
    assert "RuntimeError: out of memory" in str(failed.error)
    again = "failed (out of memory); it will be tried again"
    first, second = (f"near, 320x180, rightward ({clip_id})" for clip_id in queue[:2])
    assert said == [
        *[f"{first} {again}"] * 2,
        f"{first} failed (out of memory); given up",
        f"{second} {again}",
    ]


def test_several_workers_render_no_clip_twice(
    db: Database, queue: list[str], media: Path, render: Any
) -> None:
    counts: Counter[str] = Counter()
    renders = counting(render, counts)
    with ThreadPoolExecutor(3) as pool:
        done = [
            pool.submit(run_worker, db, media, render=renders, until_empty=True) for _ in range(3)
        ]
        assert sum(each.result() for each in done) == 16
    assert counts == dict.fromkeys(queue, 1)


def test_a_worker_told_to_stop_gives_its_clip_back(
    db: Database, queue: list[str], media: Path, render: Any
) -> None:
    stop = threading.Event()

    def stop_in_the_middle(spec: ClipSpec, folder: Path, progress: Any) -> Any:
        progress(0.5)
        stop.set()
        progress(0.6)
        return render(spec, folder, progress)

    assert run_worker(db, media, render=stop_in_the_middle, stop=stop) == 0
    first = jobs.by_clip(db, queue[0])
    assert first is not None
    assert (first.state, first.attempts, first.claimed_by) == ("queued", 0, None)
    assert not (media / f"{queue[0]}.mp4").exists()


@pytest.mark.usefixtures("fast_beat")
def test_progress_and_lease_are_written_while_a_clip_is_rendered(
    db: Database, queue: list[str], media: Path, render: Any, clock: Any
) -> None:
    seen: list[float] = []

    def slow(spec: ClipSpec, folder: Path, progress: Any) -> Any:
        clock.move(seconds=80)
        progress(0.25)
        for _ in range(2000):
            job = jobs.by_clip(db, spec.clip_id)
            assert job is not None
            if job.progress == 0.25:
                seen.append(job.progress)
                break
        return render(spec, folder, progress)

    run_worker(db, media, render=slow, until_empty=True)
    assert seen == [0.25] * 16
    assert queue


@pytest.mark.usefixtures("fast_beat")
def test_a_worker_that_lost_its_claim_leaves_the_clip_to_the_other(
    db: Database, queue: list[str], media: Path, render: Any
) -> None:
    lost = threading.Event()

    def lose(spec: ClipSpec, folder: Path, progress: Any) -> Any:
        if spec.clip_id == queue[0] and not lost.is_set():
            lost.set()
            assert jobs.requeue_dead(db, lambda _worker: True) == 1
            for _ in range(100_000):
                progress(0.1)
        return render(spec, folder, progress)

    assert run_worker(db, media, render=lose, until_empty=True, poll_s=0.0) == 16
    assert jobs.by_clip(db, queue[0]).attempts == 2  # type: ignore[union-attr] # it is there


KILLED = """
import os, signal, sys
from pathlib import Path
from study.data.database import open_database
from study.worker import run_worker

def die(spec, folder, progress):
    progress(0.5)
    os.kill(os.getpid(), signal.SIGKILL)

run_worker(open_database(sys.argv[1]), Path(sys.argv[2]), render=die, until_empty=True)
"""


def test_a_killed_worker_costs_only_its_clip_and_only_for_a_moment(
    db: Database, queue: list[str], media: Path, render: Any, tmp_path: Path
) -> None:
    database = str(tmp_path / "study.sqlite3")
    died = subprocess.run(
        [sys.executable, "-c", KILLED, database, str(media)], check=False, cwd=ROOT
    )
    assert died.returncode == -signal.SIGKILL
    left = jobs.by_clip(db, queue[0])
    assert left is not None
    assert left.state == "claimed"
    other = open_database(database)
    assert run_worker(other, media, render=render, until_empty=True) == 16
    other.close()
    done = jobs.by_clip(db, queue[0])
    assert done is not None
    assert (done.state, done.attempts) == ("done", 2)


def test_a_name_tells_whether_its_process_lives() -> None:
    mine = worker_name()
    host, pid, started, tag = mine.split("|")
    assert (host, int(pid)) == (socket.gethostname()[:60], os.getpid())
    assert not is_dead(mine)
    assert is_dead(f"{host}|{pid}|{int(started) + 1}|{tag}")
    assert is_dead(f"{host}|{2**22 + 1}|1|{tag}")
    assert not is_dead(f"elsewhere|{2**22 + 1}|1|{tag}")
    assert not is_dead("nonsense")
    assert worker_name() != mine


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_signals_ask_for_a_stop_and_are_given_back(number: signal.Signals) -> None:
    before = signal.getsignal(number)
    with stopping_on_signals() as stop:
        os.kill(os.getpid(), number)
        assert stop.wait(5)
    assert signal.getsignal(number) == before
