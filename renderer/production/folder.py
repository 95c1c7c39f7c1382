"""A folder of clips and its manifest, as clips come into it.

A clip's file appears under its name only when it is whole, and in the manifest only after that; who
is interrupted leaves a hidden part file that the next batch removes.
"""

from __future__ import annotations

import fcntl
import os
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from renderer.clip import ClipSpec
from renderer.manifest import ClipRecord, read_manifest, write_manifest
from renderer.production.drawing import DrawnClip, FrameSource, Progress, draw_clip


def kept_record(spec: ClipSpec, folder: Path, *, with_master: bool) -> ClipRecord | None:
    """Return the record of a clip that is there, whole and current, with its master if wanted."""
    record = read_manifest(folder).current(spec.clip_id, folder)
    return record if record and (record.has_master(folder) or not with_master) else None


def draw_part(
    spec: ClipSpec,
    folder: Path,
    *,
    source: FrameSource,
    progress: Progress,
    with_master: bool,
    with_flip: bool,
) -> DrawnClip:
    """Draw a clip into a part file, and its master into another."""
    folder.mkdir(parents=True, exist_ok=True)
    part = folder / f".{spec.clip_id}.{_host()}.{os.getpid()}.part.mp4"
    master = part.with_suffix(".master.mkv") if with_master else None
    try:
        return draw_clip(
            spec, part, source=source, progress=progress, master=master, with_flip=with_flip
        )
    except BaseException:
        _remove(part, master)
        raise


def bring_in(drawn: DrawnClip, folder: Path, finished: Callable[[], ClipRecord]) -> ClipRecord:
    """Give a clip's files their names and the manifest its record, once it is finished."""
    try:
        record = finished()
        if drawn.master is not None and record.master is not None:
            drawn.master.replace(folder / record.master["file"])
        drawn.path.replace(folder / record.file)
    finally:
        _remove(drawn.path, drawn.master)
    keep_record(record, folder)
    return record


def _remove(*paths: Path | None) -> None:
    for path in paths:
        if path is not None:
            path.unlink(missing_ok=True)


def keep_record(record: ClipRecord, folder: Path) -> None:
    """Add a clip's record to the folder's manifest; several processes may do so at once."""
    with _locked(folder):
        manifest = read_manifest(folder)
        manifest.add(record)
        write_manifest(manifest, folder)


def remove_parts(folder: Path) -> None:
    """Remove what this machine's ended processes left unfinished; those at work keep theirs."""
    for part in folder.glob(f".*.{_host()}.*.part.*"):
        if not _is_alive(int(part.name.split(".")[3])):
            part.unlink(missing_ok=True)


def _host() -> str:
    """Return this machine's name: a folder that several share holds parts of all of them."""
    return socket.gethostname().replace(".", "-")


def _is_alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Let one process at a time change the folder's manifest."""
    with (folder / ".manifest.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield
