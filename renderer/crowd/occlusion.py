"""How much light reaches each vertex of a figure past the figure itself. Pure numpy.

For each direction of light the surface is splatted into a coarse depth grid: right to about the
grid's cell, which is enough for vertex values.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

_CELL_MM: Final = 14.0
_BIAS_MM: Final = 32.0  # nearer than this, a surface does not shade itself


def visibility(positions_mm: Floats, triangles: Indices, *, directions: Floats) -> Floats:
    """Return (n, d): 1 where a vertex sees out along a unit direction towards the light, else 0."""
    points = _surface_points(positions_mm, triangles)
    seen = np.empty((len(positions_mm), len(directions)))
    for column, direction in enumerate(directions):
        helper = np.eye(3)[int(np.argmin(np.abs(direction)))]
        across = np.cross(direction, helper)
        across /= np.linalg.norm(across)
        frame = np.stack([across, np.cross(direction, across)], axis=1) / _CELL_MM
        low = np.floor((points @ frame).min(axis=0)) - 1
        cells = np.floor(points @ frame - low).astype(np.int64)
        width = int(cells[:, 1].max()) + 2
        nearest = np.full((int(cells[:, 0].max()) + 2) * width, -np.inf)
        np.maximum.at(nearest, cells[:, 0] * width + cells[:, 1], points @ direction)
        own = np.floor(positions_mm @ frame - low).astype(np.int64)
        depth = positions_mm @ direction
        seen[:, column] = depth > nearest[own[:, 0] * width + own[:, 1]] - _BIAS_MM
    return seen


def openness(positions_mm: Floats, normals: Floats, *, triangles: Indices, count: int) -> Floats:
    """Return each vertex's cosine-weighted share (n,) of open directions, of ``count`` in all."""
    directions = sphere_directions(count)
    cosine = np.clip(normals @ directions.T, 0.0, None)
    seen = visibility(positions_mm, triangles, directions=directions)
    return np.asarray((cosine * seen).sum(axis=1) / np.maximum(cosine.sum(axis=1), 1e-9))


def sphere_directions(count: int) -> Floats:
    """Return unit directions (count, 3) spread evenly over the sphere on a spiral."""
    y = 1 - (np.arange(count) + 0.5) * 2 / count
    turn = np.arange(count) * 2.39996323  # the golden angle
    ring = np.sqrt(1 - y * y)
    return np.stack([ring * np.cos(turn), y, ring * np.sin(turn)], axis=1)


def cone_directions(axis: Floats, *, angle_rad: float) -> Floats:
    """Return a direction and six around it: a small, soft source of light."""
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    across = np.cross(axis, helper)
    across /= np.linalg.norm(across)
    other = np.cross(axis, across)
    turn = np.arange(6) * np.pi / 3
    around = axis + np.tan(angle_rad) * (
        np.cos(turn)[:, None] * across + np.sin(turn)[:, None] * other
    )
    found = np.concatenate([axis[None], around])
    return np.asarray(found / np.linalg.norm(found, axis=1, keepdims=True))


def _surface_points(positions: Floats, triangles: Indices) -> Floats:
    """Return points spread over the triangles closely enough for the grid's cells."""
    shares = np.array([[a / 3, b / 3, 1 - (a + b) / 3] for a in range(4) for b in range(4 - a)])
    corners = positions[triangles]
    return np.asarray(np.einsum("sk,tkc->tsc", shares, corners).reshape(-1, 3))
