"""The head's meshes and tiles on the GPU: vertices in one buffer, triangles in cells."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.body.makehuman import Floats, Indices
from renderer.gl.context import chooses_parts
from renderer.gl.program import Program
from renderer.head.cells import Cells, sort_into_cells
from renderer.view import Matrix

STATIC: Final = ("3f 3f 3f 4f 1f", ["in_position", "in_normal", "in_albedo", "in_detail", "in_lid"])
LIT: Final = ("3f 4f", ["in_diffuse", "in_surface"])


class CellMesh:
    """Triangles drawn cell by cell. Its vertices lie in the order of their use.

    Software renderers shade long runs of neighbouring vertices several times faster.
    """

    def __init__(
        self,
        gl: moderngl.Context,
        rows: Floats,
        triangles: Indices,
        *,
        turn: int | None = None,
        kinds: Indices | None = None,
    ) -> None:
        """``rows`` (n, 14) are what STATIC names, of all the vertices that ``triangles`` count.

        ``turn`` numbers a column that runs once around from 0 to 1, if there is one. ``kinds`` (m,)
        numbers the program from 0 that draws each triangle; without them all have the first.
        """
        kinds = np.zeros(len(triangles), dtype=np.int64) if kinds is None else kinds
        source = np.arange(len(rows))
        if turn is not None:
            source, triangles = unroll(rows[:, turn], triangles)
            on = np.arange(len(source)) >= len(rows)
            rows = rows[source]
            rows[on, turn] += 1.0
        self._chooses = chooses_parts(gl)
        self._cells: list[tuple[int, Cells]] = []
        parts, first = [triangles[:0]], 0
        for kind in np.unique(kinds).tolist():
            part, cells = sort_into_cells(rows[:, :3], triangles[kinds == kind])
            self._cells.append((kind, replace(cells, first=cells.first + first)))
            parts.append(part)
            first += part.size
        used, numbers = _by_first_use(np.concatenate(parts))
        self.points_mm: Floats = rows[used, :3]
        self.triangles: Indices = numbers.reshape(-1, 3)
        self._used = source[used]
        self._gl = gl
        self._index = gl.buffer(numbers.astype(np.int32).tobytes())
        self._static = gl.buffer(rows[used].astype(np.float32).tobytes())
        self._light = gl.buffer(reserve=len(self._used) * 7 * 4)
        self._arrays: dict[int, moderngl.VertexArray] = {}

    def write_light(self, rows: Floats) -> None:
        """Replace the baked light: rows (n, 7) are what LIT names, for the same n vertices."""
        self._light.write(rows[self._used].astype(np.float32).tobytes())

    def has_kind(self, kind: int) -> bool:
        """Whether it has triangles of a kind."""
        return any(number == kind for number, _ in self._cells)

    def draw(
        self,
        program: Program,
        clip: Matrix | Floats,
        *,
        camera_mm: Floats | None = None,
        kind: int | None = None,
    ) -> None:
        """Draw the cells that a world-to-clip matrix can show, with a camera only its fronts.

        On a GPU all of them.

        ``kind`` narrows it to triangles of that kind.
        """
        array = self._array(program)
        for number, cells in self._cells:
            if kind is None or number == kind:
                shown = cells.visible(clip, camera_mm) if self._chooses else cells.whole
                for first, count in shown:
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


def joined(meshes: Sequence[CellMesh], corners: Floats | None = None) -> tuple[Floats, Indices]:
    """Return points (n, 3) and triangles (m, 3) of several meshes, and of loose ``corners``."""
    points = [mesh.points_mm for mesh in meshes]
    triangles = [mesh.triangles for mesh in meshes]
    if corners is not None:
        points.append(corners)
        triangles.append(np.arange(len(corners)).reshape(-1, 3))
    firsts = np.cumsum([0] + [len(part) for part in points])
    return np.concatenate(points), np.concatenate(
        [part + first for part, first in zip(triangles, firsts, strict=False)]
    )


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
