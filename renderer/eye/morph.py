"""An eye between two LoDs: one mesh that changes shape, filled from the pictures of both.

Nothing is drawn twice into the frame, so there is one silhouette, no order and no grain. Colours
are mixed as linear radiance.
"""

from __future__ import annotations

from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from renderer.detail import Detail
from renderer.eye.geometry import Mesh
from renderer.eye.optics import unit
from renderer.eye.silhouette import Shaded, detail_mesh
from renderer.frame.outlines import EYE
from renderer.gl.program import build_program

Array = npt.NDArray[np.float64]

# A vertex lies over one of the coarse triangles whose middles are nearest in direction.
CANDIDATES: Final = 24
EDGE_SLACK: Final = 1e-6


class Morph:
    """The finer of two LoDs' meshes on its way from the shape of the ``coarse`` to the ``fine``."""

    def __init__(self, gl: moderngl.Context, coarse: Detail, fine: Detail) -> None:
        self._program = build_program(gl, "eye_morph.vert", fragment="eye_blend.frag")
        start, end = detail_mesh(coarse), detail_mesh(fine)
        if len(start.triangles) <= len(end.triangles):
            shapes, triangles = (laid_on(end.positions, start), end.positions), end.triangles
        else:
            shapes, triangles = (start.positions, laid_on(start.positions, end)), start.triangles
        self._outline = build_program(gl, "eye_morph.vert", fragment="mark.frag")
        corners = gl.buffer(np.concatenate(shapes, axis=1).astype(np.float32).tobytes())
        index = gl.buffer(triangles.astype(np.int32).tobytes())
        self._array, self._bare = (
            gl.vertex_array(
                program.gl_program, [(corners, "3f 3f", "in_coarse_mm", "in_fine_mm")], index
            )
            for program in (self._program, self._outline)
        )

    def draw(self, values: dict[str, Any], *, coarse: Shaded, fine: Shaded, share: float) -> None:
        """Draw into the current target, 0 as the coarse, 1 as the fine LoD."""
        pictures = coarse.uniforms("u_coarse") | fine.uniforms("u_fine")
        self._program.set(**values, **pictures, u_share=share)
        self._array.render()

    def draw_outline(self, values: dict[str, Any], *, share: float) -> None:
        """Draw the same mesh as bare triangles that mark their samples."""
        self._outline.set(**values, u_share=share, u_mark=EYE / 255.0)
        self._bare.render()


def laid_on(points: Array, mesh: Mesh) -> Array:
    """Move points (n, 3) towards or from the globe's centre until they lie on a mesh's triangles.

    The eye is seen whole from its centre, so each direction meets the mesh once. Points beyond its
    rim, inside the head, stay where they are.
    """
    corners = mesh.positions[mesh.triangles]
    directions = unit(points)
    count = min(CANDIDATES, len(corners))
    _, near = cKDTree(unit(corners.mean(axis=1))).query(directions, k=count)
    a, b, c = (corners[near, i] for i in range(3))
    normal = np.cross(b - a, c - a)
    facing = np.einsum("nki,ni->nk", normal, directions)
    reach = np.einsum("nki,nki->nk", normal, a) / np.where(facing > 0, facing, np.inf)
    hit = reach[..., None] * directions[:, None]
    inside = np.min(
        [
            np.einsum("nki,nki->nk", np.cross(q - p, hit - p), normal)
            for p, q in ((a, b), (b, c), (c, a))
        ],
        axis=0,
    )
    # Share of the triangle's area: rounding at shared edges must not lose a point.
    inside /= np.einsum("nki,nki->nk", normal, normal)
    best = np.argmax(np.where(facing > 0, inside, -np.inf), axis=1)
    row = np.arange(len(points))
    is_over = inside[row, best] > -EDGE_SLACK
    return np.where(is_over[:, None], hit[row, best], points)
