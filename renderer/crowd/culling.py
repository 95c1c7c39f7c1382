"""Which figures a view may show: spheres against the view's pyramid. Pure numpy."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def in_view(
    centres_mm: Floats, reach_mm: Floats, *, world_to_clip: npt.NDArray[np.floating]
) -> npt.NDArray[np.bool_]:
    """Return (k,) whether spheres around centres (k, 3) reach into what a view shows.

    Never False for a sphere that does: only spheres wholly beyond a side, or behind, are left out.
    """
    matrix = np.asarray(world_to_clip, dtype=float)
    planes = [matrix[3] + sign * matrix[axis] for axis in (0, 1) for sign in (1.0, -1.0)]
    planes.append(matrix[3])  # in front of the camera
    sides = np.array(planes)
    sides /= np.linalg.norm(sides[:, :3], axis=1, keepdims=True)
    inwards = centres_mm @ sides[:, :3].T + sides[:, 3]
    return np.asarray((inwards > -reach_mm[:, None]).all(axis=1))
