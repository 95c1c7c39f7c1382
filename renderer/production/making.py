"""One clip: drawn and encoded beside the drawing, then compared with what was drawn, described.

Drawing needs GL, the rest does not: it can go on in another process while the next clip is drawn.
Knows no folder of clips and no manifest, and of GL only what draws for it.
"""

from __future__ import annotations

import hashlib
import statistics
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Protocol

from renderer.camera import iris_px_of_frame
from renderer.clip import ClipSpec
from renderer.encoding.bounds import max_bytes, max_rate, missed_bounds, quality
from renderer.encoding.comparison import Comparison, Fidelity
from renderer.encoding.encode import open_encoder
from renderer.encoding.eye_boxes import eye_boxes
from renderer.lod.path import places_of_clip
from renderer.manifest import ClipRecord
from renderer.production.beside import Beside
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
        """Yield the clip's frames, or those with these numbers, in order.

        A frame's pixels stay as they are: they are written while the next is drawn.
        """
        ...


@dataclass(kw_only=True)
class DrawnClip:
    """A clip's frames, encoded at ``path``, and what is not known without having drawn them."""

    spec: ClipSpec
    path: Path
    master: Path | None
    comparison: Comparison
    gl_renderer: str
    gl_version: str
    raw_sha256: str = ""
    visible_px: list[list[int]] = field(default_factory=list)
    frame_ms: list[float] = field(default_factory=list)
    drawing_s: float = 0.0


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
    drawn = draw_clip(
        spec, path, source=source, progress=progress, master=master, with_flip=with_flip
    )
    record = finish_clip(drawn)
    progress(1.0)
    return record


def draw_clip(
    spec: ClipSpec,
    path: Path,
    *,
    source: FrameSource,
    progress: Progress,
    master: Path | None,
    with_flip: bool,
) -> DrawnClip:
    """Draw every frame once, into the clip, its master and what is compared."""
    started = time.perf_counter()
    comparison = Comparison(spec, with_flip=with_flip)
    drawn = DrawnClip(
        spec=spec,
        path=path,
        master=master,
        comparison=comparison,
        gl_renderer=source.gl_renderer,
        gl_version=source.gl_version,
    )
    _encode(drawn, source=source, hear=progress)
    if comparison.other_lods:
        others = source.frames(spec.swapped(), comparison.other_lods)
        comparison.take_other(frame.pixels for frame in others)
    drawn.drawing_s = time.perf_counter() - started
    return drawn


def _encode(drawn: DrawnClip, *, source: FrameSource, hear: Progress) -> None:
    spec, digest = drawn.spec, hashlib.sha256()
    frames = source.frames(spec)
    with (
        open_encoder(
            drawn.path,
            fps=spec.fps,
            size=(spec.width, spec.height),
            boxes=eye_boxes(spec),
            quality=quality(spec),
            max_rate=max_rate(spec),
            master=drawn.master,
        ) as encoder,
        Beside() as beside,
    ):
        for number in range(spec.frame_count):
            started = time.perf_counter()
            frame = next(frames)
            drawn.frame_ms.append((time.perf_counter() - started) * 1000)
            drawn.visible_px.append(list(frame.visible_px))
            drawn.comparison.take(number, frame.pixels)
            beside.do(partial(encoder.write, frame.pixels))
            beside.do(partial(digest.update, frame.pixels.data))
            hear(DRAWN * (number + 1) / spec.frame_count)
    drawn.raw_sha256 = digest.hexdigest()


def finish_clip(drawn: DrawnClip) -> ClipRecord:
    """Compare a clip with what was drawn and describe it; needs no GL."""
    started = time.perf_counter()
    spec = drawn.spec
    fidelity = drawn.comparison.compare(drawn.path)
    file = _describe(drawn.path, f"{spec.clip_id}.mp4")
    name = f"{spec.clip_id}.master.mkv"
    master = None if drawn.master is None else _describe(drawn.master, name)
    return ClipRecord(
        clip_id=spec.clip_id,
        spec=spec.to_dict(),
        file=file["file"],
        file_sha256=file["sha256"],
        file_bytes=file["bytes"],
        raw_sha256=drawn.raw_sha256,
        frame_count=spec.frame_count,
        width=spec.width,
        height=spec.height,
        fps=spec.fps,
        iris_px=[
            [round(px, 3) for px in iris_px_of_frame(spec, frame)]
            for frame in range(spec.frame_count)
        ],
        lod_places=[[round(place, 4) for place in row] for row in places_of_clip(spec)],
        visible_px=drawn.visible_px,
        **_how_well(spec, fidelity, file_bytes=file["bytes"]),
        master=master,
        frame_ms_median=round(statistics.median(drawn.frame_ms), 3),
        render_s=round(drawn.drawing_s + time.perf_counter() - started, 3),
        gl_renderer=drawn.gl_renderer,
        gl_version=drawn.gl_version,
        code_version=code_version(),
    )


def _describe(path: Path, name: str) -> dict[str, Any]:
    """Return what the manifest says of a file that is going to have a name."""
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return {"file": name, "sha256": digest, "bytes": path.stat().st_size}


def _how_well(spec: ClipSpec, fidelity: Fidelity, *, file_bytes: int) -> dict[str, Any]:
    """Return the manifest's fields that say how well a clip is encoded."""
    return {
        "psnr_db": [round(value, 3) for value in fidelity.psnr_db],
        "ssim": [round(value, 5) for value in fidelity.ssim],
        "flip_rectangle": _rounded(fidelity.flip_rectangle),
        "flip_encoding": _rounded(fidelity.flip_encoding),
        "flip_lods": _rounded(fidelity.flip_lods),
        "flip_share": fidelity.flip_share and round(fidelity.flip_share, 4),
        "flip_floor": fidelity.flip_floor and round(fidelity.flip_floor, 4),
        "flip_note": fidelity.flip_note,
        "crf": round(quality(spec), 2),
        "max_bytes": max_bytes(spec),
        "missed": missed_bounds(file_bytes, fidelity, limit=max_bytes(spec)),
    }


def _rounded(values: list[float] | None) -> list[float] | None:
    return None if values is None else [round(value, 5) for value in values]
