"""Figures' meshes on the GPU, skinned there into one buffer that every pass draws from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.crowd.figure import BONES
from renderer.crowd.figures import Figure
from renderer.gl.assembly import assemble
from renderer.gl.index_ranges import adjoined

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

_VERTEX_BYTES: Final = 24
_COLUMNS: Final = 4  # of a bone's matrix


class SkinnedFigures:
    """Posed vertices of figures: ``skin`` some, then draw from ``posed``."""

    def __init__(self, gl: moderngl.Context, figures: Sequence[Figure]) -> None:
        self.gl = gl
        self.figures = figures
        self._program = gl.program(
            vertex_shader=assemble("crowd_pose.vert").text, varyings=("p_world", "n_world")
        )
        self._parts = [(figure.first_vertex, len(figure.body.positions_mm)) for figure in figures]
        self.posed = gl.buffer(reserve=_VERTEX_BYTES * sum(count for _, count in self._parts))
        self._bones = gl.texture((_COLUMNS, len(BONES) * len(figures)), 4, dtype="f4")
        self._nowhere = gl.framebuffer([gl.renderbuffer((1, 1))])
        rest = np.concatenate([_rest(figure, row) for row, figure in enumerate(figures)])
        names = ("in_position", "in_normal", "in_bones", "in_weights")
        self._rest = gl.vertex_array(
            self._program, [(gl.buffer(rest.tobytes()), "3f 3f 4f 4f", *names)]
        )

    def skin(self, numbers: Sequence[int], bones: Floats) -> None:
        """Skin figures by number with everybody's bones (f, b, 4, 4)."""
        self._bones.write(np.swapaxes(bones, 2, 3).astype(np.float32, order="C"))
        self._bones.use(0)
        # Capturing vertices needs a complete target, though nothing is drawn into it.
        with self.gl.scope(self._nowhere, moderngl.NOTHING):
            for first, count in adjoined(self._parts[number] for number in numbers):
                self._rest.transform(
                    self.posed,
                    moderngl.POINTS,
                    vertices=count,
                    first=first,
                    buffer_offset=first * _VERTEX_BYTES,
                )

    def vertices(self) -> npt.NDArray[np.float32]:
        """Read the posed vertices back: positions in mm and normals, (n, 6)."""
        return np.frombuffer(self.posed.read(), np.float32).reshape(-1, 6)


def _rest(figure: Figure, row: int) -> npt.NDArray[np.float32]:
    """Return a figure's vertices at rest with its bones as they are numbered among everybody's."""
    body = figure.body
    bones = body.bones + row * len(BONES)
    return np.hstack([body.positions_mm, body.normals, bones, body.weights]).astype(np.float32)


def joined_triangles(
    triangles: Sequence[Indices], firsts: Sequence[int]
) -> tuple[bytes, list[tuple[int, int]]]:
    """Return all figures' triangles as one buffer's content, and where each one's part lies."""
    rows = [part + first for part, first in zip(triangles, firsts, strict=True)]
    starts = np.cumsum([0, *[part.size for part in rows]]).tolist()
    ranges = [(start, part.size) for start, part in zip(starts, rows, strict=False)]
    return np.concatenate(rows).astype(np.int32).tobytes(), ranges
