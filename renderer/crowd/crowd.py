"""The five other characters on the GPU: skinned once per frame, drawn into picture and cube.

Who they are and where they stand: ``renderer.crowd.stage``.
"""

from __future__ import annotations

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.clip import ClipSpec
from renderer.crowd.figure import Body
from renderer.crowd.figures import Troupe, build_figures
from renderer.crowd.shares import light_shares
from renderer.crowd.stage import GROUND_MM, members
from renderer.light import Light
from renderer.program import assemble, build_program, plain_uniform

Floats = npt.NDArray[np.float64]


class Crowd:
    """The crowd of a clip. Poses follow from time alone; ``draw`` shows the bystanders."""

    def __init__(self, gl: moderngl.Context, spec: ClipSpec, light: Light) -> None:
        self.gl = gl
        self.light = light
        self.figures = build_figures(members(spec.crowd))
        self._troupe = Troupe(self.figures)
        self._time_s: float | None = None
        self._bones: list[Floats] = []
        self._nowhere = gl.framebuffer([gl.renderbuffer((1, 1))])
        if self.figures:
            self._make_buffers()

    def pose(self, time_s: float) -> None:
        """Skin everybody for a time; does nothing when they already stand so."""
        if time_s != self._time_s:
            self._bones = list(self._troupe.bones(time_s))
            # Capturing vertices needs a complete target, though nothing is drawn into it.
            with self.gl.scope(self._nowhere, moderngl.NOTHING):
                for number, transforms in enumerate(self._bones):
                    self._skin(number, transforms)
            self._time_s = time_s

    def bounds_mm(self) -> list[tuple[Floats, Floats]]:
        """Return per figure spheres that hold it in the last pose: centres (k, 3), radii (k,)."""
        return [
            (figure.carry_spheres(transforms), figure.spheres[1])
            for figure, transforms in zip(self.figures, self._bones, strict=True)
        ]

    def draw(
        self,
        *,
        view_matrix: npt.NDArray[np.floating],
        projection: npt.NDArray[np.floating],
        camera_mm: npt.NDArray[np.floating],
        time_s: float,
    ) -> None:
        """Draw the bystanders into the picture (see the rule above)."""
        if not self.figures:
            return
        self.pose(time_s)
        shown = [number for number, figure in enumerate(self.figures) if figure.member.is_shown]
        self.draw_figures(
            shown, view_matrix=view_matrix, projection=projection, camera_mm=camera_mm
        )

    def draw_figures(
        self,
        numbers: list[int],
        *,
        view_matrix: npt.NDArray[np.floating],
        projection: npt.NDArray[np.floating],
        camera_mm: npt.NDArray[np.floating],
    ) -> None:
        """Draw figures by number in the pose of the last ``pose``, without changing state."""
        self._program.set(
            u_view_matrix=view_matrix,
            u_projection=projection,
            u_camera_mm=camera_mm,
            **self.light.uniforms(),
        )
        for number in numbers:
            first, count = self._index_ranges[number]
            self._vertices.render(moderngl.TRIANGLES, vertices=count, first=first)

    def draw_shadows(
        self,
        numbers: list[int],
        *,
        view_matrix: npt.NDArray[np.floating],
        projection: npt.NDArray[np.floating],
    ) -> None:
        """Draw the figures' shadows on the ground as premultiplied coverage."""
        self._shadow.set(
            u_view_matrix=view_matrix,
            u_projection=projection,
            u_sun_direction=self.light.sky.sun_direction,
            u_ground_mm=GROUND_MM,
            u_shade=self._sun_share(),
        )
        for number in numbers:
            first, count = self._outline_ranges[number]
            self._shadow_vertices.render(moderngl.TRIANGLES, vertices=count, first=first)

    def _sun_share(self) -> float:
        """Return the share of the sun in the light on level ground (green channel)."""
        sky = self.light.sky
        sun = float(sky.sun_irradiance[1] * max(sky.sun_direction[1], 0.0))
        # Upward irradiance from the first coefficients: Ramamoorthi and Hanrahan 2001, eq. 13.
        ambient = float(0.886227 * sky.ambient_sh[0, 1] + 1.023328 * sky.ambient_sh[1, 1])
        return sun / max(sun + ambient, 1e-6)

    def _skin(self, number: int, transforms: Floats) -> None:
        matrices = np.swapaxes(transforms, 1, 2).astype(np.float32)
        bones = plain_uniform(self._pose_program, "u_bones")
        bones.write(np.ascontiguousarray(matrices).tobytes())
        self._rest[number].transform(
            self._posed, moderngl.POINTS, buffer_offset=self.figures[number].first_vertex * 24
        )

    def _make_buffers(self) -> None:
        gl = self.gl
        self._pose_program = gl.program(
            vertex_shader=assemble("crowd_pose.vert").text, varyings=("p_world", "n_world")
        )
        self._program = build_program(gl, "crowd.vert", fragment="crowd.frag")
        self._shadow = build_program(gl, "crowd_shadow.vert", fragment="crowd_shadow.frag")
        bodies = [figure.body for figure in self.figures]
        total = sum(len(body.positions_mm) for body in bodies)
        self._posed = gl.buffer(reserve=total * 24)
        self._rest = [self._rest_vertices(body) for body in bodies]
        fixed = [
            np.hstack([f.body.surface, light_shares(f, self.light.sky.sun_direction)])
            for f in self.figures
        ]
        surfaces = gl.buffer(np.concatenate(fixed).astype(np.float32).tobytes())
        indices, self._index_ranges = self._indices([f.body.triangles for f in self.figures])
        self._vertices = gl.vertex_array(
            self._program.gl_program,
            [
                (self._posed, "3f 3f", "p_world", "n_world"),
                (surfaces, "4f 2f", "in_surface", "in_light"),
            ],
            indices,
        )
        outlines, self._outline_ranges = self._indices([f.body.outline for f in self.figures])
        self._shadow_vertices = gl.vertex_array(
            self._shadow.gl_program, [(self._posed, "3f 3x4", "p_world")], outlines
        )

    def _indices(
        self, triangles: list[npt.NDArray[np.int64]]
    ) -> tuple[moderngl.Buffer, list[tuple[int, int]]]:
        """Return one buffer of all figures' triangles, and where each figure's part lies."""
        firsts = [figure.first_vertex for figure in self.figures]
        rows = [part + first for part, first in zip(triangles, firsts, strict=True)]
        starts = np.cumsum([0, *[part.size for part in rows]]).tolist()
        ranges = [(start, part.size) for start, part in zip(starts, rows, strict=False)]
        return self.gl.buffer(np.concatenate(rows).astype(np.int32).tobytes()), ranges

    def _rest_vertices(self, body: Body) -> moderngl.VertexArray:
        rows = np.hstack([body.positions_mm, body.normals, body.bones, body.weights])
        buffer = self.gl.buffer(rows.astype(np.float32).tobytes())
        names = ("in_position", "in_normal", "in_bones", "in_weights")
        return self.gl.vertex_array(self._pose_program, [(buffer, "3f 3f 4f 4f", *names)])
