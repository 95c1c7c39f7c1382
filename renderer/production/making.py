"""One clip: drawn, encoded beside the drawing, compared with what was drawn, described.

Knows no folder of clips and no manifest, and of GL only what draws for it.
"""

from __future__ import annotations

import hashlib
import statistics
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Protocol

from renderer.camera import iris_px_of_frame
from renderer.clip import ClipSpec
from renderer.encoding.attempts import settle
from renderer.encoding.bounds import Attempt, max_bytes, missed_bounds
from renderer.encoding.comparison import Comparison
from renderer.encoding.encode import open_encoder
from renderer.encoding.eye_boxes import eye_boxes
from renderer.lod.path import places_of_clip
from renderer.manifest import ClipRecord
from renderer.sources import code_version

if TYPE_CHECKING:
    from renderer.frame import Frame

Progress = Callable[[float], None]

DRAWN: Final = 0.95  # the share of the work that is done when a clip's last frame is drawn


class FrameSource(Protocol):
    """What a batch draws frames from; ``renderer.studio.Studio`` is the one that uses GL."""

    gl_renderer: str
    gl_version: str

    def frames(self, spec: ClipSpec, numbers: Sequence[int] | None = None) -> Iterator[Frame]:
        """Yield the clip's frames, or those with these numbers, in order."""
        ...


@dataclass
class _Measurements:
    """What is noted while a clip's frames pass by."""

    digest: hashlib._Hash = field(default_factory=hashlib.sha256)
    visible_px: list[list[int]] = field(default_factory=list)
    frame_ms: list[float] = field(default_factory=list)


def make_clip(
    spec: ClipSpec,
    path: Path,
    *,
    source: FrameSource,
    progress: Progress = lambda _share: None,
    master: Path | None = None,
    with_flip: bool = True,
) -> ClipRecord:
    """Render, encode and check one clip into ``path``; no folder's manifest is touched.

    ``master`` is where its frames are kept without loss. ``with_flip`` compares the encoding with
    the difference between the LoDs, for which a few frames are drawn with these exchanged.
    """
    started = time.perf_counter()
    comparison = Comparison(spec, with_flip=with_flip)
    lossless = master or path.with_suffix(".mkv")
    try:
        notes = _encode(spec, path, lossless, source=source, comparison=comparison, hear=progress)
        attempt = settle(path, lossless, spec=spec, comparison=comparison)
    finally:
        if master is None:
            lossless.unlink(missing_ok=True)
    progress(1.0)
    file = _describe(path, f"{spec.clip_id}.mp4")
    return ClipRecord(
        clip_id=spec.clip_id,
        spec=spec.to_dict(),
        file=file["file"],
        file_sha256=file["sha256"],
        file_bytes=file["bytes"],
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
        **_how_well(attempt, spec),
        master=None if master is None else _describe(master, f"{spec.clip_id}.master.mkv"),
        frame_ms_median=round(statistics.median(notes.frame_ms), 3),
        render_s=round(time.perf_counter() - started, 3),
        gl_renderer=source.gl_renderer,
        gl_version=source.gl_version,
        code_version=code_version(),
    )


def _describe(path: Path, name: str) -> dict[str, Any]:
    """Return what the manifest says of a file that is going to have a name."""
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return {"file": name, "sha256": digest, "bytes": path.stat().st_size}


def _how_well(attempt: Attempt, spec: ClipSpec) -> dict[str, Any]:
    """Return the manifest's fields that say how well a clip is encoded."""
    fidelity = attempt.fidelity
    return {
        "psnr_db": [round(value, 3) for value in fidelity.psnr_db],
        "ssim": [round(value, 5) for value in fidelity.ssim],
        "flip_rectangle": _rounded(fidelity.flip_rectangle),
        "flip_encoding": _rounded(fidelity.flip_encoding),
        "flip_lods": _rounded(fidelity.flip_lods),
        "flip_note": fidelity.flip_note,
        "crf": round(attempt.quality, 2),
        "max_bytes": max_bytes(spec),
        "missed": missed_bounds(attempt, limit=max_bytes(spec)),
    }


def _rounded(values: list[float] | None) -> list[float] | None:
    return None if values is None else [round(value, 5) for value in values]


def _encode(
    spec: ClipSpec,
    path: Path,
    lossless: Path,
    *,
    source: FrameSource,
    comparison: Comparison,
    hear: Progress,
) -> _Measurements:
    """Draw every frame once, into the clip, its master and what is compared."""
    notes = _Measurements()
    frames = source.frames(spec)
    with open_encoder(
        path,
        fps=spec.fps,
        size=(spec.width, spec.height),
        boxes=eye_boxes(spec),
        master=lossless,
    ) as encoder:
        for number in range(spec.frame_count):
            started = time.perf_counter()
            frame = next(frames)
            notes.frame_ms.append((time.perf_counter() - started) * 1000)
            encoder.write(frame.pixels)
            notes.digest.update(frame.pixels.data)
            notes.visible_px.append(list(frame.visible_px))
            comparison.take(number, frame.pixels)
            hear(DRAWN * (number + 1) / spec.frame_count)
    if comparison.other_lods:
        others = source.frames(spec.swapped(), comparison.other_lods)
        comparison.take_other(frame.pixels for frame in others)
    return notes
