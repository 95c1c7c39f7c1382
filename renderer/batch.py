"""Clips and their manifest: render what is missing, once, and survive being killed.

A clip's file appears under its name only when it is whole, and in the manifest only after that; an
interrupted batch leaves a hidden part file that the next one removes.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import socket
import statistics
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final, Protocol

import numpy as np
import numpy.typing as npt

from renderer.camera import iris_px_of_frame
from renderer.clip import ClipSpec
from renderer.encode import decode, open_encoder
from renderer.fidelity import Rectangle, eye_rectangles, psnr_db, ssim
from renderer.lod_path import places_of_clip
from renderer.manifest import ClipRecord, read_manifest, write_manifest
from renderer.sources import code_version

if TYPE_CHECKING:
    from renderer.frame import Frame

Pixels = npt.NDArray[np.uint8]
Progress = Callable[[float], None]

FIDELITY_FRAMES: Final = 12  # how many frames of a clip are decoded again and compared


class FrameSource(Protocol):
    """What a batch draws frames from; ``renderer.studio.Studio`` is the one that uses GL."""

    gl_renderer: str
    gl_version: str

    def frames(self, spec: ClipSpec) -> Iterator[Frame]:
        """Yield the clip's frames in order."""
        ...


@dataclass(frozen=True)
class _Crop:
    """One eye's rectangle of one raw frame."""

    rectangle: Rectangle
    pixels: Pixels


@dataclass
class _Measurements:
    """What is noted while a clip's frames pass by."""

    digest: hashlib._Hash = field(default_factory=hashlib.sha256)
    visible_px: list[list[int]] = field(default_factory=list)
    frame_ms: list[float] = field(default_factory=list)
    crops: dict[int, tuple[_Crop, _Crop]] = field(default_factory=dict)


def render_clips(
    specs: Iterable[ClipSpec],
    folder: Path,
    *,
    source: FrameSource,
    progress: Callable[[int, float], None] = lambda _number, _share: None,
) -> list[ClipRecord]:
    """Render the clips that the folder does not hold yet; return every clip's record.

    ``progress`` hears the clip's number (0-based) and the share of it that is done.
    """
    remove_parts(folder)
    return [
        render_clip(spec, folder, source=source, progress=partial(progress, number))
        for number, spec in enumerate(specs)
    ]


def render_clip(
    spec: ClipSpec,
    folder: Path,
    *,
    source: FrameSource,
    progress: Progress = lambda _share: None,
) -> ClipRecord:
    """Render, encode and check one clip, or return its record when it is there already."""
    kept = read_manifest(folder).current(spec.clip_id, folder)
    if kept is not None:
        progress(1.0)
        return kept
    folder.mkdir(parents=True, exist_ok=True)
    part = folder / f".{spec.clip_id}.{_host()}.{os.getpid()}.part.mp4"
    try:
        record = make_clip(spec, part, source=source, progress=progress)
        part.replace(folder / record.file)
    finally:
        part.unlink(missing_ok=True)
    keep_record(record, folder)
    return record


def make_clip(
    spec: ClipSpec,
    path: Path,
    *,
    source: FrameSource,
    progress: Progress = lambda _share: None,
) -> ClipRecord:
    """Render, encode and check one clip into ``path``; no folder's manifest is touched."""
    started = time.perf_counter()
    notes = _encode(spec, path, source, progress)
    fidelity = _compare(path, notes, size=(spec.width, spec.height))
    data = path.read_bytes()
    return ClipRecord(
        clip_id=spec.clip_id,
        spec=spec.to_dict(),
        file=f"{spec.clip_id}.mp4",
        file_sha256=hashlib.sha256(data).hexdigest(),
        file_bytes=len(data),
        raw_sha256=notes.digest.hexdigest(),
        frame_count=spec.frame_count,
        width=spec.width,
        height=spec.height,
        fps=spec.fps,
        iris_px=[
            [round(px, 3) for px in iris_px_of_frame(spec, frame)]
            for frame in range(spec.frame_count)
        ],
        lod_places=[[round(place, 4) for place in row] for row in places_of_clip(spec)],
        visible_px=notes.visible_px,
        psnr_db=[round(row[0], 3) for row in fidelity],
        ssim=[round(row[1], 5) for row in fidelity],
        frame_ms_median=round(statistics.median(notes.frame_ms), 3),
        render_s=round(time.perf_counter() - started, 3),
        gl_renderer=source.gl_renderer,
        gl_version=source.gl_version,
        code_version=code_version(),
    )


def keep_record(record: ClipRecord, folder: Path) -> None:
    """Add a clip's record to the folder's manifest; several processes may do so at once."""
    with _locked(folder):
        manifest = read_manifest(folder)
        manifest.add(record)
        write_manifest(manifest, folder)


def remove_parts(folder: Path) -> None:
    """Remove what this machine's ended processes left unfinished; those at work keep theirs."""
    for part in folder.glob(f".*.{_host()}.*.part.mp4"):
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


def _encode(spec: ClipSpec, part: Path, source: FrameSource, progress: Progress) -> _Measurements:
    notes = _Measurements()
    step = max(1, spec.frame_count // FIDELITY_FRAMES)
    with open_encoder(part, fps=spec.fps) as encoder:
        frames = source.frames(spec)
        for number in range(spec.frame_count):
            started = time.perf_counter()
            frame = next(frames)
            notes.frame_ms.append((time.perf_counter() - started) * 1000)
            encoder.append_data(frame.pixels)
            notes.digest.update(frame.pixels.tobytes())
            notes.visible_px.append(list(frame.visible_px))
            if number % step == 0:
                left, right = eye_rectangles(
                    spec, spec.azimuth_deg(number), distance_px=spec.distance_px(number)
                )
                notes.crops[number] = (
                    _Crop(left, frame.pixels[left].copy()),
                    _Crop(right, frame.pixels[right].copy()),
                )
            progress((number + 1) / spec.frame_count)
    return notes


def _compare(
    part: Path, notes: _Measurements, *, size: tuple[int, int]
) -> list[tuple[float, float]]:
    """Return PSNR in dB and SSIM per eye, the mean over the compared frames."""
    decoded = decode(part, list(notes.crops), size=size)
    rows = []
    for eye in (0, 1):
        pairs = [
            (crops[eye].pixels, decoded[number][crops[eye].rectangle])
            for number, crops in notes.crops.items()
        ]
        rows.append(
            (
                statistics.fmean(psnr_db(raw, seen) for raw, seen in pairs),
                statistics.fmean(ssim(raw, seen) for raw, seen in pairs),
            )
        )
    return rows


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Let one process at a time change the folder's manifest."""
    with (folder / ".manifest.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield
