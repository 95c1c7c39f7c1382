"""The crowd's shadows on level ground, which the cornea mirrors."""

from __future__ import annotations

from collections.abc import Sequence

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.crowd.skinned import SkinnedFigures, joined_triangles
from renderer.crowd.stage import GROUND_MM
from renderer.gl.index_ranges import adjoined
from renderer.gl.program import build_program
from renderer.light import Sky


class CrowdShadows:
    """Outlines of skinned figures, slid along the sun's light on to the ground."""

    def __init__(self, gl: moderngl.Context, meshes: SkinnedFigures) -> None:
        self._program = build_program(gl, "crowd_shadow.vert", fragment="crowd_shadow.frag")
        content, self._ranges = joined_triangles(
            [figure.body.outline for figure in meshes.figures],
            [figure.first_vertex for figure in meshes.figures],
        )
        self._vertices = gl.vertex_array(
            self._program.gl_program, [(meshes.posed, "3f 3x4", "p_world")], gl.buffer(content)
        )

    def light(self, sky: Sky, *, projection: npt.NDArray[np.floating]) -> None:
        """Set what the shadows of all views to come share."""
        self._program.set(
            u_projection=projection,
            u_sun_direction=sky.sun_direction,
            u_ground_mm=GROUND_MM,
            u_shade=sun_share(sky),
        )

    def draw(self, numbers: Sequence[int], *, view_matrix: npt.NDArray[np.floating]) -> None:
        """Draw the shadows of figures that are skinned, as premultiplied coverage."""
        self._program.set(u_view_matrix=view_matrix)
        for first, count in adjoined(self._ranges[number] for number in numbers):
            self._vertices.render(moderngl.TRIANGLES, vertices=count, first=first)


def sun_share(sky: Sky) -> float:
    """Return the share of the sun in the light on level ground (green channel)."""
    sun = float(sky.sun_irradiance[1] * max(sky.sun_direction[1], 0.0))
    # Upward irradiance from the first coefficients: Ramamoorthi and Hanrahan 2001, eq. 13.
    ambient = float(0.886227 * sky.ambient_sh[0, 1] + 1.023328 * sky.ambient_sh[1, 1])
    return sun / max(sun + ambient, 1e-6)
