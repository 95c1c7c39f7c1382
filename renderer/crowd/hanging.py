"""Long hair of the crowd's people: what hangs from the locks over ears and nape to the collar.

It knows no style but what it is given: locks on the scalp (``renderer.crowd.hair``), of which those
beside and behind the face go on. Pure numpy, millimetres.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.body.makehuman import Floats, Indices, base_mesh
from renderer.crowd.scalp import head_triangles, hits

END_MM: Final = 606.0  # on the base mesh, just above the collar
ROWS: Final = 5
_LEANS_IN: Final = 0.16  # mm to the neck per mm down, at the most
_SHOULDERS_MM: Final = 625.0  # on the base mesh: hair falls past what is lower
_INSIDE_TONE: Final = 0.35  # little light comes between hair and neck


@dataclass(frozen=True)
class Curtain:
    """Rows of hair that hang from a row of vertices on the scalp.

    ``points_mm`` (ROWS, k, 3), their ``tone`` (ROWS, k) and unit vectors to the neck. What faces it
    are the same points once more: ``triangles`` number the row that all hangs from 0 .. k - 1, then
    the outer points, then the inner ones.
    """

    points_mm: Floats
    inwards: Floats
    tone: Floats
    triangles: Indices


def curtain(
    start_mm: Floats,
    shape: Floats,
    rng: np.random.Generator,
    *,
    is_ridge: npt.NDArray[np.bool_],
    off_mm: float,
    tips_mm: float,
) -> Curtain:
    """Hang hair from vertices (k, 3) side by side, from one temple round the back to the other.

    ``is_ridge`` (k,) tells locks' ridges from furrows; ``off_mm`` is how far hair stands off what
    it hangs over, ``tips_mm`` how unevenly it ends.
    """
    columns = len(start_mm)
    axis = np.array([0.0, 0.0, float(start_mm[:, 2].mean()) + 12.0])
    around = _spread(start_mm - axis)
    uneven = np.where(is_ridge, -0.7, 0.4) * tips_mm * rng.uniform(-0.4, 1.6, columns)
    end = _end_mm(shape) + uneven
    share = (np.arange(1, ROWS + 1) / ROWS)[:, None]
    height = start_mm[:, 1] + share * (end - start_mm[:, 1])
    reach = _reach(shape, axis, around, height=height)
    off = off_mm + 2.2 * np.where(is_ridge, 1.0, -1.0) * rng.uniform(0.5, 1.3, columns)
    out = np.empty((ROWS, columns))
    last, at = np.linalg.norm((start_mm - axis)[:, [0, 2]], axis=1), start_mm[:, 1]
    for row in range(ROWS):
        last = np.maximum(reach[row] + off, last - _LEANS_IN * (at - height[row]))
        at, out[row] = height[row], last
    points = axis + out[..., None] * around
    points[..., 1] = height
    inwards = -around
    tone = rng.uniform(0.85, 1.2, columns) * np.where(is_ridge, 1.25, 0.7) * np.ones((ROWS, 1))
    return Curtain(points, inwards, tone, _triangles(columns))


def _spread(way: Floats) -> Floats:
    """Return how columns that begin at ways (k, 3) from the axis turn around it: (ROWS, k, 3).

    The lower, the more evenly: hair that crosses on the scalp hangs down side by side.
    """
    turn = np.unwrap(np.arctan2(way[:, 0], -way[:, 2]))
    even = np.linspace(turn[0], turn[-1], len(turn))
    share = 0.7 * (np.arange(1, ROWS + 1) / ROWS)[:, None]
    now = turn + share * (even - turn)
    return np.stack([np.sin(now), np.zeros_like(now), -np.cos(now)], axis=-1)


def _end_mm(shape: Floats) -> float:
    """Return the height of END_MM in a person's build."""
    used = np.unique(head_triangles())
    level = used[np.abs(base_mesh().vertices_mm[used, 1] - END_MM) < 8.0]
    return float(shape[level, 1].mean())


def _reach(shape: Floats, axis: Floats, around: Floats, *, height: Floats) -> Floats:
    """Return how far head, ears and neck stand out (rows, k) from the axis around heights."""
    triangles = head_triangles()
    is_above = base_mesh().vertices_mm[triangles, 1].min(axis=1) > _SHOULDERS_MM
    corners = shape[triangles[is_above]]
    low, high = corners[..., 1].min(axis=1), corners[..., 1].max(axis=1)
    half = np.abs(height[1] - height[0]) / 2
    far = np.zeros((3, *height.shape))
    for (level, row, column), _ in np.ndenumerate(far):
        y = height[row, column] + (level - 1) * half[column]
        near = corners[(low <= y) & (high >= y)]
        origin, ray = np.array([[axis[0], y, axis[2]]]), around[row, column][None]
        way, _ = hits(near[None], origin, ray)
        far[level, row, column] = np.where(np.isfinite(way), way, 0.0).max(initial=0.0)
    widest = far.max(axis=0)
    beside = np.pad(widest, ((0, 0), (1, 1)), mode="edge")
    return np.asarray(np.maximum(widest, np.maximum(beside[:, :-2], beside[:, 2:])))


def _triangles(columns: int) -> Indices:
    """Return the outer sheet from the first row down, and the inner one behind its own rows."""
    row, column = np.divmod(np.arange(ROWS * (columns - 1)), columns - 1)
    a = row * columns + column
    quads = np.stack([a, a + columns, a + columns + 1, a + 1], axis=1)
    outer = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    inner = np.where(outer >= columns, outer + ROWS * columns, outer)[:, ::-1]
    return np.concatenate([outer, inner])


def inside_tone(tone: Floats) -> Floats:
    """Return the tone of what faces the neck."""
    return _INSIDE_TONE * tone


def is_hanging(turn: Floats) -> npt.NDArray[np.bool_]:
    """Whether columns at turns around the crown hang down, or end over the brow."""
    return np.asarray(np.abs(turn) > 0.86)
