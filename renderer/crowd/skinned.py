"""Figures' meshes on the GPU, skinned there into one buffer that every pass draws from."""

from __future__ import annotations

from collections.abc import Sequence

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.crowd.figure import Body
from renderer.crowd.figures import Figure
from renderer.crowd.pieces import PARTS
from renderer.gl.assembly import assemble
from renderer.gl.uniforms import plain_uniform

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

_VERTEX_BYTES = 24


class SkinnedFigures:
    """Posed vertices of figures: ``skin`` some, then draw from ``posed``."""

    def __init__(self, gl: moderngl.Context, figures: Sequence[Figure]) -> None:
        self.gl = gl
        self.figures = figures
        self._program = gl.program(
            vertex_shader=assemble("crowd_pose.vert").text, varyings=("p_world", "n_world")
        )
        self.posed = gl.buffer(
            reserve=_VERTEX_BYTES * sum(len(figure.body.positions_mm) for figure in figures)
        )
        self._nowhere = gl.framebuffer([gl.renderbuffer((1, 1))])
        # People who share a mesh share its vertices at rest.
        shared: dict[int, moderngl.VertexArray] = {}
        for figure in figures:
            mesh = id(figure.body.positions_mm)
            if mesh not in shared:
                shared[mesh] = self._rest_vertices(figure.body)
        self._rest = [shared[id(figure.body.positions_mm)] for figure in figures]

    def skin(self, numbers: Sequence[int], bones: Floats) -> None:
        """Skin figures by number with everybody's bones (f, b, 4, 4)."""
        matrices = np.swapaxes(bones, 2, 3).astype(np.float32)
        uniform = plain_uniform(self._program, "u_bones")
        # Capturing vertices needs a complete target, though nothing is drawn into it.
        with self.gl.scope(self._nowhere, moderngl.NOTHING):
            for number in numbers:
                uniform.write(np.ascontiguousarray(matrices[number]).tobytes())
                self._rest[number].transform(
                    self.posed,
                    moderngl.POINTS,
                    buffer_offset=self.figures[number].first_vertex * _VERTEX_BYTES,
                )

    def vertices(self) -> npt.NDArray[np.float32]:
        """Read the posed vertices back: positions in mm and normals, (n, 6)."""
        return np.frombuffer(self.posed.read(), np.float32).reshape(-1, 6)

    def _rest_vertices(self, body: Body) -> moderngl.VertexArray:
        rows = np.hstack([body.positions_mm, body.normals, body.bones, body.weights])
        buffer = self.gl.buffer(rows.astype(np.float32).tobytes())
        names = ("in_position", "in_normal", "in_bones", "in_weights")
        return self.gl.vertex_array(self._program, [(buffer, "3f 3f 4f 4f", *names)])


def joined_triangles(
    triangles: Sequence[Indices], firsts: Sequence[int]
) -> tuple[bytes, list[tuple[int, int]]]:
    """Return all figures' triangles as one buffer's content, and where each one's part lies."""
    rows = [part + first for part, first in zip(triangles, firsts, strict=True)]
    starts = np.cumsum([0, *[part.size for part in rows]]).tolist()
    ranges = [(start, part.size) for start, part in zip(starts, rows, strict=False)]
    return np.concatenate(rows).astype(np.int32).tobytes(), ranges


def eyes_last(body: Body) -> tuple[Indices, int]:
    """Return a body's triangles with the painted eyes at the end, and how many are others."""
    is_eye = body.parts[body.triangles[:, 0]] == PARTS.index("eyes")
    return np.concatenate([body.triangles[~is_eye], body.triangles[is_eye]]), int((~is_eye).sum())
