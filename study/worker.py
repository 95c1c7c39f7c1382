"""The worker: claims the clips that a database wants, one at a time, and has them rendered.

It renders through a callable that it is given, so it knows no GL. Several workers share a database
and never render one clip twice; one that is killed loses only its clip, which another takes over.
"""

from __future__ import annotations

import signal
import threading
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from pathlib import Path
from types import FrameType
from typing import Any, Final

from renderer.clip import ClipSpec
from renderer.manifest import ClipRecord, Manifest, read_manifest
from study.data import jobs, participants
from study.data.database import Database
from study.data.jobs import Job
from study.worker_names import is_dead, worker_name

Progress = Callable[[float], None]
Render = Callable[[ClipSpec, Path, Progress], ClipRecord]
Say = Callable[[str], None]

POLL_S: Final = 2.0
BEAT_S: Final = 1.0  # how often progress is written while a clip is rendered
PER_FRAME: Final = ("spec", "iris_px", "visible_px")  # stays in the manifest, too long for a row


class _StoppedError(Exception):
    """Rendering ends here: the worker was told to stop, or the job is no longer its own."""


def run_worker(
    db: Database,
    media_folder: Path,
    *,
    render: Render,
    stop: threading.Event | None = None,
    until_empty: bool = False,
    poll_s: float = POLL_S,
    say: Say = lambda _line: None,
) -> int:
    """Render jobs until told to stop; returns how many clips this worker brought in.

    ``render`` gets the spec, the folder and a callable for its progress from 0 to 1, writes the
    clip and the folder's manifest, and returns the clip's record. ``stop`` ends the work in the
    middle of a clip, which goes back into the queue; so does ``until_empty`` when nothing waits.
    """
    worker, stop = worker_name(), stop or threading.Event()
    jobs.requeue_dead(db, is_dead)
    requeue_missing(db, media_folder)
    rendered = 0
    while not stop.is_set():
        job = jobs.claim(db, worker=worker)
        if job is None:
            if jobs.requeue_dead(db, is_dead):
                continue
            if until_empty:
                break
            stop.wait(poll_s)
        elif _work(db, media_folder, job, _Task(worker, render, stop, say)):
            rendered += 1
        else:
            stop.wait(poll_s)
    return rendered


@dataclass(frozen=True)
class _Task:
    """What every job of one worker shares."""

    worker: str
    render: Render
    stop: threading.Event
    say: Say


def _work(db: Database, media_folder: Path, job: Job, task: _Task) -> bool:
    """Bring in one clip; True if it is there now through this worker."""
    try:
        record = read_manifest(media_folder).current(job.clip_id, media_folder)
        if record is None:
            with _Beat(db, job, task) as beat:
                record = task.render(job.spec, media_folder, beat.hear)
            if record.missed:
                task.say(f"{_name(job)}: {'; '.join(record.missed)}. It is kept.")
    except _StoppedError:
        jobs.release(db, job, worker=task.worker)
        return False
    except Exception as error:
        # Whatever goes wrong in one clip must not end the others: it is stored and shown.
        text = "".join(traceback.format_exception(error))
        state = jobs.fail(db, job, worker=task.worker, error=text)
        again = "it will be tried again" if state == jobs.QUEUED else "given up"
        task.say(f"{_name(job)} failed ({error}); {again}")
        return False
    return jobs.finish(db, job, worker=task.worker, record=short_record(record))


def short_record(record: ClipRecord) -> dict[str, Any]:
    """Return a clip's record without what it says frame by frame."""
    return {name: value for name, value in asdict(record).items() if name not in PER_FRAME}


def _name(job: Job) -> str:
    return f"{job.spec.distance}, {job.size}, {job.orbit_direction} ({job.clip_id})"


@dataclass
class _Beat:
    """Keeps a job's claim alive and its progress known while the renderer works."""

    db: Database
    job: Job
    task: _Task
    progress: float = 0.0
    is_lost: bool = False
    _ended: threading.Event = field(default_factory=threading.Event)
    _thread: threading.Thread | None = None

    def __enter__(self) -> _Beat:
        self._thread = threading.Thread(target=self._keep, name="heartbeat", daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        if self._thread is not None:
            self._thread.join()

    def hear(self, progress: float) -> None:
        """Take the renderer's progress; ends the rendering when the worker has to stop."""
        self.progress = progress
        if self.task.stop.is_set() or self.is_lost:
            raise _StoppedError

    def _keep(self) -> None:
        while not self._ended.wait(BEAT_S):
            if not jobs.report(self.db, self.job, worker=self.task.worker, progress=self.progress):
                self.is_lost = True
                return


def requeue_missing(db: Database, media_folder: Path) -> int:
    """Queue again the finished clips that are no longer there; returns how many.

    A clip made by another version of the renderer is made anew too, but only until somebody has
    begun: people of one study must not see different pictures.
    """
    # The jobs first: what another worker brings in meanwhile is then in the manifest, not gone.
    done = [job.clip_id for job in jobs.all_jobs(db) if job.state == jobs.DONE]
    manifest = read_manifest(media_folder)
    may_renew = not participants.anyone_has_begun(db)
    gone = [
        clip_id
        for clip_id in done
        if not _is_usable(manifest, media_folder, clip_id, may_renew=may_renew)
    ]
    return jobs.requeue(db, gone) if gone else 0


def _is_usable(manifest: Manifest, folder: Path, clip_id: str, *, may_renew: bool) -> bool:
    if may_renew:
        return manifest.current(clip_id, folder) is not None
    record = manifest.clips.get(clip_id)
    path = folder / record.file if record else None
    return bool(record and path and path.is_file() and path.stat().st_size == record.file_bytes)


@contextmanager
def stopping_on_signals() -> Iterator[threading.Event]:
    """Give an event that SIGTERM or SIGINT sets, for a worker that runs in the main thread."""
    stop = threading.Event()

    def handle(_signal: int, _frame: FrameType | None) -> None:
        stop.set()

    before = {number: signal.signal(number, handle) for number in (signal.SIGTERM, signal.SIGINT)}
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
