"""Triangles without colour, drawn only where a picture may have edges."""

from __future__ import annotations

from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.frame.edge_tiles import EdgeTiles
from renderer.gl.program import Program

GROUP: Final = 8  # neighbouring triangles that are drawn or left out together
GRID: Final = 1024  # of the curve along which triangles are neighbours

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.integer[Any]]


class BareMesh:
    """A mesh for programs that read ``in_position`` alone."""

    def __init__(
        self, gl: moderngl.Context, program: Program, points: Floats, triangles: Indices
    ) -> None:
        """``points`` (n, 3) are in the space that the program starts from."""
        ordered = triangles[np.argsort(along_curve(points[triangles].mean(axis=1)), kind="stable")]
        # The last triangle again and again, until the last group is full.
        ordered = np.concatenate([ordered, np.repeat(ordered[-1:], -len(ordered) % GROUP, axis=0)])
        self._spheres = _spheres(points[ordered].reshape(-1, 3 * GROUP, 3))
        self._each = [
            part.reshape(-1, GROUP, *part.shape[1:]) for part in _spheres(points[ordered])
        ]
        used, numbers = np.unique(ordered, return_inverse=True)
        self._triangles = numbers.reshape(-1, GROUP, 3).astype(np.int32)
        self._index = gl.buffer(self._triangles.tobytes(), dynamic=True)
        vertices = gl.buffer(points[used].astype(np.float32).tobytes())
        self._array = gl.vertex_array(
            program.gl_program, [(vertices, "3f", "in_position")], self._index
        )

    def draw(self, to_clip: npt.ArrayLike, tiles: EdgeTiles) -> None:
        """Draw what may cover ``tiles`` with the program as it is set.

        ``to_clip`` (4, 4) is what the program does to points.
        """
        if tiles.mask is None:
            self._array.render(moderngl.TRIANGLES)
            return
        matrix = np.asarray(to_clip, dtype=float)
        groups = tiles.touched(matrix, *self._spheres)
        if not groups.any():
            return
        centres, radii = (part[groups] for part in self._each)
        single = tiles.touched(matrix, centres.reshape(-1, 3), radii.ravel())
        touched = self._triangles[groups].reshape(-1, 3)[single]
        self._index.write(touched.tobytes())
        self._array.render(moderngl.TRIANGLES, vertices=touched.size)


def _spheres(corners: Floats) -> tuple[Floats, Floats]:
    """Return centres (n, 3) and radii (n,) of spheres around each of n sets of points (n, k, 3)."""
    centres = (corners.min(axis=1) + corners.max(axis=1)) / 2
    return centres, np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)


def along_curve(points: Floats) -> Indices:
    """Return the place (n,) of points (n, 3) along Morton's curve through the box around them."""
    low = points.min(axis=0)
    scale = (GRID - 1) / max(float(np.ptp(points, axis=0).max()), 1e-9)
    cells = ((points - low) * scale).astype(np.int64)
    place = np.zeros(len(points), dtype=np.int64)
    for bit in range(GRID.bit_length() - 1):
        for axis in range(3):
            place |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return place
