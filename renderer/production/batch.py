"""Clips and their manifest: render what is missing, once, and survive being killed.

A clip's file appears under its name only when it is whole, and in the manifest only after that; an
interrupted batch leaves a hidden part file that the next one removes. While a clip is drawn, the
one before is compared with its encoding in another process.
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
from renderer.production.finishing import Finishing
from renderer.production.making import DrawnClip, FrameSource, Progress, draw_clip, finish_clip


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
    wanted = {spec.clip_id: spec for spec in specs}
    records: dict[str, ClipRecord] = {}
    waiting: list[Callable[[], ClipRecord]] = []

    def bring_in() -> None:
        while waiting:
            record = waiting.pop()()
            records[record.clip_id] = record

    with Finishing() as finishing:
        try:
            for number, (clip_id, spec) in enumerate(wanted.items()):
                kept = _kept(spec, folder, with_master=with_master)
                if kept is None:
                    drawn = _draw(
                        spec,
                        folder,
                        source=source,
                        progress=partial(progress, number),
                        with_master=with_master,
                        with_flip=with_flip,
                    )
                    bring_in()
                    is_last = number + 1 == len(wanted)
                    finished = partial(finish_clip, drawn) if is_last else finishing.start(drawn)
                    waiting.append(partial(_bring_in, drawn, folder, finished))
                else:
                    records[clip_id] = kept
                    progress(number, 1.0)
        finally:
            bring_in()  # what is drawn is not lost by what went wrong later
    if records:
        progress(len(wanted) - 1, 1.0)
    return [records[clip_id] for clip_id in wanted]


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
    kept = _kept(spec, folder, with_master=with_master)
    if kept is None:
        drawn = _draw(
            spec,
            folder,
            source=source,
            progress=progress,
            with_master=with_master,
            with_flip=with_flip,
        )
        kept = _bring_in(drawn, folder, partial(finish_clip, drawn))
    progress(1.0)
    return kept


def _kept(spec: ClipSpec, folder: Path, *, with_master: bool) -> ClipRecord | None:
    record = read_manifest(folder).current(spec.clip_id, folder)
    return record if record and (record.has_master(folder) or not with_master) else None


def _draw(
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


def _bring_in(drawn: DrawnClip, folder: Path, finished: Callable[[], ClipRecord]) -> ClipRecord:
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
