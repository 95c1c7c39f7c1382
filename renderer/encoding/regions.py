"""Parts of the picture that are encoded finer than the rest, as FFmpeg is told of them.

FFmpeg's ``addroi`` cannot move a box, so a clip is cut into stretches that have their own boxes and
are joined again before they are encoded as one. Frames pass through one by one; none is kept back.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

_STEPS: Final = 51  # addroi's offset is a share of H.264's range of quantisers


class Box(NamedTuple):
    """A rectangle in pixels from the picture's upper left corner, and its finer quantiser steps."""

    x: int
    y: int
    width: int
    height: int
    steps: float


class Stretch(NamedTuple):
    """Boxes from one frame of a clip (0-based) to the next stretch; of two that overlap, the first
    holds.
    """

    first: int
    boxes: Sequence[Box]


def filter_graph(before: str, stretches: Sequence[Stretch], *, fps: int, out: str) -> str:
    """Return FFmpeg's filter graph: the filters ``before``, then every stretch with its boxes.

    ``out`` names what comes out of it. The first stretch begins with the first frame.
    """
    if not stretches:
        return f"{before}[{out}]"
    count = len(stretches)
    ends = [f":end_frame={stretch.first}" for stretch in stretches[1:]]
    chains = [
        f"[i{k}]" + ",".join([f"trim=start_frame={stretch.first}{end}", _FROM_0, *_rois(stretch)])
        for k, (stretch, end) in enumerate(zip(stretches, [*ends, ""], strict=True))
    ]
    # A stretch of one frame has no duration when it is joined: every frame gets its time again.
    return ";".join(
        [
            f"{before},split={count}" + "".join(f"[i{k}]" for k in range(count)),
            *(f"{chain}[o{k}]" for k, chain in enumerate(chains)),
            "".join(f"[o{k}]" for k in range(count)) + f"concat=n={count},setpts=N/{fps}/TB[{out}]",
        ]
    )


_FROM_0: Final = "setpts=PTS-STARTPTS"


def _rois(stretch: Stretch) -> list[str]:
    return [
        f"addroi=x={b.x}:y={b.y}:w={b.width}:h={b.height}:qoffset={-b.steps / _STEPS:.4f}"
        for b in stretch.boxes
    ]
