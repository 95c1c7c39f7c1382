"""The head's depth as the sun sees it: the shadow that falls on skin and eyes."""

from __future__ import annotations

from typing import Final, Protocol

import moderngl
import numpy as np

from renderer.body.makehuman import Floats
from renderer.light import Light, Sky, Vector

MAP_PX: Final = 2048
CENTRE_MM: Final = (0.0, -5.0, -45.0)  # the head's middle
REACH_MM: Final = 150.0  # half the map's edge: head and collar; 0.15 mm a texel
DEPTH_MM: Final = 400.0
# Pushes the map's depth away from lit surfaces: slope-scaled, in units of glPolygonOffset.
OFFSET: Final = (1.5, 2.0)


class Occluder(Protocol):
    """What can draw itself into a depth map."""

    def draw_depth(self, matrix: Floats) -> None:
        """Draw with a world-to-clip matrix."""


def build_light(gl: moderngl.Context, sky: Sky, head: Occluder) -> Light:
    """Draw the head's sun shadow map and return the light that eyes, skin and crowd share."""
    matrix = orthographic(sky.sun_direction, CENTRE_MM, half_mm=REACH_MM, depth_mm=DEPTH_MM)
    depth = gl.depth_texture((MAP_PX, MAP_PX))
    depth.compare_func = ""
    depth.filter = (moderngl.NEAREST, moderngl.NEAREST)
    framebuffer = gl.framebuffer(depth_attachment=depth)
    framebuffer.use()
    framebuffer.clear(depth=1.0)
    gl.enable_only(moderngl.DEPTH_TEST)
    gl.polygon_offset = OFFSET
    head.draw_depth(matrix)
    gl.polygon_offset = (0.0, 0.0)
    framebuffer.release()
    return Light(sky, depth, matrix.astype(np.float32))


def orthographic(
    direction: Vector, centre_mm: tuple[float, float, float], *, half_mm: float, depth_mm: float
) -> Floats:
    """Return the world-to-clip matrix of a parallel view against ``direction`` (unit vector).

    The square of ``2 half_mm`` lies around ``centre_mm``; depth runs over ``2 depth_mm``, points
    nearer to the light have smaller depth.
    """
    back = np.asarray(direction, dtype=float)
    side = np.cross([0.0, 1.0, 0.0] if abs(back[1]) < 0.99 else [0.0, 0.0, 1.0], back)
    side /= np.linalg.norm(side)
    up = np.cross(back, side)
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack([side / half_mm, up / half_mm, -back / depth_mm])
    matrix[:3, 3] = -matrix[:3, :3] @ np.asarray(centre_mm)
    return matrix
