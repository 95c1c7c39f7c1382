"""The worker: renders what is wanted, once; survives crashes; stops when told."""

from __future__ import annotations

import os
import queue
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
from renderer.manifest import Manifest, read_manifest, write_manifest
from study import worker
from study.data import jobs
from study.data.database import Database, open_database
from study.data.studies import Study
from study.worker import run_worker, stopping_on_signals
from study.worker_names import is_dead, worker_name

ROOT = Path(__file__).parents[2]


@pytest.fixture
def queued(db: Database, study: Study) -> list[str]:
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
    db: Database, queued: list[str], media: Path, render: Any
) -> None:
    counts: Counter[str] = Counter()
    assert run_worker(db, media, render=counting(render, counts), until_empty=True) == 16
    assert counts == dict.fromkeys(queued, 1)
    done = jobs.by_clip(db, queued[0])
    assert done is not None
    assert done.record is not None
    assert done.record["file"] == f"{queued[0]}.mp4"
    assert done.record["width"] == 320
    assert "visible_px" not in done.record
    assert jobs.summary(db).progress == 1.0


def test_a_clip_that_is_there_already_is_not_rendered_again(
    db: Database, queued: list[str], media: Path, render: Any
) -> None:
    job = jobs.by_clip(db, queued[0])
    assert job is not None
    render(job.spec, media, lambda _share: None)
    counts: Counter[str] = Counter()
    assert run_worker(db, media, render=counting(render, counts), until_empty=True) == 16
    assert counts[queued[0]] == 0
    assert sum(counts.values()) == 15


def test_a_second_run_renders_nothing(
    db: Database, queued: list[str], media: Path, render: Any
) -> None:
    assert queued
    run_worker(db, media, render=render, until_empty=True)
    counts: Counter[str] = Counter()
    assert run_worker(db, media, render=counting(render, counts), until_empty=True) == 0
    assert counts == {}


def test_a_finished_clip_whose_file_is_gone_is_rendered_again(
    db: Database, queued: list[str], media: Path, render: Any
) -> None:
    run_worker(db, media, render=render, until_empty=True)
    (media / f"{queued[3]}.mp4").unlink()
    counts: Counter[str] = Counter()
    assert run_worker(db, media, render=counting(render, counts), until_empty=True) == 1
    assert counts == {queued[3]: 1}


def make_older(media: Path) -> None:
    manifest = read_manifest(media)
    for record in manifest.clips.values():
        object.__setattr__(record, "code_version", "an older one")
    write_manifest(manifest, media)


def test_clips_of_an_older_renderer_are_renewed_only_until_somebody_began(
    db: Database, queued: list[str], media: Path, render: Any, walk: Any
) -> None:
    run_worker(db, media, render=render, until_empty=True)
    make_older(media)
    assert run_worker(db, media, render=render, until_empty=True) == len(queued)
    make_older(media)
    walk.begin()
    assert run_worker(db, media, render=render, until_empty=True) == 0


def test_a_clip_that_fails_is_tried_again_and_does_not_stop_the_others(
    db: Database, queued: list[str], media: Path, render: Any
) -> None:
    failures: Counter[str] = Counter()
    said: list[str] = []

    def fail_some(spec: ClipSpec, folder: Path, progress: Any) -> Any:
        if spec.clip_id == queued[0] or (spec.clip_id == queued[1] and not failures[queued[1]]):
            failures[spec.clip_id] += 1
            raise RuntimeError("out of memory")
        return render(spec, folder, progress)

    done = run_worker(db, media, render=fail_some, until_empty=True, poll_s=0.0, say=said.append)
    assert done == 15
    assert failures == {queued[0]: 3, queued[1]: 1}
    failed = jobs.by_clip(db, queued[0])
    assert failed is not None
    assert failed.state == "failed"
    assert "RuntimeError: out of memory" in str(failed.error)
    again = "failed (out of memory); it will be tried again"
    first, second = (f"near, 320x180, rightward ({clip_id})" for clip_id in queued[:2])
    assert said == [
        *[f"{first} {again}"] * 2,
        f"{first} failed (out of memory); given up",
        f"{second} {again}",
    ]


