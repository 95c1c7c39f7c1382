"""Unit vectors, and the normals of meshes of triangles. Pure numpy."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.body.makehuman import Floats

_SHORTEST: Final = 1e-12  # what is shorter stays nearly nothing instead of becoming nan


def unit(vectors: Floats) -> Floats:
    """Return vectors (..., k) scaled to length 1."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.maximum(lengths, _SHORTEST))


def vertex_normals(points: Floats, triangles: npt.NDArray[np.integer]) -> Floats:
    """Return the area-weighted unit normals (n, 3) of points (n, 3) from triangles (m, 3)."""
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    facets = np.cross(b - a, c - a)
    axes = [
        np.bincount(triangles.ravel(), np.repeat(facets[:, k], 3), minlength=len(points))
        for k in range(3)
    ]
    return unit(np.stack(axes, axis=1))
