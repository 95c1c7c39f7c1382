"""From which directions the open sky reaches a point: depth maps of the head from all around."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.body.makehuman import Floats
from renderer.head.sun_shadow import orthographic

DIRECTIONS: Final = 48
MAP_PX: Final = 384
DEPTH_MM: Final = 1500.0

Draw = Callable[[Floats], None]
Visible = npt.NDArray[np.float32]


def directions(count: int = DIRECTIONS) -> Floats:
    """Return (count, 3) unit vectors evenly over the sphere (Fibonacci's spiral)."""
    i = np.arange(count) + 0.5
    y = 1 - 2 * i / count
    angle = np.pi * (1 + 5**0.5) * i
    ring = np.sqrt(1 - y * y)
    return np.column_stack([ring * np.cos(angle), y, ring * np.sin(angle)])


class DepthProbe:
    """Draws depth maps and looks points up in them."""

    def __init__(self, gl: moderngl.Context, size_px: int = MAP_PX) -> None:
        self.gl = gl
        self._texture = gl.depth_texture((size_px, size_px))
        self._framebuffer = gl.framebuffer(depth_attachment=self._texture)
        self._size = size_px

    def depth(self, matrix: Floats, draw: Draw) -> Visible:
        """Return the depth map (size, size) float32, 0 near to 1 far, rows from below."""
        self._framebuffer.use()
        self._framebuffer.clear(depth=1.0)
        self.gl.enable_only(moderngl.DEPTH_TEST)
        draw(matrix)
        return np.frombuffer(self._texture.read(), dtype=np.float32).reshape(self._size, self._size)

    def release(self) -> None:
        """Give the maps back."""
        self._framebuffer.release()
        self._texture.release()


def look_up(depth: Visible, matrix: Floats, points_mm: Floats, *, radius_px: int = 1) -> Visible:
    """Return the share (n,) of the (2 r + 1)^2 texels around each point that do not cover it.

    Points outside the map are free.
    """
    clip = points_mm @ matrix[:3, :3].T + matrix[:3, 3]
    size = depth.shape[0]
    place = (clip[:, :2] * 0.5 + 0.5) * size - 0.5
    column, row = np.rint(place).astype(int).T
    far = clip[:, 2] * 0.5 + 0.5
    total = np.zeros(len(points_mm), dtype=np.float32)
    steps = range(-radius_px, radius_px + 1)
    for dy in steps:
        rows = np.clip(row + dy, 0, size - 1)
        for dx in steps:
            total += far <= depth[rows, np.clip(column + dx, 0, size - 1)]
    inside = (np.abs(clip) < 1.0).all(axis=1)
    return np.where(inside, total / (2 * radius_px + 1) ** 2, np.float32(1.0))


@dataclass(frozen=True)
class Region:
    """A cube of the head whose points share depth maps: its centre, half its edge, its meshes."""

    centre_mm: tuple[float, float, float]
    half_mm: float
    meshes: dict[str, tuple[Floats, Floats]]  # name -> points (n, 3) and normals (n, 3)

    def contains(self, points: Floats) -> npt.NDArray[np.bool_]:
        """Return which points (n, 3) lie well inside the cube."""
        away = np.abs(points - self.centre_mm)
        return np.asarray((away < 0.9 * self.half_mm).all(axis=1))


def sky_visibility(gl: moderngl.Context, draw: Draw, regions: list[Region]) -> dict[str, Visible]:
    """Return for each mesh by name how free (n, DIRECTIONS) the directions are, 0 to 1.

    A mesh may be named by several regions: the last that holds a point decides. Directions behind
    the surface count as closed. Points are lifted off their surface by a texel.
    """
    probe = DepthProbe(gl)
    names = {name: points for region in regions for name, (points, _) in region.meshes.items()}
    free = {
        name: np.zeros((len(points), DIRECTIONS), dtype=np.float32)
        for name, points in names.items()
    }
    for number, direction in enumerate(directions()):
        for region in regions:
            matrix = orthographic(
                direction, region.centre_mm, half_mm=region.half_mm, depth_mm=DEPTH_MM
            )
            depth = probe.depth(matrix, draw)
            texel = 2 * region.half_mm / MAP_PX
            for name, (points, normals) in region.meshes.items():
                cosine = normals @ direction
                front = (cosine > 0.0) & region.contains(points)
                lifted = points[front] + _lift(normals[front], cosine[front], direction) * texel
                free[name][front, number] = look_up(depth, matrix, lifted)
    probe.release()
    return free


def _lift(normals: Floats, cosine: Floats, direction: Floats) -> Floats:
    """Return by how many texels to lift points, more where light grazes."""
    slope = np.sqrt(1 - np.clip(cosine, 0.05, 1) ** 2) / np.clip(cosine, 0.2, 1)
    return np.asarray(normals + np.outer(0.8 + 1.2 * slope, direction))
