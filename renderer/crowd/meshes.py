"""Everybody's meshes on the GPU: skinned for a pose, then drawn in their light or as marks."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.crowd.figure import Body
from renderer.crowd.figures import Figure
from renderer.crowd.pieces import PARTS
from renderer.crowd.skinned import Indices, SkinnedFigures, joined_triangles
from renderer.frame.outlines import BYSTANDER
from renderer.gl.index_ranges import Range, adjoined
from renderer.gl.program import build_program
from renderer.light import Light

Floats = npt.NDArray[np.float64]
Matrix = npt.NDArray[np.floating]


class CrowdMeshes:
    """Figures by number: skin them in ``skinned``, say what ``light`` they stand in, and draw.

    Those who are ``eyeless`` get real eyes from elsewhere, so the painted ones are left out.
    """

    def __init__(
        self,
        gl: moderngl.Context,
        figures: Sequence[Figure],
        *,
        shares: Sequence[Floats],
        has_real_eyes: bool,
    ) -> None:
        """``shares`` are each figure's vertices' (n, 2) shares of sky and sun.

        Nobody can be eyeless unless the crowd ``has_real_eyes``.
        """
        self.skinned = SkinnedFigures(gl, figures)
        fixed = [
            np.column_stack([figure.body.surface, share, BYSTANDER + figure.body.parts])
            for figure, share in zip(figures, shares, strict=True)
        ]
        surfaces = gl.buffer(np.concatenate(fixed).astype(np.float32).tobytes())
        # Painted eyes come after everybody, so that neighbours are one range without theirs.
        split = [_eyes_apart(figure.body, has_real_eyes) for figure in figures]
        firsts = [figure.first_vertex for figure in figures]
        content, ranges = joined_triangles(
            [*(others for others, _ in split), *(eyes for _, eyes in split)], [*firsts, *firsts]
        )
        self._bodies, self._painted_eyes = ranges[: len(figures)], ranges[len(figures) :]
        index = gl.buffer(content)
        posed = self.skinned.posed
        self._lit = build_program(gl, "crowd.vert", fragment="crowd.frag")
        self._lit_vertices = gl.vertex_array(
            self._lit.gl_program,
            [
                (posed, "3f 3f", "p_world", "n_world"),
                (surfaces, "4f 2f 1f", "in_surface", "in_light", "in_mark"),
            ],
            index,
        )
        self._marks = build_program(gl, "crowd_mark.vert", fragment="crowd_mark.frag")
        self._marked_vertices = gl.vertex_array(
            self._marks.gl_program,
            [(posed, "3f 12x", "p_world"), (surfaces, "24x 1f", "in_mark")],
            index,
        )

    def light(
        self, light: Light, *, projection: Matrix, camera_mm: Matrix, is_marked: bool = False
    ) -> None:
        """Set what all views to come share.

        Alpha is coverage or, where it ``is_marked``, tells their parts.
        """
        self._lit.set(
            u_projection=projection,
            u_camera_mm=camera_mm,
            u_marked=float(is_marked),
            **light.uniforms(),
        )

    def draw(
        self, numbers: Sequence[int], *, view_matrix: Matrix, eyeless: Collection[int] = ()
    ) -> None:
        """Draw figures in the light that they stand in."""
        self._lit.set(u_view_matrix=view_matrix)
        self._render(self._lit_vertices, self._ranges(numbers, eyeless))

    def draw_marks(
        self, numbers: Sequence[int], *, world_to_clip: Matrix, eyeless: Collection[int] = ()
    ) -> None:
        """Draw figures as the marks of their parts."""
        self._marks.set(u_world_to_clip=world_to_clip)
        self._render(self._marked_vertices, self._ranges(numbers, eyeless))

    def _ranges(self, numbers: Sequence[int], eyeless: Collection[int]) -> list[Range]:
        bodies = [self._bodies[number] for number in numbers]
        eyes = [self._painted_eyes[number] for number in numbers if number not in eyeless]
        return adjoined(part for part in (*bodies, *eyes) if part[1])

    def _render(self, vertices: moderngl.VertexArray, ranges: Sequence[Range]) -> None:
        for first, count in ranges:
            vertices.render(moderngl.TRIANGLES, vertices=count, first=first)


def _eyes_apart(body: Body, has_real_eyes: bool) -> tuple[Indices, Indices]:
    """Return a body's triangles, and those of its painted eyes if they may be left out."""
    is_eye = body.parts[body.triangles[:, 0]] == PARTS.index("eyes")
    is_apart = is_eye & has_real_eyes
    return body.triangles[~is_apart], body.triangles[is_apart]
