"""The dynamic cube map: the moving people as the main character's eyes see them, every frame.

Centred midway between the eyes. Radiance is premultiplied by coverage, so the reflection is this
cube over the static one. Software GL clears and draws only the rectangles that people or their
shadows touch, now or in the frame before; on a GPU Python would take longer to tell them than
faces take to draw whole.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.crowd.crowd import Crowd
from renderer.crowd.cube_tiles import TILES, Bools, cover, touched
from renderer.crowd.stage import GROUND_MM
from renderer.gl.context import chooses_parts
from renderer.gl.uniforms import constant
from renderer.park.cube_faces import face_view
from renderer.park.cube_target import CubeTarget, Rectangle
from renderer.view import perspective

Floats = npt.NDArray[np.float64]

NEAR_MM: Final = 150.0
FAR_MM: Final = 30000.0
LEVELS: Final = 5  # a 350-pixel iris reads about every eleventh texel of 2048
FACE_VIEWS: Final = tuple(constant(face_view(face)) for face in range(6))
_PROJECTION: Final = constant(perspective(90.0, 1.0, NEAR_MM, FAR_MM))
_CENTRE_MM: Final = constant(np.zeros(3))
_SOLID: Final = moderngl.DEPTH_TEST | moderngl.CULL_FACE


@dataclass(frozen=True)
class _FaceDraw:
    """Who is seen on a face, who casts a shadow there, and what of it is cleared (None: all)."""

    face: int
    seen: list[int]
    cast: list[int]
    clear: list[Rectangle] | None = None


class CrowdCube:
    """Draw the crowd around the eyes: ``render(time_s)``, then sample ``texture``."""

    def __init__(self, gl: moderngl.Context, size: int, crowd: Crowd) -> None:
        self.gl = gl
        self.size = size
        self.crowd = crowd
        self._cube = CubeTarget(gl, size, levels=min(LEVELS, size.bit_length()), depth=True)
        self._chooses = chooses_parts(gl)
        self._drawn = np.zeros((6, TILES, TILES), dtype=bool)
        for face in range(6):
            self._cube.attach(face).clear(0.0, 0.0, 0.0, 0.0)
        self._cube.build_levels()

    @property
    def texture(self) -> moderngl.TextureCube:
        """RGBA16F: radiance premultiplied by coverage, and coverage, with LEVELS levels."""
        return self._cube.texture

    def render(self, time_s: float) -> None:
        """Draw everybody at a scene time; binds targets of its own and leaves them bound."""
        if not self.crowd.figures:
            return
        self.crowd.pose(time_s)
        draws = self._chosen_draws() if self._chooses else self._all_draws()
        self.crowd.skin(sorted({number for draw in draws for number in (*draw.seen, *draw.cast)}))
        self.crowd.meshes.light(self.crowd.light, projection=_PROJECTION, camera_mm=_CENTRE_MM)
        self.crowd.shadows.light(self.crowd.light.sky, projection=_PROJECTION)
        self.gl.enable_only(moderngl.NOTHING)
        for draw in draws:
            self._draw(draw)
        self._cube.build_levels([(draw.face, part) for draw in draws for part in draw.clear or ()])

    def _draw(self, draw: _FaceDraw) -> None:
        target = self._cube.attach(draw.face)
        for viewport in [None] if draw.clear is None else draw.clear:
            target.clear(0.0, 0.0, 0.0, 0.0, depth=1.0, viewport=viewport)
        view = FACE_VIEWS[draw.face]
        self.gl.disable(_SOLID)
        self.crowd.shadows.draw(draw.cast, view_matrix=view)
        self.gl.enable(_SOLID)
        self.crowd.meshes.draw(draw.seen, view_matrix=view)

    def _all_draws(self) -> list[_FaceDraw]:
        everybody = list(range(len(self.crowd.figures)))
        return [_FaceDraw(face, everybody, everybody) for face in range(6)]

    def _chosen_draws(self) -> list[_FaceDraw]:
        """Return what to draw of each face that people or shadows touch, or did."""
        bounds = self.crowd.bounds_mm()
        points, reach_mm = bounds.centres_mm, bounds.reach_mm
        grounded, shape = on_ground(points, self.crowd.light.sky.sun_direction)
        seen = touched(points, reach_mm, near_mm=NEAR_MM)
        cast = touched(grounded, reach_mm, near_mm=NEAR_MM, shape=shape)
        stale, self._drawn = self._drawn, seen.tiles | cast.tiles
        changed = stale | self._drawn
        who = np.logical_or.reduceat([seen.bodies, cast.bodies], bounds.firsts, axis=2)
        draws = []
        for face in np.flatnonzero(changed.any(axis=(1, 2))).tolist():
            numbers, casting = (np.flatnonzero(own).tolist() for own in who[:, face])
            draws.append(_FaceDraw(face, numbers, casting, self._rectangles(changed[face])))
        return draws

    def _rectangles(self, tiles: Bools) -> list[Rectangle]:
        side = self.size / TILES
        return [
            (round(x * side), round(y * side), round(width * side), round(height * side))
            for x, y, width, height in cover(tiles)
        ]


def on_ground(points: Floats, sun_direction: Floats) -> tuple[Floats, Floats]:
    """Slide points (n, 3) along the sun's light on to the ground, as the shadow's shader does.

    Returns them and the matrix (3, 3) that carries what lies around a point there.
    """
    slide = np.eye(3)
    slide[:, 1] -= sun_direction / max(float(sun_direction[1]), 0.1)
    slide[1] = 0.0
    heights = np.maximum(points[:, 1] - GROUND_MM, 0.0)
    grounded = points * [1.0, 0.0, 1.0] + heights[:, None] * slide[:, 1]
    grounded[:, 1] = GROUND_MM
    return grounded, slide
