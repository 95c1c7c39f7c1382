"""Triangles in cells that a view may skip: what lies outside it, what looks away. Pure numpy."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.body.makehuman import Floats, Indices
from renderer.gl.index_ranges import adjoined

CELL_MM: Final = 12.0


@dataclass(frozen=True)
class Cells:
    """Runs of triangles: ``first`` and ``count`` in indices, bounding spheres in mm.

    ``facing`` (n, 3) is the mean normal, ``spread`` (n,) the sine of the largest angle from it.
    """

    first: Indices
    count: Indices
    centre_mm: Floats
    radius_mm: Floats
    facing: Floats
    spread: Floats

    @cached_property
    def whole(self) -> list[tuple[int, int]]:
        """The runs (first, count) of all cells: one, as ``sort_into_cells`` leaves them."""
        return adjoined(zip(self.first.tolist(), self.count.tolist(), strict=True))

    def visible(
        self, clip: npt.ArrayLike, camera_mm: Floats | None = None
    ) -> list[tuple[int, int]]:
        """Return the runs (first, count) that a view can show, neighbours merged.

        ``clip`` (4, 4) is world to clip.
        Cells outside the frustum are left out; with a camera, so are those that face away.
        """
        clip = np.asarray(clip, dtype=float)
        inside = (frustum_distance(clip, self.centre_mm) > -self.radius_mm[:, None]).all(axis=1)
        if camera_mm is not None:
            to_camera = camera_mm - self.centre_mm
            distance = np.linalg.norm(to_camera, axis=1)
            slack = self.spread + self.radius_mm / np.maximum(distance, self.radius_mm)
            inside &= (to_camera * self.facing).sum(axis=1) > -slack * distance
        return adjoined(zip(self.first[inside].tolist(), self.count[inside].tolist(), strict=True))


def frustum_distance(clip: Floats, points_mm: Floats) -> Floats:
    """Return signed distances (n, 6) in mm of points from a frustum's planes, positive inside."""
    planes = np.concatenate([clip[3] + clip[:3], clip[3] - clip[:3]]).reshape(6, 4)
    planes /= np.sqrt((planes[:, :3] ** 2).sum(axis=1, keepdims=True))
    return np.asarray(points_mm @ planes[:, :3].T + planes[:, 3])


def sort_into_cells(points: Floats, triangles: Indices) -> tuple[Indices, Cells]:
    """Return the triangles ordered by cubes of CELL_MM, and the cubes' runs."""
    centres = points[triangles].mean(axis=1)
    _, cell = np.unique(np.floor(centres / CELL_MM).astype(int), axis=0, return_inverse=True)
    order = np.argsort(cell.ravel(), kind="stable")
    ordered, cell = triangles[order], cell.ravel()[order]
    starts = np.flatnonzero(np.diff(cell, prepend=-1))
    counts = np.diff(np.append(starts, len(ordered)))
    faces = np.cross(
        points[ordered[:, 1]] - points[ordered[:, 0]], points[ordered[:, 2]] - points[ordered[:, 0]]
    )
    faces /= np.maximum(np.linalg.norm(faces, axis=1, keepdims=True), 1e-12)
    middles, radii, facing, spread = [], [], [], []
    for start, count in zip(starts, counts, strict=True):
        corners = points[ordered[start : start + count].ravel()]
        middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
        middles.append(middle)
        radii.append(np.linalg.norm(corners - middle, axis=1).max())
        mean = faces[start : start + count].mean(axis=0)
        mean /= max(float(np.linalg.norm(mean)), 1e-9)
        cosine = float((faces[start : start + count] @ mean).min())
        facing.append(mean)
        spread.append(np.sqrt(1 - min(cosine, 1.0) ** 2) if cosine > 0 else 2.0)
    spheres = (np.array(middles), np.array(radii), np.array(facing), np.array(spread))
    return ordered, Cells(starts * 3, counts * 3, *spheres)
