"""The dynamic cube map: the moving people as the main character's eyes see them, every frame.

Centred midway between the eyes. Radiance is premultiplied by coverage, so the reflection is this
cube over the static one. Only the rectangles that people or their shadows touch, now or in the
frame before, are cleared and drawn.
"""

from __future__ import annotations

from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.camera import perspective
from renderer.crowd.crowd import Crowd
from renderer.crowd.stage import GROUND_MM
from renderer.park.cube_faces import FACE_AXES, face_view
from renderer.park.cube_target import CubeTarget, Rectangle

Floats = npt.NDArray[np.float64]
Tiles = npt.NDArray[np.bool_]

NEAR_MM: Final = 150.0
FAR_MM: Final = 30000.0
LEVELS: Final = 5  # a 350-pixel iris reads about every eleventh texel of 2048
TILES: Final = 16  # a face is cleared and halved in tiles, 16 x 16 of them


class CrowdCube:
    """Draw the crowd around the eyes: ``render(time_s)``, then sample ``texture``."""

    def __init__(self, gl: moderngl.Context, size: int, crowd: Crowd) -> None:
        self.gl = gl
        self.size = size
        self.crowd = crowd
        self._cube = CubeTarget(gl, size, levels=min(LEVELS, size.bit_length()), depth=True)
        self._projection = perspective(90.0, 1.0, NEAR_MM, FAR_MM)
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
        self.crowd.pose(time_s)
        bodies = self.crowd.bounds_mm()
        if not bodies and not self._drawn.any():
            return
        owners = np.repeat(np.arange(len(bodies)), [len(reach) for _, reach in bodies])
        points = np.concatenate([np.zeros((0, 3)), *(centres for centres, _ in bodies)])
        reach_mm = np.concatenate([np.zeros(0), *(reach for _, reach in bodies)])
        on_ground = self._on_ground(points)
        stale, self._drawn = self._drawn, np.zeros_like(self._drawn)
        changed: list[tuple[int, Rectangle]] = []
        for face in range(6):
            seen = tiles_of_each(points, reach_mm, face, owners=owners, count=len(bodies))
            cast = tiles_of_each(on_ground, reach_mm, face, owners=owners, count=len(bodies))
            self._drawn[face] = (seen | cast).any(axis=0)
            rectangles = self._rectangles(stale[face] | self._drawn[face])
            changed += [(face, rectangle) for rectangle in rectangles]
            if rectangles:
                self._draw_face(face, rectangles, seen=_present(seen), cast=_present(cast))
        self._cube.build_levels(changed)

    def _draw_face(
        self, face: int, clear: list[Rectangle], *, seen: list[int], cast: list[int]
    ) -> None:
        target = self._cube.attach(face)
        for rectangle in clear:
            target.scissor = rectangle
            target.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
        target.scissor = (0, 0, self.size, self.size)
        view = face_view(face).astype(np.float32)
        self.gl.enable_only(moderngl.NOTHING)
        self.crowd.draw_shadows(cast, view_matrix=view, projection=self._projection)
        self.gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self.crowd.draw_figures(
            seen, view_matrix=view, projection=self._projection, camera_mm=np.zeros(3)
        )

    def _rectangles(self, tiles: Tiles) -> list[Rectangle]:
        side = self.size / TILES
        return [
            (round(x * side), round(y * side), round(width * side), round(height * side))
            for x, y, width, height in cover(tiles)
        ]

    def _on_ground(self, points: Floats) -> Floats:
        """Slide points along the sun's light on to the ground, as the shadow's shader does."""
        sun = self.crowd.light.sky.sun_direction
        fall = np.maximum(points[:, 1] - GROUND_MM, 0.0) / max(float(sun[1]), 0.1)
        grounded = points - fall[:, None] * sun
        grounded[:, 1] = GROUND_MM
        return np.asarray(grounded)


def touched_tiles(points: Floats, reach_mm: Floats, face: int) -> Tiles:
    """Return which tiles (row, column) of a face spheres around points (n, 3) may touch."""
    owners = np.zeros(len(points), dtype=np.int64)
    return np.asarray(tiles_of_each(points, reach_mm, face, owners=owners, count=1)[0])


def tiles_of_each(
    points: Floats, reach_mm: Floats, face: int, *, owners: npt.NDArray[np.int64], count: int
) -> Tiles:
    """Return which tiles (owner, row, column) of a face the spheres of each owner may touch."""
    right, down, forward = (points @ FACE_AXES[face]).T
    # A sphere touches the face's pyramid only if it reaches over all four of its side planes.
    slack = reach_mm * 2**0.5
    inside = (forward - np.abs(right) > -slack) & (forward - np.abs(down) > -slack)
    inside &= forward > NEAR_MM - reach_mm
    near = np.maximum(forward - reach_mm, NEAR_MM)[inside]
    far = np.maximum(forward + reach_mm, NEAR_MM)[inside]
    low, high = [], []
    for across in (right[inside], down[inside]):
        start, end = across - reach_mm[inside], across + reach_mm[inside]
        low.append(np.minimum(start / near, start / far))
        high.append(np.maximum(end / near, end / far))
    left, bottom = np.floor((np.clip(low, -1, 1) * 0.5 + 0.5) * TILES).astype(int)
    end_x, end_y = np.ceil((np.clip(high, -1, 1) * 0.5 + 0.5) * TILES).astype(int)
    # Rectangles are summed up from their corners: steps in at one end, out at the other.
    steps = np.zeros((count, TILES + 1, TILES + 1), dtype=np.int64)
    owner = owners[inside]
    for y, x, step in (
        (bottom, left, 1),
        (bottom, end_x, -1),
        (end_y, left, -1),
        (end_y, end_x, 1),
    ):
        np.add.at(steps, (owner, y, x), step)
    return np.asarray(steps.cumsum(axis=1).cumsum(axis=2)[:, :TILES, :TILES] > 0)


def cover(tiles: Tiles) -> list[Rectangle]:
    """Return disjoint rectangles (x, y, width, height) in tiles that cover the true ones."""
    left = tiles.copy()
    found: list[Rectangle] = []
    for y, x in np.argwhere(tiles).tolist():
        if not left[y, x]:
            continue
        width = height = 1
        while x + width < left.shape[1] and left[y, x + width]:
            width += 1
        while y + height < left.shape[0] and left[y + height, x : x + width].all():
            height += 1
        left[y : y + height, x : x + width] = False
        found.append((x, y, width, height))
    return found


def _present(tiles: Tiles) -> list[int]:
    return [int(number) for number in np.flatnonzero(tiles.any(axis=(1, 2)))]
