"""Look up radiance in cube faces without GL: what the anterior chamber gathers light from."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from renderer.park.cube_faces import FACE_AXES

Array = npt.NDArray[np.float64]

_BACK = np.stack([axes.T for axes in FACE_AXES])  # (6, 3, 3): world to right, down, forward


def look_up(faces: npt.NDArray[np.floating], directions: Array) -> Array:
    """Return the faces' (6, n, n, 3) radiance towards directions (m, 3), bilinear within a face."""
    size = faces.shape[1]
    major = np.argmax(np.abs(directions), axis=1)
    face = 2 * major + (np.take_along_axis(directions, major[:, None], axis=1)[:, 0] < 0.0)
    s, t, forward = np.einsum("mij,mj->im", _BACK[face], directions)
    texel = np.clip(np.stack([s, t]) / forward * 0.5 + 0.5, 0.0, 1.0) * size - 0.5
    texel = np.clip(texel, 0.0, size - 1.0)
    base = np.minimum(texel.astype(np.intp), max(size - 2, 0))
    share = (texel - base)[..., None]
    column, row = base
    right, below = np.minimum(column + 1, size - 1), np.minimum(row + 1, size - 1)
    upper = (1 - share[0]) * faces[face, row, column] + share[0] * faces[face, row, right]
    lower = (1 - share[0]) * faces[face, below, column] + share[0] * faces[face, below, right]
    return np.asarray((1 - share[1]) * upper + share[1] * lower, dtype=np.float64)


def halve(faces: npt.NDArray[np.floating], size: int) -> npt.NDArray[np.float64]:
    """Return faces (6, n, n, 3) shrunk to ``size`` texels a side, which divides n."""
    step = faces.shape[1] // size
    tiles = np.asarray(faces, np.float64).reshape(6, size, step, size, step, 3)
    return np.asarray(tiles.mean(axis=(2, 4)))
