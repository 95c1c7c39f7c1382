"""Single frames from anywhere, with their counters: what a person sees who looks into the scene.

The thesis's demonstration (chapter 3): a camera that follows mouse and keys, counters of time and
triangles, and the whole scene from above. Participants never see any of it.
"""

from __future__ import annotations

import json
import time
from collections import OrderedDict
from dataclasses import dataclass, replace
from typing import Final

from renderer.camera import IRIS_PX, iris_px, radius_of_px, views
from renderer.clip import ClipSpec
from renderer.detail import LEVELS, Detail
from renderer.frame.frame import FrameRenderer
from renderer.frame.picture import Pixels
from renderer.gl.context import is_software
from renderer.lod.path import Places, Shares, places_of_view, shares_of
from renderer.overhead import overhead_view, reach_mm
from renderer.studio import Studio
from renderer.view import View

KEPT_RENDERERS: Final = 4  # the last ones stay, so that a key goes there and back quickly
BOTH: Final = (0, 1)


@dataclass(frozen=True, kw_only=True)
class Viewpoint:
    """Where the camera is and when: angles in degrees, distance as ``iris_px`` on 1080 lines."""

    azimuth_deg: float = 0.0
    elevation_deg: float = 0.0
    distance_px: float = 350.0
    time_s: float = 0.0
    eyes: tuple[int, ...] = BOTH
    wireframe: bool = False


@dataclass(frozen=True, kw_only=True)
class Shot:
    """A frame and what it took.

    ``pixels`` (height, width, 3) uint8 sRGB; ``frame_ms`` until the finished frame was there, on a
    GPU its own clock; ``triangles`` of everything drawn, all passes, outlines too; ``iris_px`` and
    ``visible_px`` per eye, left and right, the same for wire frames; ``lods`` what each eye is
    drawn with.
    """

    pixels: Pixels
    frame_ms: float
    triangles: int
    iris_px: tuple[float, float]
    visible_px: tuple[int, int]
    lods: tuple[str, str]


class Inspector:
    """Draw one frame at a time, in the thread that the studio's GL context belongs to."""

    def __init__(self, studio: Studio) -> None:
        self._studio = studio
        self._is_software = is_software(self._studio.gl_renderer)
        self._kept: OrderedDict[str, FrameRenderer] = OrderedDict()

    @property
    def gl_renderer(self) -> str:
        """The name of what draws."""
        return self._studio.gl_renderer

    def shot(self, spec: ClipSpec, viewpoint: Viewpoint) -> Shot:
        """Draw the eyes of a clip from a viewpoint."""
        renderer = self._renderer(at_least_as_sharp(spec, viewpoint.distance_px), viewpoint.eyes)
        shown = views(
            spec,
            viewpoint.azimuth_deg,
            viewpoint.elevation_deg,
            distance_px=viewpoint.distance_px,
            eyes=viewpoint.eyes,
        )
        renderer.wireframe = False
        if not viewpoint.wireframe:
            return self._draw(renderer, shown, viewpoint)
        # Lines cover few pixels: what is seen of an eye is counted on the eye itself.
        seen = renderer.render_views(shown, places=_places(renderer, viewpoint)).visible_px
        renderer.wireframe = True
        return replace(self._draw(renderer, shown, viewpoint), visible_px=seen)

    def overhead(self, spec: ClipSpec, viewpoint: Viewpoint) -> Shot:
        """Draw the whole scene from above, everybody in it, at the viewpoint's time.

        Clips leave out the walker and the waver, who are there for the eyes to mirror.
        """
        above = overhead_view(spec, reach_mm=reach_mm(radius_of_px(viewpoint.distance_px)))
        renderer = self._renderer(spec, BOTH)
        renderer.wireframe = False
        crowd = renderer.scene.crowd
        crowd.shows_everybody = True
        try:
            return self._draw(renderer, (above,), viewpoint)
        finally:
            crowd.shows_everybody = False

    def close(self) -> None:
        """Give the context back."""
        self._kept.clear()
        self._studio.close()

    def _draw(self, renderer: FrameRenderer, shown: tuple[View, ...], viewpoint: Viewpoint) -> Shot:
        spec, gl = renderer.spec, self._studio.gl
        places = _places(renderer, viewpoint)
        counted = gl.query(time=True, primitives=True)
        gl.finish()
        started = time.perf_counter()
        with counted:
            frame = renderer.render_views(shown, time_s=viewpoint.time_s, places=places)
        wall_ms = (time.perf_counter() - started) * 1e3
        shares = shares_of(spec, places)
        sizes = iris_px(spec, viewpoint.azimuth_deg, distance_px=viewpoint.distance_px)
        return Shot(
            pixels=frame.pixels,
            frame_ms=wall_ms if self._is_software else int(counted.elapsed) / 1e6,
            triangles=int(counted.primitives),
            iris_px=(round(sizes[0], 1), round(sizes[1], 1)),
            visible_px=frame.visible_px,
            lods=(_named(shares[0]), _named(shares[1])),
        )

    def _renderer(self, spec: ClipSpec, eyes: tuple[int, ...]) -> FrameRenderer:
        key = json.dumps([spec.clip_id, eyes])
        if key not in self._kept:
            self._kept[key] = self._studio.renderer(spec, eyes=eyes)
            if len(self._kept) > KEPT_RENDERERS:
                self._kept.popitem(last=False)
        self._kept.move_to_end(key)
        return self._kept[key]


def at_least_as_sharp(spec: ClipSpec, distance_px: float) -> ClipSpec:
    """Return a clip whose cubes are large enough from a viewpoint.

    "auto" cubes are made for the clip's own distance and blur nearer than that: they give way to
    those of the LoD's own size.
    """
    if spec.cube_size == "auto" and distance_px > IRIS_PX[spec.distance]:
        return replace(spec, cube_size="table")
    return spec


def _places(renderer: FrameRenderer, viewpoint: Viewpoint) -> Places | None:
    """Return where eyes that switch stand between a policy's steps."""
    return places_of_view(renderer.spec, viewpoint.azimuth_deg, distance_px=viewpoint.distance_px)


def _named(shares: Shares) -> str:
    """Return what an eye is drawn with, such as "medium" or "medium 25 %, high 75 %"."""
    known = {Detail.uniform(lod): lod for lod in LEVELS}
    names = [(known.get(detail, "own levels"), share) for detail, share in shares]
    if len(names) == 1:
        return names[0][0]
    return ", ".join(f"{name} {share:.0%}".replace("%", " %") for name, share in names)
