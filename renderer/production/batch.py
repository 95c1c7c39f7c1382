"""Clips and their manifest: render what is missing, once, and survive being killed.

A clip's file appears under its name only when it is whole, and in the manifest only after that; an
interrupted batch leaves a hidden part file that the next one removes.
"""

from __future__ import annotations

import fcntl
import os
import socket
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from renderer.clip import ClipSpec
from renderer.manifest import ClipRecord, read_manifest, write_manifest
from renderer.production.making import FrameSource, Progress, make_clip


def render_clips(
    specs: Iterable[ClipSpec],
    folder: Path,
    *,
    source: FrameSource,
    progress: Callable[[int, float], None] = lambda _number, _share: None,
    with_master: bool = False,
    with_flip: bool = True,
) -> list[ClipRecord]:
    """Render the clips that the folder does not hold yet; return every clip's record.

    ``progress`` hears the clip's number (0-based) and the share of it that is done.
    """
    remove_parts(folder)
    return [
        render_clip(
            spec,
            folder,
            source=source,
            progress=partial(progress, number),
            with_master=with_master,
            with_flip=with_flip,
        )
        for number, spec in enumerate(specs)
    ]


def render_clip(
    spec: ClipSpec,
    folder: Path,
    *,
    source: FrameSource,
    progress: Progress = lambda _share: None,
    with_master: bool = False,
    with_flip: bool = True,
) -> ClipRecord:
    """Render, encode and check one clip, or return its record when it is there already.

    ``with_master`` keeps its frames beside it without loss: a clip without them is made again.
    """
    kept = read_manifest(folder).current(spec.clip_id, folder)
    if kept is not None and (kept.has_master(folder) or not with_master):
        progress(1.0)
        return kept
    folder.mkdir(parents=True, exist_ok=True)
    part = folder / f".{spec.clip_id}.{_host()}.{os.getpid()}.part.mp4"
    master = part.with_suffix(".master.mkv")
    try:
        record = make_clip(
            spec,
            part,
            source=source,
            progress=progress,
            master=master if with_master else None,
            with_flip=with_flip,
        )
        if record.master is not None:
            master.replace(folder / record.master["file"])
        part.replace(folder / record.file)
    finally:
        part.unlink(missing_ok=True)
        master.unlink(missing_ok=True)
    keep_record(record, folder)
    return record


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
