"""The group view on the GPU: the crowd alone, all its eyes in one picture.

What a crowd costs is measured here; clips of studies never show it.
"""

from __future__ import annotations

from dataclasses import dataclass

import moderngl

from renderer.body.makehuman import Floats
from renderer.clip import ClipSpec
from renderer.crowd.crowd import Crowd
from renderer.crowd.eyes import DrawnEye
from renderer.crowd.formation import formation, group_view
from renderer.frame.frame import Frame
from renderer.frame.picture import Picture, Radiance
from renderer.head.sun_shadow import build_light
from renderer.light import Light
from renderer.lod.choice import LodPolicy
from renderer.park.surroundings import Surroundings


@dataclass(frozen=True)
class _Nobody:
    """Casts no shadow: the main character is not in the group."""

    def draw_depth(self, matrix: Floats) -> None:
        """Draw nothing."""


class GroupRenderer:
    """Render ``spec.crowd`` people in rows; of the spec, light, surroundings and size count too.

    Raises ValueError for a crowd of none.
    """

    def __init__(
        self,
        gl: moderngl.Context,
        spec: ClipSpec,
        *,
        surroundings: Surroundings | None = None,
        policy: LodPolicy | None = None,
    ) -> None:
        """``policy`` chooses every eye's LoD by its size instead of the renderer's own."""
        self.gl = gl
        self.spec = spec
        members = formation(spec.crowd)
        self.surroundings = surroundings or Surroundings(gl, spec)
        self.light: Light = build_light(gl, self.surroundings.sky, _Nobody())
        self.crowd = Crowd(
            gl,
            spec,
            self.light,
            static_cube=self.surroundings.cube,
            stage=members,
            policy=policy,
        )
        self._picture = Picture(gl, (spec.width, spec.height))
        self._draw(0.0, 0.0, 0.0)  # what frames need is made before the first

    @property
    def eyes_drawn(self) -> list[DrawnEye]:
        """The eyes of the last frame with their sizes and LoDs."""
        return self.crowd.eyes_drawn

    def render(
        self, azimuth_deg: float = 0.0, *, time_s: float = 0.0, elevation_deg: float = 0.0
    ) -> Frame:
        """Render one frame from an azimuth and elevation about the group at a scene time."""
        self._draw(azimuth_deg, time_s, elevation_deg)
        return Frame(self._picture.finish(), (0, 0))

    def show(self, azimuth_deg: float = 0.0, *, time_s: float = 0.0) -> None:
        """Draw and tone map one frame and read nothing back."""
        self._draw(azimuth_deg, time_s, 0.0)
        self._picture.show()

    def render_radiance(
        self, azimuth_deg: float = 0.0, *, time_s: float = 0.0, elevation_deg: float = 0.0
    ) -> Radiance:
        """Render one frame as linear scene-referred radiance, (height, width, 3) float32."""
        self._draw(azimuth_deg, time_s, elevation_deg, is_plain=True)
        return self._picture.radiance()

    def _draw(
        self, azimuth_deg: float, time_s: float, elevation_deg: float, *, is_plain: bool = False
    ) -> None:
        size = (self.spec.width, self.spec.height)
        view = group_view(size, azimuth_deg=azimuth_deg, elevation_deg=elevation_deg)
        self._picture.begin()
        self._picture.use_rectangle(view.rectangle)
        self.gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self.crowd.draw(**view.uniforms, time_s=time_s)
        self.surroundings.draw_background(view_matrix=view.view_matrix, projection=view.projection)
        (tiles,) = self._picture.find_edges([view])
        self._picture.outlines.begin(view.rectangle, tiles)
        self.crowd.draw_outlines(view, self._picture.outlines)
        self._picture.smooth_edges([view], [tiles], is_plain=is_plain)
