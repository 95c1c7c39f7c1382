"""The iris as a flat picture of its reflectance: what its light between cornea and iris depends on.

Pure numpy; the steps of ``shaders/texture.glsl`` without relief. Also the iris of the path tracer's
twin.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.eye.anatomy import IRIS_MAP_RADIUS_MM, MAP_PUPIL_RADIUS_MM
from renderer.eye.caustics import MAP_EDGE_MM
from renderer.iris.maps import IrisMaps

Array = npt.NDArray[np.float64]

PUPIL_EDGE_MM: Final = 0.06  # width of the pupil's soft edge, as the shader draws it


def flat_iris(
    maps: IrisMaps,
    pupil_mm: float,
    *,
    size_px: int,
    half_mm: float = MAP_EDGE_MM,
    mirror: float = 1.0,
) -> Array:
    """Return the reflectance (size_px, size_px, 3) over a square of the iris plane, row 0 lowest.

    Cavities count as darker colour: what is flat cannot shade itself. Black in the pupil, the
    root's colour beyond it. ``mirror`` -1 is the viewer's right eye.
    """
    colour = np.asarray(maps.albedo * maps.cavity[..., None], dtype=np.float64)
    x, y = plane_points(size_px, half_mm)
    radius = np.hypot(x, y)
    mapped = map_radius(radius, pupil_mm / 2) / np.maximum(radius, 1e-9)
    map_px = len(colour)
    at = np.stack([y, mirror * x]) * mapped * (map_px / (2 * MAP_EDGE_MM)) + (map_px - 1) / 2
    drawn = [
        ndimage.map_coordinates(channel, at, order=1, mode="nearest")
        for channel in np.moveaxis(colour, -1, 0)
    ]
    edge = np.clip((radius - pupil_mm / 2) / PUPIL_EDGE_MM + 0.5, 0.0, 1.0)
    outside = edge * edge * (3.0 - 2.0 * edge)
    return np.stack(drawn, axis=-1) * outside[..., None]


def map_radius(radius_mm: Array, pupil_radius_mm: float) -> Array:
    """Return the maps' radius for a radius on the plane: tissue stretches evenly to the root."""
    width = IRIS_MAP_RADIUS_MM - pupil_radius_mm
    stretch = (IRIS_MAP_RADIUS_MM - MAP_PUPIL_RADIUS_MM) / width
    beyond = np.minimum(radius_mm, IRIS_MAP_RADIUS_MM) - pupil_radius_mm
    return np.where(
        radius_mm < pupil_radius_mm,
        radius_mm * MAP_PUPIL_RADIUS_MM / pupil_radius_mm,
        MAP_PUPIL_RADIUS_MM + beyond * stretch,
    )


def plane_points(size_px: int, half_mm: float) -> tuple[Array, Array]:
    """Return x and y (size_px, size_px) in mm of texels over the iris plane, row 0 lowest."""
    axis = ((np.arange(size_px) + 0.5) / size_px * 2 - 1) * half_mm
    x, y = np.meshgrid(axis, axis)
    return x, y
