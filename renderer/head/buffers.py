"""The head's meshes on the GPU: one vertex buffer, index ranges in cells that a view may skip."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.body.makehuman import Floats, Indices
from renderer.camera import Matrix
from renderer.program import Program

CELL_MM: Final = 12.0
STATIC: Final = ("3f 3f 3f 4f 1f", ["in_position", "in_normal", "in_albedo", "in_detail", "in_lid"])
LIT: Final = ("3f 4f", ["in_diffuse", "in_surface"])


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

    def visible(self, clip: Floats, camera_mm: Floats | None = None) -> list[tuple[int, int]]:
        """Return the runs (first, count) that a view can show, neighbours merged.

        Cells outside the frustum are left out; with a camera, so are those that face away.
        """
        inside = (frustum_distance(clip, self.centre_mm) > -self.radius_mm[:, None]).all(axis=1)
        if camera_mm is not None:
            to_camera = camera_mm - self.centre_mm
            distance = np.linalg.norm(to_camera, axis=1)
            slack = self.spread + self.radius_mm / np.maximum(distance, self.radius_mm)
            inside &= (to_camera * self.facing).sum(axis=1) > -slack * distance
        runs: list[tuple[int, int]] = []
        for first, count in zip(self.first[inside], self.count[inside], strict=True):
            if runs and sum(runs[-1]) == first:
                runs[-1] = (runs[-1][0], runs[-1][1] + int(count))
            else:
                runs.append((int(first), int(count)))
        return runs


def frustum_distance(clip: Floats, points_mm: Floats) -> Floats:
    """Return signed distances (n, 6) in mm of points from a frustum's planes, positive inside."""
    planes = np.concatenate([clip[3] + clip[:3], clip[3] - clip[:3]]).reshape(6, 4)
    planes = planes / np.linalg.norm(planes[:, :3], axis=1, keepdims=True)
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


class CellMesh:
    """Triangles drawn cell by cell. Its vertices lie in the order of their use.

    Software renderers shade long runs of neighbouring vertices several times faster.
    """

    def __init__(
        self, gl: moderngl.Context, rows: Floats, triangles: Indices, *, turn: int | None = None
    ) -> None:
        """``rows`` (n, 14) are what STATIC names, of all the vertices that ``triangles`` count.

        ``turn`` numbers a column that runs once around from 0 to 1, if there is one.
        """
        source = np.arange(len(rows))
        if turn is not None:
            source, triangles = unroll(rows[:, turn], triangles)
            on = np.arange(len(source)) >= len(rows)
            rows = rows[source]
            rows[on, turn] += 1.0
        ordered, self.cells = sort_into_cells(rows[:, :3], triangles)
        used, numbers = _by_first_use(ordered)
        self._used = source[used]
        self._gl = gl
        self._index = gl.buffer(numbers.astype(np.int32).tobytes())
        self._static = gl.buffer(rows[used].astype(np.float32).tobytes())
        self._light = gl.buffer(reserve=len(self._used) * 7 * 4)
        self._arrays: dict[int, moderngl.VertexArray] = {}

    def write_light(self, rows: Floats) -> None:
        """Replace the baked light: rows (n, 7) are what LIT names, for the same n vertices."""
        self._light.write(rows[self._used].astype(np.float32).tobytes())

    def draw(
        self, program: Program, clip: Matrix | Floats, *, camera_mm: Floats | None = None
    ) -> None:
        """Draw the cells that a world-to-clip matrix can show, with a camera only its fronts."""
        array = self._array(program)
        for first, count in self.cells.visible(np.asarray(clip, dtype=float), camera_mm):
            array.render(vertices=count, first=first)

    def _array(self, program: Program) -> moderngl.VertexArray:
        key = program.gl_program.glo
        if key not in self._arrays:
            content = [
                (buffer, *_used(program, layout, names))
                for buffer, (layout, names) in ((self._static, STATIC), (self._light, LIT))
            ]
            self._arrays[key] = self._gl.vertex_array(
                program.gl_program, [entry for entry in content if len(entry) > 2], self._index
            )
        return self._arrays[key]


def unroll(turn: Floats, triangles: Indices) -> tuple[Indices, Indices]:
    """Give triangles across the seam of a coordinate (n,) from 0 to 1 vertices of their own.

    Return the original of every vertex, the new ones last, and the triangles renumbered. The new
    ones have turned once more.
    """
    crosses = np.ptp(turn[triangles], axis=1) > 0.5
    early = crosses[:, None] & (turn[triangles] < 0.5)
    again = np.unique(triangles[early])
    number = np.zeros(len(turn), dtype=np.int64)
    number[again] = len(turn) + np.arange(len(again))
    renumbered = np.where(early, number[triangles], triangles)
    return np.concatenate([np.arange(len(turn)), again]), np.asarray(renumbered)


def _by_first_use(triangles: Indices) -> tuple[Indices, Indices]:
    """Return the vertices in the order of their first use, and the triangles renumbered."""
    flat = triangles.ravel()
    used, first, inverse = np.unique(flat, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return used[order], rank[inverse.ravel()]


def _used(program: Program, layout: str, names: list[str]) -> tuple[str, ...]:
    """Replace attributes that a program does not read by padding."""
    parts = [
        part if name in program.gl_program else f"{int(part[:-1]) * 4}x"
        for part, name in zip(layout.split(), names, strict=True)
    ]
    active = [name for name in names if name in program.gl_program]
    return (" ".join(parts), *active)


class TilePyramid:
    """A repeating tile at full, half, quarter ... size, each level a texture of its own.

    One level serves a whole view, so the shader needs neither mip selection nor its cost.
    """

    def __init__(self, gl: moderngl.Context, pixels: npt.NDArray[np.generic]) -> None:
        """Halve (height, width, 4) uint8 pixels until an edge is 1; both are powers of two."""
        self._levels = []
        self._variances = []
        level = np.asarray(pixels, dtype=float)
        while True:
            data = np.round(level).astype(np.uint8)
            texture = gl.texture(data.shape[1::-1], 4, data.tobytes())
            texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
            self._levels.append(texture)
            self._variances.append(float(level[..., :2].var(axis=(0, 1)).sum()) / 255**2)
            if min(level.shape[:2]) == 1:
                return
            level = level.reshape(len(level) // 2, 2, -1, 2, 4).mean(axis=(1, 3))

    def at(self, texels_per_pixel: float) -> moderngl.Texture:
        """Return the level whose texels come nearest to a pixel's size."""
        return self._levels[self._level(texels_per_pixel)]

    def lost_variance(self, texels_per_pixel: float) -> float:
        """Return what that level has lost of the variance of red and green, which run 0 to 1.

        Slopes that a level can no longer show roughen its highlights instead (Toksvig 2005; Olano
        and Baker 2010, "LEAN mapping").
        """
        return self._variances[0] - self._variances[self._level(texels_per_pixel)]

    def _level(self, texels_per_pixel: float) -> int:
        wanted = round(math.log2(max(texels_per_pixel, 1.0)))
        return min(wanted, len(self._levels) - 1)
