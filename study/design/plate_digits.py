"""The digits on colour-vision plates: strokes of our own, wide enough to be read in dots.

No 0 and no 1: a ring and a bar are seen in many things. Coordinates run from -1 to 1, y down.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import numpy as np
import numpy.typing as npt

Points = npt.NDArray[np.float64]

STROKE: Final = 0.17  # half the width of a stroke
WIDTH: Final = 0.42
HEIGHT: Final = 0.62


def _arc(
    centre: tuple[float, float], radii: tuple[float, float], turn: tuple[float, float]
) -> Points:
    """Return points along an ellipse from one angle to another, in degrees, 0 right, 90 down."""
    angles = np.radians(np.linspace(*turn, 25))
    return np.column_stack(
        [centre[0] + radii[0] * np.cos(angles), centre[1] + radii[1] * np.sin(angles)]
    )


def _line(*points: tuple[float, float]) -> Points:
    return np.array(points, dtype=float)


_UPPER: Final = (0.0, -HEIGHT / 2)
_LOWER: Final = (0.0, HEIGHT / 2)
_HALF: Final = (WIDTH, HEIGHT / 2)
STROKES: Final[dict[int, tuple[Points, ...]]] = {
    2: (
        _arc(_UPPER, _HALF, (-170, 40)),
        _line((0.33, -0.11), (-WIDTH, HEIGHT), (WIDTH + 0.02, HEIGHT)),
    ),
    3: (_arc(_UPPER, _HALF, (-150, 90)), _arc(_LOWER, _HALF, (-90, 150))),
    4: (_line((0.18, HEIGHT), (0.18, -HEIGHT), (-0.46, 0.24), (0.46, 0.24)),),
    5: (
        _line((WIDTH, -HEIGHT), (-0.34, -HEIGHT), (-0.38, -0.08)),
        _arc((-0.02, 0.24), (WIDTH, 0.40), (-150, 140)),
    ),
    6: (_arc((0.0, 0.22), (WIDTH, 0.40), (0, 360)), _arc((0.16, 0.2), (0.58, 0.84), (180, 262))),
    7: (_line((-WIDTH, -HEIGHT), (WIDTH, -HEIGHT), (-0.12, HEIGHT)),),
    8: (_arc(_UPPER, (0.36, HEIGHT / 2), (0, 360)), _arc(_LOWER, (WIDTH, HEIGHT / 2), (0, 360))),
    9: (_arc((0.0, -0.22), (WIDTH, 0.40), (0, 360)), _arc((-0.16, -0.2), (0.58, 0.84), (0, 82))),
}
DIGITS: Final = tuple(STROKES)


def is_on_digit(digit: int, points: Points) -> npt.NDArray[np.bool_]:
    """Say of each point, (n, 2), whether it lies on the digit's strokes."""
    distances = [_distance_to(stroke, points) for stroke in STROKES[digit]]
    return np.asarray(np.min(distances, axis=0) <= STROKE)


def _distance_to(stroke: Points, points: Points) -> npt.NDArray[np.float64]:
    """Return each point's distance to a polyline."""
    nearest = np.full(len(points), np.inf)
    for start, end in pairwise(stroke):
        along = end - start
        share = np.clip((points - start) @ along / (along @ along), 0.0, 1.0)
        gap = np.linalg.norm(points - (start + share[:, None] * along), axis=1)
        nearest = np.minimum(nearest, gap)
    return nearest
