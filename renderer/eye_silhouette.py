"""The eye's meshes on the GPU, and the fine mesh as a silhouette over a shaded picture."""

from __future__ import annotations

from typing import Any, Final

import moderngl
import numpy as np

from renderer.detail import Detail
from renderer.geometry import Mesh, eye_mesh
from renderer.program import Program, build_program

HULL_SCALE: Final = 1.08  # a coarse globe of this size encloses every finer one


class Silhouette:
    """The fine mesh of one eye and the picture that it is filled from."""

    def __init__(self, gl: moderngl.Context, mesh: Mesh) -> None:
        self.camera: Any = None  # whose picture is in the target
        self._program = build_program(gl, "eye.vert", fragment="eye_silhouette.frag")
        self._mesh = vertex_array(gl, self._program, mesh)
        self._target: moderngl.Framebuffer | None = None
        self._shaded: moderngl.Texture | None = None
        self._origin_px = (0, 0)

    def begin(self, gl: moderngl.Context, viewport: tuple[int, int, int, int]) -> None:
        """Make a cleared target of the viewport's size the one that is drawn to."""
        self._origin_px = viewport[:2]
        if self._target is None or self._target.size != viewport[2:]:
            self._shaded = gl.texture(viewport[2:], 4, dtype="f2")
            self._shaded.filter = (moderngl.NEAREST, moderngl.NEAREST)
            self._target = gl.framebuffer([self._shaded])
        self._target.use()
        self._target.clear()

    def draw(self, values: dict[str, Any]) -> None:
        """Draw the fine mesh into the current target."""
        self._program.set(**values, u_shaded=self._shaded, u_view_origin_px=self._origin_px)
        self._mesh.render()


def detail_mesh(detail: Detail) -> Mesh:
    """Return the mesh that a LoD's tessellation asks for."""
    return eye_mesh(
        int(detail.setting("tessellation", "triangles")),
        facets=detail.setting("tessellation", "normals") == "facet",
    )


def hull_mesh() -> Mesh:
    """Return a coarse mesh that encloses the globe: it says which pixels to shade."""
    coarse = eye_mesh(150)
    return Mesh(HULL_SCALE * coarse.positions, coarse.normals, coarse.triangles)


def vertex_array(gl: moderngl.Context, program: Program, mesh: Mesh) -> moderngl.VertexArray:
    """Upload a mesh for a program that may read positions or normals alone."""
    corners = np.concatenate([mesh.positions, mesh.normals], axis=1).astype(np.float32)
    is_read = [name in program.gl_program for name in ("in_position", "in_normal")]
    layout = " ".join("3f" if read else "12x" for read in is_read)
    names = [n for n, read in zip(("in_position", "in_normal"), is_read, strict=True) if read]
    content = (gl.buffer(corners.tobytes()), layout, *names)
    triangles = gl.buffer(mesh.triangles.astype(np.int32).tobytes())
    return gl.vertex_array(program.gl_program, [content], triangles)