def test_several_workers_render_no_clip_twice(
    db: Database, queued: list[str], media: Path, render: Any
) -> None:
    counts: Counter[str] = Counter()
    renders = counting(render, counts)
    with ThreadPoolExecutor(3) as pool:
        done = [
            pool.submit(run_worker, db, media, render=renders, until_empty=True) for _ in range(3)
        ]
        assert sum(each.result() for each in done) == 16
    assert counts == dict.fromkeys(queued, 1)


def test_a_clip_that_another_worker_brings_in_meanwhile_is_not_gone(
    db: Database,
    queued: list[str],
    media: Path,
    render: Any,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A worker starts while another one finishes a clip: whatever it reads first, it sees it."""

    def finish_one() -> None:
        job = jobs.claim(db, worker="other")
        assert job is not None
        record = render(job.spec, media, lambda _share: None)
        assert jobs.finish(db, job, worker="other", record=worker.short_record(record))

    def read_and_finish(folder: Path) -> Manifest:
        manifest = read_manifest(folder)
        finish_one()
        return manifest

    def list_and_finish(db_: Database) -> list[jobs.Job]:
        listed = all_jobs(db_)
        finish_one()
        return listed

    all_jobs = jobs.all_jobs
    monkeypatch.setattr(worker, "read_manifest", read_and_finish)
    monkeypatch.setattr(jobs, "all_jobs", list_and_finish)
    assert worker.requeue_missing(db, media) == 0
    monkeypatch.undo()
    assert [jobs.by_clip(db, clip_id).state for clip_id in queued[:3]] == ["done", "done", "queued"]


def test_a_worker_told_to_stop_gives_its_clip_back(
    db: Database, queued: list[str], media: Path, render: Any
) -> None:
    stop = threading.Event()

    def stop_in_the_middle(spec: ClipSpec, folder: Path, progress: Any) -> Any:
        progress(0.5)
        stop.set()
        progress(0.6)
        return render(spec, folder, progress)

    assert run_worker(db, media, render=stop_in_the_middle, stop=stop) == 0
    first = jobs.by_clip(db, queued[0])
    assert first is not None
    assert (first.state, first.attempts, first.claimed_by) == ("queued", 0, None)
    assert not (media / f"{queued[0]}.mp4").exists()


LIMIT_S = 120.0  # for a busy machine; a beat takes milliseconds


Reports = queue.Queue[tuple[str, float, bool]]


@pytest.fixture
def reports(fast_beat: None, monkeypatch: pytest.MonkeyPatch) -> Reports:
    """Hear each beat when it is stored: clip, progress, whether it was still the worker's."""
    del fast_beat
    heard = Reports()
    report = jobs.report

    def report_and_tell(db: Database, job: jobs.Job, *, worker: str, progress: float) -> bool:
        is_mine = report(db, job, worker=worker, progress=progress)
        heard.put((job.clip_id, progress, is_mine))
        return is_mine

    monkeypatch.setattr(jobs, "report", report_and_tell)
    return heard


@pytest.mark.usefixtures("queued")
def test_progress_and_lease_are_written_while_a_clip_is_rendered(
    db: Database,
    media: Path,
    render: Any,
    clock: Any,
    reports: Reports,
) -> None:
    seen: list[float] = []

    def slow(spec: ClipSpec, folder: Path, progress: Any) -> Any:
        for _ in range(2):  # longer than a lease, were it not renewed
            clock.move(seconds=80)
            progress(0.25)
            while reports.get(timeout=LIMIT_S) != (spec.clip_id, 0.25, True):
                pass
        assert jobs.requeue_expired(db) == 0
        job = jobs.by_clip(db, spec.clip_id)
        assert job is not None
        seen.append(job.progress)
        return render(spec, folder, progress)

    assert run_worker(db, media, render=slow, until_empty=True) == 16
    assert seen == [0.25] * 16


def test_a_worker_that_lost_its_claim_leaves_the_clip_to_the_other(
    db: Database,
    queued: list[str],
    media: Path,
    render: Any,
    reports: Reports,
) -> None:
    rendered: Counter[str] = Counter()
    counted = counting(render, rendered)
    lost = threading.Event()

    def lose(spec: ClipSpec, folder: Path, progress: Any) -> Any:
        if spec.clip_id == queued[0] and not lost.is_set():
            lost.set()
            assert jobs.requeue_dead(db, lambda _worker: True) == 1
            while reports.get(timeout=LIMIT_S)[2]:
                pass
            while True:  # the beat has seen it: the next progress or the one after ends this
                progress(0.1)
        return counted(spec, folder, progress)

    assert run_worker(db, media, render=lose, until_empty=True, poll_s=0.0) == 16
    assert rendered == dict.fromkeys(queued, 1)
    first = jobs.by_clip(db, queued[0])
    assert first is not None
    assert first.attempts == 2


SHARED = """
import sys
from pathlib import Path
from conftest import fake_render
from renderer.production.folder import keep_record
from renderer.manifest import read_manifest
from study.data.database import open_database
from study.worker import run_worker

def render(spec, folder, progress):
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "rendered.txt").open("a") as file:
        file.write(spec.clip_id + "\\n")
    alone = Path(sys.argv[3])
    record = fake_render(spec, alone, progress)
    (alone / record.file).rename(folder / record.file)
    keep_record(record, folder)
    return record

print(run_worker(open_database(sys.argv[1]), Path(sys.argv[2]), render=render, until_empty=True))
"""


def test_three_processes_on_one_file_render_no_clip_twice(
    db: Database, queued: list[str], media: Path, tmp_path: Path, database_url: str
) -> None:
    here = Path(__file__).parent
    workers = [
        subprocess.Popen(
            [sys.executable, "-c", SHARED, database_url, str(media)]
            + [str(tmp_path / f"alone-{number}")],
            env=os.environ | {"PYTHONPATH": f"{ROOT}{os.pathsep}{here}"},
            stdout=subprocess.PIPE,
            text=True,
        )
        for number in range(3)
    ]
    brought = [int(process.communicate(timeout=LIMIT_S)[0]) for process in workers]
    assert sum(brought) == 16
    assert sorted((media / "rendered.txt").read_text().split()) == sorted(queued)
    assert jobs.summary(db).done == 16
    assert sorted(read_manifest(media).clips) == sorted(queued)


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
    db: Database, queued: list[str], media: Path, render: Any, database_url: str
) -> None:
    died = subprocess.run(
        [sys.executable, "-c", KILLED, database_url, str(media)], check=False, cwd=ROOT
    )
    assert died.returncode == -signal.SIGKILL
    left = jobs.by_clip(db, queued[0])
    assert left is not None
    assert left.state == "claimed"
    other = open_database(database_url)
    assert run_worker(other, media, render=render, until_empty=True) == 16
    other.close()
    done = jobs.by_clip(db, queued[0])
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


def test_a_process_that_ended_is_dead_before_its_parent_has_noticed() -> None:
    code = (
        "import sys; from study.worker_names import worker_name; print(worker_name(), flush=True)"
    )
    child = subprocess.Popen(
        [sys.executable, "-c", f"{code}; sys.stdin.read()"],
        cwd=ROOT,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert child.stdout is not None
    name = child.stdout.readline().strip()
    assert not is_dead(name)
    child.kill()
    os.waitid(os.P_PID, child.pid, os.WEXITED | os.WNOWAIT)  # it stays there as a zombie
    assert is_dead(name)
    child.communicate()
    assert is_dead(name)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_signals_ask_for_a_stop_and_are_given_back(number: signal.Signals) -> None:
    before = signal.getsignal(number)
    with stopping_on_signals() as stop:
        os.kill(os.getpid(), number)
        assert stop.wait(5)
    assert signal.getsignal(number) == before
