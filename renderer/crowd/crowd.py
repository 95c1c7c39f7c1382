"""The other characters on the GPU: skinned once per frame, drawn into picture and cube.

Who they are and where they stand: ``renderer.crowd.stage``. Only who can be seen is skinned and
drawn. Five people keep painted eyes; a larger crowd has real ones (``renderer.crowd.eyes``).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.camera import View
from renderer.clip import ClipSpec
from renderer.crowd.bodies import build_figures
from renderer.crowd.culling import in_view
from renderer.crowd.eyes import CrowdEyes, DrawnEye
from renderer.crowd.shadows import CrowdShadows
from renderer.crowd.shares import light_shares
from renderer.crowd.skinned import SkinnedFigures, eyes_last, joined_triangles
from renderer.crowd.stage import STAGE, Member, members
from renderer.crowd.troupe import Troupe
from renderer.frame.outlines import BYSTANDER, Outlines
from renderer.gl.index_ranges import adjoined
from renderer.gl.program import build_program
from renderer.light import Light
from renderer.lod.choice import LodPolicy
from renderer.lod.policy import default_policy

Floats = npt.NDArray[np.float64]
StaticCube = Callable[[int], moderngl.TextureCube]

PAINTED_CROWD: Final = len(STAGE)  # the thesis's scene: its bystanders' eyes are paint


class Crowd:
    """The crowd of a clip. Poses follow from time alone; ``draw`` shows the bystanders."""

    def __init__(
        self,
        gl: moderngl.Context,
        spec: ClipSpec,
        light: Light,
        *,
        static_cube: StaticCube | None = None,
        stage: Sequence[Member] | None = None,
        policy: LodPolicy | None = None,
    ) -> None:
        """``stage`` says who stands where instead of ``spec.crowd``; its people have real eyes.

        ``policy`` chooses the LoD of real eyes: else the clip's, else the renderer's own.

        ``static_cube`` gives the surroundings at a size; without it all eyes are painted.
        """
        self.gl = gl
        self.light = light
        self._policy = policy or spec.lod_policy or default_policy()
        cast = members(spec.crowd) if stage is None else stage
        is_large = stage is not None or len(cast) > PAINTED_CROWD
        has_eyes = static_cube is not None and is_large
        self.figures = build_figures(cast, is_awake=has_eyes)
        self.eyes_drawn: list[DrawnEye] = []  # in the last picture
        self._drawn: list[int] = []  # the figures in it
        self.shows_everybody = False  # also those whom only eyes are to see
        self._troupe = Troupe(self.figures)
        self._time_s: float | None = None
        self._bones: Floats = np.zeros((0, 0, 4, 4))
        self._skinned: set[int] = set()
        self._eyes: CrowdEyes | None = None
        if self.figures:
            self._make_buffers(static_cube if has_eyes else None)

    def pose(self, time_s: float) -> None:
        """Pose everybody for a time; does nothing when they already stand so."""
        if time_s != self._time_s:
            self._bones = self._troupe.bones(time_s)
            self._skinned.clear()
            self._time_s = time_s

    def bounds_mm(self) -> list[tuple[Floats, Floats]]:
        """Return per figure spheres that hold it in the last pose: centres (k, 3), radii (k,)."""
        return [
            (figure.carry_spheres(transforms), figure.spheres[1])
            for figure, transforms in zip(self.figures, self._bones, strict=True)
        ]

    def vertices(self, time_s: float) -> npt.NDArray[np.float32]:
        """Return everybody's vertices at a time: positions in mm and normals, (n, 6)."""
        self.pose(time_s)
        self.skin(range(len(self.figures)))
        return self._meshes.vertices()

    def draw(
        self,
        *,
        view_matrix: npt.NDArray[np.floating],
        projection: npt.NDArray[np.floating],
        camera_mm: npt.NDArray[np.floating],
        time_s: float,
    ) -> None:
        """Draw the bystanders that a view shows into the picture (see the stage's rule)."""
        self.eyes_drawn, self._drawn = [], []
        if not self.figures:
            return
        self.pose(time_s)
        seen = self._drawn = self.in_view(np.asarray(projection) @ np.asarray(view_matrix))
        lines = int(self.gl.fbo.viewport[3])
        if self._eyes:
            self.eyes_drawn = self._eyes.choose(
                self._bones,
                view_matrix=view_matrix,
                projection=projection,
                lines=lines,
                among=seen,
            )
        self.draw_figures(
            seen,
            view_matrix=view_matrix,
            projection=projection,
            camera_mm=camera_mm,
            eyeless={eye.figure for eye in self.eyes_drawn},
            is_marked=True,
        )
        if self._eyes and self.eyes_drawn:
            self._eyes.draw(
                light=self.light,
                view_matrix=view_matrix,
                projection=projection,
                camera_mm=camera_mm,
                lines=lines,
            )

    def draw_outlines(self, view: View, outlines: Outlines) -> None:
        """Draw depth and marks of what the last ``draw`` drew of the same view."""
        if not self._drawn:
            return
        clip = np.asarray(view.projection) @ np.asarray(view.view_matrix)
        self._marking.set(u_world_to_clip=clip)
        with outlines.marking():
            eyeless = {eye.figure for eye in self.eyes_drawn}
            self._render(self._marked_vertices, self._drawn, eyeless)
            if self._eyes and self.eyes_drawn:
                self._eyes.draw_outlines(view_matrix=view.view_matrix, projection=view.projection)

    def in_view(self, world_to_clip: npt.NDArray[np.floating]) -> list[int]:
        """Return the numbers of those who are shown and may be seen in the last pose."""
        return [
            number
            for number, (centres, reach) in enumerate(self.bounds_mm())
            if (self.shows_everybody or self.figures[number].member.is_shown)
            and in_view(centres, reach, world_to_clip=world_to_clip).any()
        ]

    def draw_figures(
        self,
        numbers: Sequence[int],
        *,
        view_matrix: npt.NDArray[np.floating],
        projection: npt.NDArray[np.floating],
        camera_mm: npt.NDArray[np.floating],
        eyeless: Collection[int] = (),
        is_marked: bool = False,
    ) -> None:
        """Draw figures by number in the pose of the last ``pose``, without changing state.

        Those who are ``eyeless`` get real eyes from elsewhere, so the painted ones are left out.
        Alpha is coverage or, where it ``is_marked``, tells their parts.
        """
        self.skin(numbers)
        self.light_figures(projection=projection, camera_mm=camera_mm, is_marked=is_marked)
        self.draw_lit(numbers, view_matrix=view_matrix, eyeless=eyeless)

    def light_figures(
        self,
        *,
        projection: npt.NDArray[np.floating],
        camera_mm: npt.NDArray[np.floating],
        is_marked: bool = False,
    ) -> None:
        """Set what all views to come share (see ``draw_figures``)."""
        self._program.set(
            u_projection=projection,
            u_camera_mm=camera_mm,
            u_marked=float(is_marked),
            **self.light.uniforms(),
        )

    def draw_lit(
        self,
        numbers: Sequence[int],
        *,
        view_matrix: npt.NDArray[np.floating],
        eyeless: Collection[int] = (),
    ) -> None:
        """Draw figures that are skinned, in the light that ``light_figures`` set."""
        self._program.set(u_view_matrix=view_matrix)
        self._render(self._vertices, numbers, eyeless)

    def _render(
        self, vertices: moderngl.VertexArray, numbers: Sequence[int], eyeless: Collection[int]
    ) -> None:
        ranges = (
            (first, self._without_eyes[number] if number in eyeless else count)
            for number in numbers
            for first, count in [self._index_ranges[number]]
        )
        for first, count in adjoined(ranges):
            vertices.render(moderngl.TRIANGLES, vertices=count, first=first)

    def skin(self, numbers: Sequence[int]) -> None:
        """Skin figures by number for the last ``pose``, who are not yet."""
        missing = [number for number in numbers if number not in self._skinned]
        if missing:
            self._meshes.skin(missing, self._bones)
            self._skinned.update(missing)

    def _make_buffers(self, static_cube: StaticCube | None) -> None:
        gl, figures = self.gl, self.figures
        self._meshes = SkinnedFigures(gl, figures)
        self._program = build_program(gl, "crowd.vert", fragment="crowd.frag")
        shares = [light_shares(figure, self.light.sky.sun_direction) for figure in figures]
        fixed = [
            np.column_stack([figure.body.surface, share, BYSTANDER + figure.body.parts])
            for figure, share in zip(figures, shares, strict=True)
        ]
        surfaces = gl.buffer(np.concatenate(fixed).astype(np.float32).tobytes())
        firsts = [figure.first_vertex for figure in figures]
        bodies = [figure.body for figure in figures]
        ordered = [eyes_last(body) if static_cube else (body.triangles, 0) for body in bodies]
        self._without_eyes = [3 * others for _, others in ordered]
        content, self._index_ranges = joined_triangles([rows for rows, _ in ordered], firsts)
        index = gl.buffer(content)
        self._vertices = gl.vertex_array(
            self._program.gl_program,
            [
                (self._meshes.posed, "3f 3f", "p_world", "n_world"),
                (surfaces, "4f 2f 1f", "in_surface", "in_light", "in_mark"),
            ],
            index,
        )
        self._marking = build_program(gl, "crowd_mark.vert", fragment="crowd_mark.frag")
        self._marked_vertices = gl.vertex_array(
            self._marking.gl_program,
            [(self._meshes.posed, "3f 12x", "p_world"), (surfaces, "24x 1f", "in_mark")],
            index,
        )
        self.shadows = CrowdShadows(gl, self._meshes)
        if static_cube:
            self._eyes = CrowdEyes(
                gl, figures, shares=shares, static_cube=static_cube, policy=self._policy
            )
