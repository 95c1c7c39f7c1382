"""Where the encoder spends its bits: boxes that cover what is seen of the eyes in all frames."""

from __future__ import annotations

from typing import Final

from renderer.clip import ClipSpec
from renderer.encoding.encode import Box
from renderer.encoding.fidelity import Rectangle, eye_rectangles

# The lids' opening as columns: from and to in shares of the rectangle's width, and how much of its
# height. An almond and a margin of a macroblock (16 pixels) or so; lids and lashes get no more.
_ALMOND: Final = (
    (0.06, 0.2, 0.5),
    (0.2, 0.33, 0.8),
    (0.33, 0.67, 1.0),
    (0.67, 0.8, 0.8),
    (0.8, 0.94, 0.5),
)


def frame_rectangles(spec: ClipSpec, number: int) -> tuple[Rectangle, Rectangle]:
    """Return the rectangles of both eyes in one frame of a clip as (rows, columns)."""
    return eye_rectangles(spec, spec.azimuth_deg(number), distance_px=spec.distance_px(number))


def eye_boxes(spec: ClipSpec) -> list[Box]:
    """Return boxes over both eyes; the encoder cannot move them, so they hold for every frame."""
    every = [frame_rectangles(spec, number) for number in range(spec.frame_count)]
    return [box for eye in (0, 1) for box in _almond([pair[eye] for pair in every])]


def _almond(rectangles: list[Rectangle]) -> list[Box]:
    top = min(rows.start for rows, _ in rectangles)
    left = min(columns.start for _, columns in rectangles)
    height = max(rows.stop for rows, _ in rectangles) - top
    width = max(columns.stop for _, columns in rectangles) - left
    boxes = []
    for start, stop, share in _ALMOND:
        x, tall = left + round(start * width), max(1, round(height * share))
        wide = max(1, left + round(stop * width) - x)
        boxes.append(Box(x, top + (height - tall) // 2, wide, tall))
    return boxes
