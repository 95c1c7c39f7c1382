"""One clip's frames: drawn, and encoded, hashed and sampled beside the drawing.

Knows no folder of clips and no manifest, and of GL only what draws for it.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final, Protocol

from renderer.clip import ClipSpec
from renderer.encoding.bounds import fineness, max_rate
from renderer.encoding.comparison import Comparison
from renderer.encoding.encode import open_encoder
from renderer.encoding.eye_boxes import eye_boxes
from renderer.production.beside import Beside

if TYPE_CHECKING:
    from renderer.frame.frame import Frame

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
    fine = fineness(spec)
    frames = source.frames(spec)
    with (
        open_encoder(
            drawn.path,
            fps=spec.fps,
            size=(spec.width, spec.height),
            stretches=eye_boxes(spec, eye_steps=fine.eye_steps, lid_steps=fine.lid_steps),
            quality=fine.quality,
            matrices=fine.matrices,
            rate=max_rate(spec),
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
