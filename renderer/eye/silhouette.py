"""The eye's meshes on the GPU, and the fine mesh as a silhouette over a shaded picture."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.detail import Detail
from renderer.eye.anatomy import APEX_MM, GLOBE_RADIUS_MM
from renderer.eye.geometry import Mesh, eye_mesh
from renderer.eye.lids import LidRims
from renderer.frame.bare_mesh import BareMesh
from renderer.frame.edge_tiles import EdgeTiles
from renderer.frame.outlines import EYE
from renderer.gl.program import Program, build_program

Array = npt.NDArray[np.float64]
Box = tuple[int, int, int, int]

OPENING_MARGIN_MM: Final = 1.5  # lids may be modelled a little wider than their rims say
HULL_SCALE: Final = 1.08  # a coarse globe of this size encloses every finer one


class Shaded:
    """One eye's radiance in a picture of its own, pixel for pixel where a view has it."""

    def __init__(self, rims: LidRims) -> None:
        self.camera: Any = None  # whose picture it is
        self._target: moderngl.Framebuffer | None = None
        self._texture: moderngl.Texture | None = None
        self._opening = opening_points(rims)

    def begin(
        self, gl: moderngl.Context, viewport: tuple[int, int, int, int], *, eye_to_clip: Array
    ) -> None:
        """Make a cleared target that has the viewport the one that is drawn to.

        Drawing is confined to the lids' opening, which ``eye_to_clip`` (4, 4) projects.
        """
        # The same pixels as in the view, not only as many: the same rounding of corners.
        size = (viewport[0] + viewport[2], viewport[1] + viewport[3])
        if self._target is None or self._target.size != size:
            self._texture = gl.texture(size, 4, dtype="f2")
            self._texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
            self._target = gl.framebuffer([self._texture], gl.depth_renderbuffer(size))
        self._target.use()
        self._target.viewport = viewport
        self._target.scissor = viewport
        self._target.clear()
        self._target.scissor = self.box(viewport, eye_to_clip)
        gl.enable_only(moderngl.CULL_FACE | moderngl.DEPTH_TEST)

    @contextmanager
    def only_seen(self, gl: moderngl.Context, mark: Callable[[], None]) -> Iterator[None]:
        """Confine drawing to pixels that ``mark`` gives a depth of 1; ``begin`` came before."""
        assert self._target is not None
        self._target.clear(depth=0.0, viewport=self._target.scissor)
        gl.depth_func = "1"
        mark()
        gl.depth_func = "<"
        self._target.depth_mask = False
        try:
            yield
        finally:
            self._target.depth_mask = True

    def box(self, viewport: Box, eye_to_clip: Array) -> Box:
        """Return the scissor box in the target of what the lids leave open in a viewport."""
        x, y, width, height = opening_box(self._opening, eye_to_clip, viewport[2:])
        return viewport[0] + x, viewport[1] + y, width, height

    def uniforms(self, name: str) -> dict[str, Any]:
        """Return the picture as the sampler ``name``."""
        return {name: self._texture}


class Outline:
    """A mesh of an eye as bare triangles that mark their samples."""

    def __init__(self, gl: moderngl.Context, mesh: Mesh) -> None:
        self._program = build_program(gl, "eye.vert", fragment="mark.frag")
        self._mesh = BareMesh(gl, self._program, mesh.positions, mesh.triangles)

    def draw(self, values: dict[str, Any], tiles: EdgeTiles) -> None:
        """Draw it into the current target where ``tiles`` are."""
        self._program.set(**values, u_mark=EYE / 255.0)
        to_world = values["u_eye_to_world"]
        self._mesh.draw(values["u_projection"] @ values["u_view_matrix"] @ to_world, tiles)


class Silhouette:
    """The fine mesh of one eye, filled from its picture."""

    def __init__(self, gl: moderngl.Context, mesh: Mesh) -> None:
        self._program = build_program(gl, "eye.vert", fragment="eye_silhouette.frag")
        self._mesh = vertex_array(gl, self._program, mesh)
        self._seen = build_program(gl, "eye.vert", fragment="eye_seen.frag")
        self._seen_mesh = vertex_array(gl, self._seen, mesh)

    def draw_seen(self, values: dict[str, Any], depth: moderngl.Texture) -> None:
        """Mark where the mesh is not behind ``depth``, for ``Shaded.only_seen``."""
        self._seen.set(**values, u_depth=depth)
        self._seen_mesh.render()

    def draw(self, values: dict[str, Any], shaded: Shaded) -> None:
        """Draw the fine mesh into the current target."""
        self._program.set(**values, **shaded.uniforms("u_shaded"))
        self._mesh.render()


def opening_points(rims: LidRims) -> Array:
    """Return points (n, 3) in eye space that surround all of the globe that the lids leave open."""
    margin = np.array([0.0, OPENING_MARGIN_MM, 0.0])
    turn = np.radians(np.linspace(-100, 100, 21))
    equator = 1.02 * GLOBE_RADIUS_MM * np.column_stack([np.sin(turn), 0 * turn, np.cos(turn)])
    apex = np.array([[0.0, 0.0, 1.02 * APEX_MM]])
    return np.concatenate([rims.upper_mm + margin, rims.lower_mm - margin, equator, apex])


def opening_box(points: Array, eye_to_clip: Array, size: tuple[int, int]) -> Box:
    """Return the scissor box (x, y, width, height) in pixels around points (n, 3), 2 px wider."""
    clip = np.column_stack([points, np.ones(len(points))]) @ eye_to_clip.T
    pixels = (clip[:, :2] / clip[:, 3:] * 0.5 + 0.5) * size
    low = np.clip(np.floor(pixels.min(axis=0)) - 2, 0, size)
    high = np.clip(np.ceil(pixels.max(axis=0)) + 2, low, size)
    return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])


def common_box(first: Box, second: Box) -> Box:
    """Return what two boxes (x, y, width, height) share; nothing has no width or height."""
    low = np.maximum(first[:2], second[:2])
    high = np.minimum(np.add(first[:2], first[2:]), np.add(second[:2], second[2:]))
    width, height = np.maximum(high - low, 0)
    return int(low[0]), int(low[1]), int(width), int(height)


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
