"""Which tiles of a cube's faces bodies may touch, and rectangles that cover tiles. Pure numpy.

Numpy's calls cost more than their arithmetic here, so all faces are taken together.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.park.cube_faces import FACE_AXES
from renderer.park.cube_target import Rectangle

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]

TILES: Final = 16  # a face is cleared and halved in tiles, 16 x 16 of them
_ROWS: Final = np.concatenate([axes.T for axes in FACE_AXES])  # right, down, forward of each face
_BALL: Final = np.eye(3)
_BITS: Final = 1 << np.arange(TILES)


@dataclass(frozen=True)
class Touched:
    """What bodies may touch: ``tiles`` (6, row, column) and which ``bodies`` (6, n) do so."""

    tiles: Bools
    bodies: Bools


def touched(points: Floats, reach_mm: Floats, *, near_mm: float, shape: Floats = _BALL) -> Touched:
    """Return what spheres around points (n, 3) touch of the faces, beyond their near planes.

    ``shape`` (3, 3) makes other bodies of spheres: it carries what lies around a point.
    """
    right, down, forward = (_ROWS @ points.T).reshape(6, 3, len(points)).swapaxes(0, 1)
    rights, downs, forwards = (_ROWS @ shape).reshape(6, 3, 3).swapaxes(0, 1)
    inside = forward > near_mm - _reaches(forwards, reach_mm)
    # A body touches a face's pyramid only if it reaches over all four of its side planes.
    for across, axes in ((right, rights), (down, downs)):
        inside &= forward - across > -_reaches(forwards - axes, reach_mm)
        inside &= forward + across > -_reaches(forwards + axes, reach_mm)
    face, body = np.nonzero(inside)
    reach = _reaches(np.stack([rights, downs, forwards]), reach_mm)[:, face, body]
    low, high = _extent(np.stack([right, down, forward])[:, face, body], reach, near_mm=near_mm)
    is_on_it = (low < high).all(axis=0)
    face, low, high = face[is_on_it], low[:, is_on_it], high[:, is_on_it]
    found = np.zeros_like(inside)
    found[face, body[is_on_it]] = True
    return Touched(_filled(face, low, high), found)


def _reaches(axes: Floats, reach_mm: Floats) -> Floats:
    """Return how far bodies (n,) reach along axes (..., 3) that their shape has carried."""
    return np.asarray(np.sqrt((axes**2).sum(axis=-1))[..., None] * reach_mm)


def _extent(centre: Floats, reach: Floats, *, near_mm: float) -> tuple[Indices, Indices]:
    """Return the first tiles (2, m) along a face's axes that boxes (3, m) touch, those after."""
    near, far = np.maximum(centre[2] - reach[2], near_mm), np.maximum(centre[2] + reach[2], near_mm)
    start, end = centre[:2] - reach[:2], centre[:2] + reach[:2]
    low = np.minimum(start / near, start / far).clip(-1, 1) * 0.5 + 0.5
    high = np.maximum(end / near, end / far).clip(-1, 1) * 0.5 + 0.5
    return np.floor(low * TILES).astype(int), np.ceil(high * TILES).astype(int)


def _filled(face: Indices, low: Indices, high: Indices) -> Bools:
    """Return which tiles lie in rectangles from ``low`` to before ``high`` (x and y, m)."""
    # Rectangles are summed up from their corners: steps in at one end, out at the other.
    corners = [(y, x) for y in (low[1], high[1]) for x in (low[0], high[0])]
    stride = TILES + 1
    places = np.concatenate([(face * stride + y) * stride + x for y, x in corners])
    steps = np.repeat([1.0, -1.0, -1.0, 1.0], len(face))
    summed = np.bincount(places, steps, 6 * stride * stride).reshape(6, stride, stride)
    return np.asarray(summed.cumsum(axis=1).cumsum(axis=2)[:, :TILES, :TILES] > 0.5)


def cover(tiles: Bools) -> list[Rectangle]:
    """Return disjoint rectangles (x, y, width, height) that cover the true tiles of a face."""
    rows: list[int] = (tiles @ _BITS).tolist()  # a row is a number, a tile a bit of it
    found: list[Rectangle] = []
    for y in range(len(rows)):
        while left := rows[y]:
            x = (left & -left).bit_length() - 1
            run = left >> x
            width = (~run & (run + 1)).bit_length() - 1
            bits = ((1 << width) - 1) << x
            end = y
            while end < len(rows) and rows[end] & bits == bits:
                rows[end] &= ~bits
                end += 1
            found.append((x, y, width, end - y))
    return found
