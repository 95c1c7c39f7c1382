"""A panorama of the horizon as a canvas: its grid, and how a surface is laid on it.

Pure numpy. Each texel keeps what is there (albedo, coverage), how it lies (normal) and how open it
is to the sky, not how it looks: the shader lights it, so one bake serves every sun.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float32]

WIDTH: Final = 4096  # texels around the horizon: 11.4 per degree, twice what a cornea can show
HEIGHT: Final = 640
LOWEST_DEG: Final = -6.0  # elevation of the lowest row's edge
STEP_DEG: Final = 360.0 / WIDTH
EYE_HEIGHT_M: Final = 1.62  # above the ground: the viewpoint of every map


class Panorama:
    """The canvas: ``albedo`` (rows, columns, 4) with coverage, ``shape`` (rows, columns, 4).

    ``shape`` holds the world normal times openness, and in its last channel the share of glass.
    """

    def __init__(self) -> None:
        self.albedo = np.zeros((HEIGHT, WIDTH, 4), np.float32)
        self.shape = np.zeros((HEIGHT, WIDTH, 4), np.float32)

    def paint(
        self,
        window: tuple[slice, npt.NDArray[np.int64]],
        mask: Array,
        *,
        albedo: Array,
        normal: Array,
        glass: Array | float = 0.0,
    ) -> None:
        """Lay a surface over what is there; ``window`` names its rows and wrapped columns."""
        rows, columns = window
        weight = mask[..., None]
        for canvas, values in ((self.albedo, albedo), (self.shape, normal)):
            patch = canvas[rows, columns]
            patch[..., :3] += (values - patch[..., :3]) * weight
            last = 1.0 if canvas is self.albedo else glass
            patch[..., 3] += (last - patch[..., 3]) * mask
            canvas[rows, columns] = patch


def texels_around(
    azimuth_deg: float, elevation_deg: float, *, half_width: float, half_height: float
) -> tuple[tuple[slice, npt.NDArray[np.int64]], Array, Array]:
    """Return the texels around a direction and their offsets from it in degrees."""
    row = (elevation_deg - LOWEST_DEG) / STEP_DEG
    column = (azimuth_deg + 180.0) / STEP_DEG
    first = max(0, math.floor(row - half_height / STEP_DEG))
    last = min(HEIGHT, math.ceil(row + half_height / STEP_DEG) + 1)
    left = math.floor(column - half_width / STEP_DEG)
    columns = np.arange(left, math.ceil(column + half_width / STEP_DEG) + 1)
    rows = np.arange(first, max(first, last))
    u = (columns + 0.5 - column) * STEP_DEG
    v = (rows + 0.5 - row) * STEP_DEG
    grid_v, grid_u = np.meshgrid(v.astype(np.float32), u.astype(np.float32), indexing="ij")
    return (slice(first, max(first, last)), columns % WIDTH), grid_u, grid_v


def to_world(local: npt.NDArray[np.floating], azimuth_deg: float) -> Array:
    """Turn normals from a facing frame (right, up, towards the viewer) to world space."""
    angle = math.radians(azimuth_deg)
    right = np.array([math.cos(angle), 0.0, -math.sin(angle)])
    towards = -np.array([math.sin(angle), 0.0, math.cos(angle)])
    world = local[..., :1] * right + local[..., 1:2] * [0.0, 1.0, 0.0] + local[..., 2:] * towards
    return np.asarray(world, dtype=np.float32)
