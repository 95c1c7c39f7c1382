"""Hairs on the GPU: every strand a ribbon that turns its face to the camera."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.body.makehuman import Floats, Indices
from renderer.gl.context import chooses_parts
from renderer.gl.program import Program, build_program
from renderer.head.cells import sort_into_cells
from renderer.head.strand_group import Strands
from renderer.view import Matrix

SILHOUETTE: Final = 0.3  # sine of how far beyond the horizon of its body hair may still be seen
LAYOUT = ("3f 3f 4f 4f", ["in_position", "in_tangent", "in_ribbon", "in_colour"])
ALPHA_KEEPING_TARGET: Final[Any] = (  # moderngl's stub knows only the pair
    moderngl.SRC_ALPHA,
    moderngl.ONE_MINUS_SRC_ALPHA,
    moderngl.ZERO,
    moderngl.ONE,
)
PREMULTIPLIED_KEEPING_TARGET: Final[Any] = (
    moderngl.ONE,
    moderngl.ONE_MINUS_SRC_ALPHA,
    moderngl.ZERO,
    moderngl.ONE,
)
LEAST_PX: Final = 0.25  # hairs that would cover less of a pixel are thinned out
LEAST_LOCK_PX: Final = 1.0
LOCK: Final = 8  # hairs of the scalp that one ribbon stands for
# Each kind has a program of its own: software GL would compute every side of an if.
KINDS: Final = {
    "hair": {"LOCK": 1, "MARK": 0},
    "lock": {"LOCK": LOCK, "MARK": 0},
    "mark": {"LOCK": 1, "MARK": 1},
}


def strand_programs(gl: moderngl.Context) -> dict[str, Program]:
    """Return what draws each kind of strand: single hairs, locks, and marks on the skin."""
    return {
        kind: build_program(gl, "hair.vert", fragment="hair.frag", constants=constants)
        for kind, constants in KINDS.items()
    }


@contextmanager
def blending(gl: moderngl.Context) -> Iterator[None]:
    """Let hairs cover what was drawn before by their alpha; they hide nothing from each other.

    The framebuffer's own alpha stays what it was: it tells eyes from the rest.
    """
    gl.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
    gl.blend_func = ALPHA_KEEPING_TARGET
    target = gl.fbo
    target.depth_mask = False
    try:
        yield
    finally:
        target.depth_mask = True
        gl.disable(moderngl.BLEND)


class StrandMesh:
    """Ribbons of one kind of hair: lashes, brows or scalp hair."""

    def __init__(
        self,
        gl: moderngl.Context,
        strands: Strands,
        rng: np.random.Generator,
        *,
        around_mm: tuple[float, float, float] | None = None,
    ) -> None:
        """``rng`` gives each strand the number by which distant views thin the hair out.

        ``around_mm``: the middle of an opaque body that hides hair on its far side, if any.
        """
        self.kind = "mark" if strands.shadow is not None else "lock" if around_mm else "hair"
        rows, triangles = ribbons(strands, rng)
        triangles, self._cells = sort_into_cells(rows[:, :3], triangles)
        self._hides = around_mm is not None
        self._middle_mm = around_mm or (0.0, 0.0, 0.0)
        if around_mm is not None:
            outward = self._cells.centre_mm - np.asarray(around_mm)
            outward /= np.linalg.norm(outward, axis=1, keepdims=True)
            spread = np.full(len(outward), SILHOUETTE)
            self._cells = replace(self._cells, facing=outward, spread=spread)
        self._gl = gl
        self._chooses = chooses_parts(gl)
        self._vertices = gl.buffer(rows.astype(np.float32).tobytes())
        self._index = gl.buffer(triangles.astype(np.int32).tobytes())
        self._array: moderngl.VertexArray | None = None
        points = strands.points_mm.reshape(-1, 3)
        self.points_mm: Floats = points
        self._sun = gl.buffer(reserve=len(points) * 2 * 4)

    def write_sun(self, visible: npt.ArrayLike) -> None:
        """Replace the share of the sun (n,) at each of ``points_mm``."""
        both_sides = np.repeat(np.asarray(visible, dtype=np.float32), 2)
        self._sun.write(both_sides.tobytes())

    def draw(self, program: Program, clip: Matrix, *, camera_mm: Floats) -> None:
        """Draw the ribbons that a view can show with the program of their kind, always the same.

        On a GPU all of them.
        """
        if self._array is None:
            self._array = self._gl.vertex_array(
                program.gl_program,
                [(self._vertices, LAYOUT[0], *LAYOUT[1]), (self._sun, "1f", "in_sun")],
                self._index,
            )
        camera = camera_mm if self._hides else None
        program.set(
            u_middle_mm=self._middle_mm,
            u_least_px=LEAST_LOCK_PX if self._hides else LEAST_PX,
        )
        shown = self._cells.visible(clip, camera) if self._chooses else self._cells.whole
        for first, count in shown:
            self._array.render(vertices=count, first=first)


def ribbons(strands: Strands, rng: np.random.Generator) -> tuple[Floats, Indices]:
    """Return vertex rows (n, 14) in the order of LAYOUT and triangles (m, 3).

    ``in_ribbon``: side -1 or 1, half width at the root in mm, place along the strand 0 to 1, and
    the thinning number.
    """
    count, points, _ = strands.points_mm.shape
    tangent = np.gradient(strands.points_mm, axis=1)
    tangent /= np.maximum(np.linalg.norm(tangent, axis=2, keepdims=True), 1e-9)
    along = np.broadcast_to(np.linspace(0, 1, points), (count, points))
    half = np.broadcast_to(0.5 * strands.width_mm[:, None], (count, points))
    number = (rng.permutation(count) + 0.5) / max(count, 1)
    number = np.broadcast_to(number[:, None], (count, points))
    shadow = np.zeros(count) if strands.shadow is None else strands.shadow
    colour = np.column_stack([strands.colour, shadow])[:, None]
    colour = np.broadcast_to(colour, (count, points, 4))
    sides = []
    for side in (-1.0, 1.0):
        ribbon = np.stack([np.full((count, points), side), half, along, number], axis=-1)
        sides.append(np.concatenate([strands.points_mm, tangent, ribbon, colour], axis=-1))
    rows = np.stack(sides, axis=2).reshape(-1, 14)
    strand, step = np.meshgrid(np.arange(count), np.arange(points - 1), indexing="ij")
    first = (strand * points + step).ravel() * 2
    quads = np.stack([first, first + 1, first + 3, first + 2], axis=1)
    return rows, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
