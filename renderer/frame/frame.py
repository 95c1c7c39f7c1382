"""One frame from first pass to last; docs/frame.md says what follows what, and why."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl

from renderer.camera import IRIS_PX, radius_of_px, views
from renderer.clip import ClipSpec
from renderer.crowd.cube import CrowdCube
from renderer.eye.cube_size import cube_px
from renderer.eye.eyes import Eyes
from renderer.eye.model import EyeModel
from renderer.eye.models import EyeModels
from renderer.frame.picture import Picture, Pixels, Radiance
from renderer.frame.view_passes import PASSES, ViewPasses
from renderer.lod.path import Places, details_of, places_of_clip, places_of_view, shares_of
from renderer.scene import Scene, build_scene, scene_key
from renderer.view import View


@dataclass(frozen=True)
class Frame:
    """One picture, (height, width, 3) uint8 sRGB, and each eye's unoccluded pixels in it."""

    pixels: Pixels
    visible_px: tuple[int, int]


class FrameRenderer:
    """Render the frames of one clip. Pass ``scene`` to reuse the last clip's as far as it fits.

    ``eyes`` narrows what is drawn to one eye, (0,) left or (1,) right, which then has the whole
    picture at macroscopic: what one eye costs. Clips have both. ``until`` names the last of PASSES
    to draw, to show how a frame comes about.
    """

    def __init__(
        self,
        gl: moderngl.Context,
        spec: ClipSpec,
        *,
        scene: Scene | None = None,
        wireframe: bool = False,
        eyes: tuple[int, ...] = (0, 1),
        until: str = PASSES[-1],
    ) -> None:
        self.gl = gl
        self.spec = spec
        self.wireframe = wireframe
        self._drawn_eyes = eyes
        if scene is None or scene.key != scene_key(spec):
            scene = build_scene(gl, spec, last=scene)
        self.scene = scene
        self._is_approach = spec.motion == "approach"
        for distance_px in IRIS_PX.values() if self._is_approach else (IRIS_PX[spec.distance],):
            scene.surroundings.prepare_background(radius_of_px(distance_px))
        self._crowd_cube = self._make_crowd_cube()
        self._eyes = Eyes(
            gl,
            EyeModels(
                gl,
                spec,
                rims=scene.head.rims,
                light=scene.light,
                static_cube=scene.surroundings.cube,
                crowd_cube=self._crowd_cube.texture if self._crowd_cube else None,
                kept=scene.kept,
            ),
        )
        self._passes = ViewPasses(gl, scene, self._eyes, is_approach=self._is_approach, until=until)
        in_picture = len(views(spec, 0.0, eyes=eyes))
        self._picture = Picture(gl, (spec.width, spec.height), views=in_picture)

    def render(
        self,
        azimuth_deg: float,
        *,
        time_s: float = 0.0,
        elevation_deg: float = 0.0,
        distance_px: float | None = None,
    ) -> Frame:
        """Render one frame from a camera azimuth at a scene time.

        ``distance_px`` puts the camera where an iris is so wide on 1080 lines; without it an orbit
        keeps its distance and an approach is at its end.
        """
        return self.render_views(
            views(
                self.spec,
                azimuth_deg,
                elevation_deg,
                distance_px=distance_px,
                eyes=self._drawn_eyes,
            ),
            time_s=time_s,
            places=places_of_view(self.spec, azimuth_deg, distance_px=distance_px),
        )

    def render_number(self, frame: int) -> Frame:
        """Render one frame of the clip by its number (0-based)."""
        places = places_of_clip(self.spec)
        return self.render_views(
            views(
                self.spec,
                self.spec.azimuth_deg(frame),
                distance_px=self.spec.distance_px(frame),
                eyes=self._drawn_eyes,
            ),
            time_s=self.spec.time_s(frame),
            places=places[frame] if places else None,
        )

    def render_views(
        self, shown: tuple[View, ...], *, time_s: float = 0.0, places: Places | None = None
    ) -> Frame:
        """Render one frame as cameras see it; ``places`` between a policy's steps, if eyes switch.

        The views' rectangles lie within the picture of the clip's size.
        """
        queries = self._draw(shown, time_s, places)
        pixels = self._picture.finish()
        visible = [0, 0]
        for eye, query in queries.items():
            visible[eye] = int(query.samples)
        return Frame(pixels, (visible[0], visible[1]))

    def show(self, azimuth_deg: float, *, time_s: float = 0.0) -> None:
        """Draw and tone map one frame and read nothing back: what a game would do."""
        shown = views(self.spec, azimuth_deg, eyes=self._drawn_eyes)
        self._draw(shown, time_s, places_of_view(self.spec, azimuth_deg))
        self._picture.show()

    def render_radiance(
        self,
        azimuth_deg: float,
        *,
        time_s: float = 0.0,
        elevation_deg: float = 0.0,
        distance_px: float | None = None,
    ) -> Radiance:
        """Render one frame as linear scene-referred radiance, (height, width, 3) float32 Rec. 709.

        What the camera receives: no exposure, no tone curve, no bloom. First row on top.
        """
        shown = views(
            self.spec, azimuth_deg, elevation_deg, distance_px=distance_px, eyes=self._drawn_eyes
        )
        places = places_of_view(self.spec, azimuth_deg, distance_px=distance_px)
        self._draw(shown, time_s, places, is_plain=True)
        return self._picture.radiance()

    def _draw(
        self,
        shown: tuple[View, ...],
        time_s: float,
        places: Places | None,
        *,
        is_plain: bool = False,
    ) -> dict[int, moderngl.Query]:
        """Draw every view and return what counts each eye's visible pixels.

        ``is_plain`` smooths edges by the mean of radiance, not for the tone curve. Reading a count
        waits for the GPU, so it comes last.
        """
        self.scene.crowd.light = self.scene.light  # another scene may have borrowed the crowd
        for eye, shares in enumerate(shares_of(self.spec, places)):
            if eye in self._drawn_eyes:
                self._eyes.use(eye, shares)
        if self._crowd_cube and any(
            detail.setting("reflection", "mode") == "dynamic"
            for eye in self._drawn_eyes
            for detail, _ in self._eyes.shares(eye)
        ):
            self._crowd_cube.render(time_s)
        self._picture.begin()
        queries: dict[int, moderngl.Query] = {}
        for view in shown:
            self._picture.use_rectangle(view.rectangle)
            queries |= self._passes.draw(view, time_s, wireframe=self.wireframe)
        tiles = self._picture.find_edges(shown)
        self._picture.use_rectangle((0, 0, *self._picture.size))
        for view, own in zip(shown, tiles, strict=True):
            self._passes.draw_background(view, own)
        for view, own in zip(shown, tiles, strict=True):
            self._passes.draw_outlines(view, self._picture.outlines, own, wireframe=self.wireframe)
        self._picture.smooth_edges(shown, tiles, is_plain=is_plain)
        for view in shown:
            self._picture.use_rectangle(view.rectangle)
            self._passes.draw_hair(view)
        return queries

    @property
    def eye_models(self) -> tuple[EyeModel, ...]:
        """Both eyes as they are drawn, the viewer's left, then right: what a scene exports."""
        return self._eyes.models

    def _make_crowd_cube(self) -> CrowdCube | None:
        sizes = [
            cube_px(detail, self.spec)
            for detail in details_of(self.spec)
            if detail.setting("reflection", "mode") == "dynamic"
        ]
        return self.scene.crowd_cube(self.gl, max(sizes)) if sizes else None
