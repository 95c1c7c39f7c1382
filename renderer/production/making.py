"""One clip: drawn and encoded, then compared with what was drawn and described.

Drawing needs GL, the rest does not: it can go on in another process while the next clip is drawn.
Knows no folder of clips and no manifest.
"""

from __future__ import annotations

import hashlib
import statistics
import time
from pathlib import Path
from typing import Any

from renderer.camera import iris_px_of_frame
from renderer.clip import ClipSpec
from renderer.encoding.bounds import fineness, max_bytes, missed_bounds
from renderer.encoding.comparison import Fidelity
from renderer.lod.path import places_of_clip
from renderer.manifest import ClipRecord
from renderer.production.drawing import DrawnClip, FrameSource, Progress, draw_clip
from renderer.sources import code_version


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
        "crf": round(fineness(spec).quality, 2),
        "max_bytes": max_bytes(spec),
        "missed": missed_bounds(file_bytes, fidelity, limit=max_bytes(spec)),
    }


def _rounded(values: list[float] | None) -> list[float] | None:
    return None if values is None else [round(value, 5) for value in values]
