"""Draw many soft tubes (fibres, vessels) into a square height map, the higher tube winning.

Knows millimetres and texels, not what the tubes are. The result does not depend on drawing order,
because each texel keeps a maximum.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import ndimage

Field = npt.NDArray[np.float32]

_HEIGHT_STEPS = float(2**20 - 1)
_TONE_STEPS = float(2**12 - 1)


@dataclass(frozen=True)
class Tubes:
    """Points along tubes, one after the other; every array has the shape (n_points,).

    ``x_mm, y_mm`` centre; ``half_width_mm``; ``crest`` height of the tube's top in [0, 1];
    ``drop`` the share of the crest by which the height has fallen at the tube's edge;
    ``tone`` in [0, 1] a value carried along; ``tube`` the tube's number, non-decreasing.
    """

    x_mm: Field
    y_mm: Field
    half_width_mm: Field
    crest: Field
    drop: Field
    tone: Field
    tube: npt.NDArray[np.int64]


def join_tubes(parts: list[Tubes]) -> Tubes:
    """Put several sets of tubes into one, numbering the tubes anew."""
    offset = 0
    numbers = []
    for part in parts:
        numbers.append(part.tube + offset)
        offset += int(part.tube[-1]) + 1 if part.tube.size else 0
    names = ("x_mm", "y_mm", "half_width_mm", "crest", "drop", "tone")
    values = {name: np.concatenate([getattr(part, name) for part in parts]) for name in names}
    return Tubes(**values, tube=np.concatenate(numbers))


def _normals(tubes: Tubes) -> tuple[Field, Field]:
    """Return the unit normals in the plane, from differences that stay within one tube."""
    ahead = np.minimum(np.arange(tubes.tube.size) + 1, tubes.tube.size - 1)
    behind = np.maximum(np.arange(tubes.tube.size) - 1, 0)
    ahead = np.where(tubes.tube[ahead] == tubes.tube, ahead, np.arange(tubes.tube.size))
    behind = np.where(tubes.tube[behind] == tubes.tube, behind, np.arange(tubes.tube.size))
    dx = tubes.x_mm[ahead] - tubes.x_mm[behind]
    dy = tubes.y_mm[ahead] - tubes.y_mm[behind]
    length = np.maximum(np.sqrt(dx * dx + dy * dy), np.float32(1e-9))
    return -dy / length, dx / length


def draw_tubes(tubes: Tubes, size_px: int, *, half_size_mm: float) -> tuple[Field, Field]:
    """Return the height of the highest tube over each texel and that tube's tone, 0 where none.

    The square spans ``-half_size_mm`` to ``half_size_mm`` in x (columns) and y (rows, upwards).
    Points must lie closer than about a texel along each tube. The distance to the tube is taken at
    the texel's centre, so edges are smooth although each sample touches one texel.
    """
    texel_mm = 2.0 * half_size_mm / size_px
    normal_x, normal_y = _normals(tubes)
    centre_x = (tubes.x_mm + np.float32(half_size_mm)) / np.float32(texel_mm)
    centre_y = (tubes.y_mm + np.float32(half_size_mm)) / np.float32(texel_mm)
    # A tube thinner than a texel is widened to one: it must not break into dots.
    half = np.maximum(tubes.half_width_mm / np.float32(texel_mm), np.float32(0.75))
    canvas = np.zeros((size_px, size_px), np.uint32)
    frame = np.stack([centre_x, centre_y, normal_x, normal_y, half])
    step = 0.5
    reach = int(np.ceil(float(half.max(initial=0.0)) / step))
    for k in range(-reach, reach + 1):
        near = np.flatnonzero(half + np.float32(0.5) > abs(k) * step)
        _stamp(canvas, tubes, near, frame=frame[:, near], offset=k * step)
    height = (canvas >> np.uint32(12)).astype(np.float32) / np.float32(_HEIGHT_STEPS)
    tone = (canvas & np.uint32(0xFFF)).astype(np.float32) / np.float32(_TONE_STEPS)
    # Where tubes cross, the winner changes from texel to texel: a blur below a texel's width
    # takes the stairs away.
    return _soften(height), _soften(tone)


def _soften(field: Field) -> Field:
    softened: Field = ndimage.gaussian_filter(field, 0.7, mode="nearest", truncate=3.0)
    return softened


def _stamp(
    canvas: npt.NDArray[np.uint32],
    tubes: Tubes,
    near: npt.NDArray[np.intp],
    *,
    frame: Field,
    offset: float,
) -> None:
    """Put the texel at ``offset`` across each of the points ``near`` onto the canvas."""
    x, y, nx, ny, half = frame
    size_px = canvas.shape[0]
    column = np.floor(x + nx * np.float32(offset))
    row = np.floor(y + ny * np.float32(offset))
    across = ((column + np.float32(0.5) - x) * nx + (row + np.float32(0.5) - y) * ny) / half
    inside = (
        (np.abs(across) < 1.0) & (column >= 0) & (row >= 0) & (column < size_px) & (row < size_px)
    )
    near, across = near[inside], across[inside]
    index = row[inside].astype(np.int64) * size_px + column[inside].astype(np.int64)
    # A round back whose edge meets what lies below, without the vertical side of a half circle.
    square = across * across
    fall = np.float32(0.5) * square + np.float32(0.5) * square * square * square
    height = np.clip(tubes.crest[near] * (np.float32(1.0) - tubes.drop[near] * fall), 0.0, 1.0)
    packed = (height * np.float32(_HEIGHT_STEPS)).astype(np.uint32) << np.uint32(12)
    packed |= (np.clip(tubes.tone[near], 0.0, 1.0) * np.float32(_TONE_STEPS)).astype(np.uint32)
    np.maximum.at(canvas.reshape(-1), index, packed)
