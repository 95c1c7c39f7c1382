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
from renderer.crowd import GROUND_MM, Crowd
from renderer.cube import FACE_AXES, CubeTarget, Rectangle, face_view

Floats = npt.NDArray[np.float64]

NEAR_MM: Final = 150.0
FAR_MM: Final = 30000.0
LEVELS: Final = 4  # minified reflections read level 1 to 3; more would cost and show nothing
# Flesh and cloth around a joint: the farthest that a vertex lies from the joints it hangs on.
REACH_MM: Final = 260.0


class CrowdCube:
    """Draw the crowd around the eyes: ``render(time_s)``, then sample ``texture``."""

    def __init__(self, gl: moderngl.Context, size: int, crowd: Crowd) -> None:
        self.gl = gl
        self.size = size
        self.crowd = crowd
        levels = min(LEVELS, size.bit_length())
        self._cube = CubeTarget(gl, size, levels=levels, depth=True)
        self._projection = perspective(90.0, 1.0, NEAR_MM, FAR_MM)
        self._drawn: list[tuple[int, Rectangle]] = []
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
        joints = self.crowd.joints_mm()
        shadows = [self._on_ground(places) for places in joints]
        stale = list(self._drawn)
        self._drawn = []
        for face in range(6):
            bodies = self._touched(face, joints)
            grounds = self._touched(face, shadows)
            old = [rectangle for where, rectangle in stale if where == face]
            new = [*bodies.values(), *grounds.values()]
            if not old and not new:
                continue
            self._draw_face(face, bodies, grounds, clear=_union([*old, *new]))
            if new:
                self._drawn.append((face, _union(new)))
        self._cube.build_levels(_merge(stale, self._drawn))

    def _draw_face(
        self,
        face: int,
        bodies: dict[int, Rectangle],
        grounds: dict[int, Rectangle],
        *,
        clear: Rectangle,
    ) -> None:
        target = self._cube.attach(face)
        target.scissor = clear
        target.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
        view = face_view(face).astype(np.float32)
        self.gl.enable_only(moderngl.NOTHING)
        camera = {"view_matrix": view, "projection": self._projection}
        self.crowd.draw_shadows(list(grounds), **camera)
        self.gl.enable_only(moderngl.DEPTH_TEST)
        self.crowd.draw_figures(list(bodies), **camera, camera_mm=np.zeros(3))

    def _touched(self, face: int, places: list[Floats]) -> dict[int, Rectangle]:
        """Return which figures may touch a face, and where, by spheres around their joints."""
        return {
            number: bounds
            for number, points in enumerate(places)
            if (bounds := face_bounds(points, face, size=self.size)) is not None
        }

    def _on_ground(self, joints: Floats) -> Floats:
        """Slide joints along the sun's light on to the ground, as the shadow's shader does."""
        sun = self.crowd.light.sky.sun_direction
        fall = np.maximum(joints[:, 1] - GROUND_MM, 0.0) / max(float(sun[1]), 0.1)
        grounded = joints - fall[:, None] * sun
        grounded[:, 1] = GROUND_MM
        return grounded


def face_bounds(points: Floats, face: int, *, size: int) -> Rectangle | None:
    """Return the pixels of a face that spheres of REACH_MM around points may touch, or None."""
    right, down, forward = (points @ FACE_AXES[face]).T
    reach = REACH_MM
    # A sphere touches the face's pyramid only if it reaches over all four of its side planes.
    inside = (forward - np.abs(right) > -reach * 2**0.5) & (
        forward - np.abs(down) > -reach * 2**0.5
    )
    inside &= forward > -reach
    if not inside.any():
        return None
    low, high = [], []
    for across in (right[inside], down[inside]):
        near = np.maximum(forward[inside] - reach, NEAR_MM)
        far = forward[inside] + reach
        low.append(min(((across - reach) / near).min(), ((across - reach) / far).min()))
        high.append(max(((across + reach) / near).max(), ((across + reach) / far).max()))
    first = np.floor((np.clip(low, -1, 1) * 0.5 + 0.5) * size).astype(int)
    last = np.ceil((np.clip(high, -1, 1) * 0.5 + 0.5) * size).astype(int)
    width, height = (last - first).tolist()
    if width <= 0 or height <= 0:
        return None
    return int(first[0]), int(first[1]), width, height


def _union(rectangles: list[Rectangle]) -> Rectangle:
    boxes = np.array([[x, y, x + w, y + h] for x, y, w, h in rectangles])
    (left, low), (right, high) = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    return int(left), int(low), int(right - left), int(high - low)


def _merge(
    old: list[tuple[int, Rectangle]], new: list[tuple[int, Rectangle]]
) -> list[tuple[int, Rectangle]]:
    merged = []
    for face in range(6):
        found = [rectangle for where, rectangle in [*old, *new] if where == face]
        if found:
            merged.append((face, _union(found)))
    return merged
