"""The other characters: who of them a view shows, posed once per frame, with their eyes.

Who they are and where they stand: ``renderer.crowd.stage``. On software GL only who can be seen is
skinned and drawn; on a GPU finding out would take longer than drawing everybody. Five people keep
painted eyes; a larger crowd has real ones (``renderer.crowd.eyes``).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.clip import ClipSpec
from renderer.crowd.bodies import build_figures
from renderer.crowd.culling import Bounds, Spheres
from renderer.crowd.eyes import CrowdEyes, DrawnEye
from renderer.crowd.meshes import CrowdMeshes
from renderer.crowd.shadows import CrowdShadows
from renderer.crowd.shares import light_shares
from renderer.crowd.stage import STAGE, Member, members
from renderer.crowd.troupe import Troupe
from renderer.frame.outlines import Outlines
from renderer.gl.context import chooses_parts
from renderer.light import Light
from renderer.lod.choice import LodPolicy
from renderer.lod.policy import default_policy
from renderer.view import View

Floats = npt.NDArray[np.float64]
Matrix = npt.NDArray[np.floating]
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
        cast = members(spec.crowd) if stage is None else stage
        is_large = stage is not None or len(cast) > PAINTED_CROWD
        has_eyes = static_cube is not None and is_large
        self.figures = build_figures(cast, is_awake=has_eyes)
        self.eyes_drawn: list[DrawnEye] = []  # in the last picture
        self._drawn: list[int] = []  # the figures in it
        self.shows_everybody = False  # also those whom only eyes are to see
        self._shown = [row for row, member in enumerate(cast) if member.is_shown]
        self._chooses = chooses_parts(gl)
        self._troupe = Troupe(self.figures)
        self._spheres = Spheres(self.figures)
        self._time_s: float | None = None
        self._bones: Floats = np.zeros((0, 0, 4, 4))
        self._skinned: set[int] = set()
        self._eyes: CrowdEyes | None = None
        if not self.figures:
            return
        shares = [light_shares(figure, light.sky.sun_direction) for figure in self.figures]
        self.meshes = CrowdMeshes(gl, self.figures, shares=shares, has_real_eyes=has_eyes)
        self.shadows = CrowdShadows(gl, self.meshes.skinned)
        if static_cube and has_eyes:
            self._eyes = CrowdEyes(
                gl,
                self.figures,
                shares=shares,
                static_cube=static_cube,
                policy=policy or spec.lod_policy or default_policy(),
            )

    def pose(self, time_s: float) -> None:
        """Pose everybody for a time; does nothing when they already stand so."""
        if time_s != self._time_s:
            self._bones = self._troupe.bones(time_s)
            self._skinned.clear()
            self._time_s = time_s

    def bounds_mm(self) -> Bounds:
        """Return spheres that hold everybody in the last pose."""
        return self._spheres.carried(self._bones)

    def vertices(self, time_s: float) -> npt.NDArray[np.float32]:
        """Return everybody's vertices at a time: positions in mm and normals, (n, 6)."""
        self.pose(time_s)
        self.skin(range(len(self.figures)))
        return self.meshes.skinned.vertices()

    def draw(
        self, *, view_matrix: Matrix, projection: Matrix, camera_mm: Matrix, time_s: float
    ) -> None:
        """Draw the bystanders that a view shows into the picture (see the stage's rule)."""
        self.eyes_drawn, self._drawn = [], []
        if not self.figures:
            return
        self.pose(time_s)
        seen = self._drawn = self.in_view(projection @ view_matrix)
        lines = int(self.gl.fbo.viewport[3])
        if self._eyes:
            self.eyes_drawn = self._eyes.choose(
                self._bones,
                view_matrix=view_matrix,
                projection=projection,
                lines=lines,
                among=seen,
            )
        self.skin(seen)
        self.meshes.light(self.light, projection=projection, camera_mm=camera_mm, is_marked=True)
        self.meshes.draw(seen, view_matrix=view_matrix, eyeless=self._eyeless())
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
        clip = view.projection @ view.view_matrix
        with outlines.marking():
            self.meshes.draw_marks(self._drawn, world_to_clip=clip, eyeless=self._eyeless())
            if self._eyes and self.eyes_drawn:
                self._eyes.draw_outlines(view_matrix=view.view_matrix, projection=view.projection)

    def in_view(self, world_to_clip: Matrix) -> list[int]:
        """Return the numbers of those who are shown and may be seen in the last pose."""
        shown = list(range(len(self.figures))) if self.shows_everybody else self._shown
        if not self._chooses:
            return shown
        may_be_seen = self.bounds_mm().in_view(world_to_clip)
        return [number for number in shown if may_be_seen[number]]

    def skin(self, numbers: Sequence[int]) -> None:
        """Skin figures by number for the last ``pose``, who are not yet."""
        missing = [number for number in numbers if number not in self._skinned]
        if missing:
            self.meshes.skinned.skin(missing, self._bones)
            self._skinned.update(missing)

    def _eyeless(self) -> set[int]:
        """Return whose painted eyes real ones stand in for, in the last picture."""
        return {eye.figure for eye in self.eyes_drawn}
