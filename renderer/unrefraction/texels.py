"""Which pixel of the photograph shows which texel of an iris's maps, and through what.

The maps' own coordinates (renderer.iris.maps): a square of 12 mm around the pupil, pupil of 2.0 mm
radius, row 0 the lowest. All arrays are float32 and (n, n).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.eye.anatomy import LIMBUS_RADIUS_MM
from renderer.eye.optics import fresnel, surface_normal, unit
from renderer.iris.maps import IRIS_RADIUS_MM, MAP_EDGE_MM, PUPIL_RADIUS_MM
from renderer.unrefraction.pose import Pose

Field = npt.NDArray[np.float32]
Array = npt.NDArray[np.float64]

KNOTS: Final = 193  # of the smooth map from plane to picture: 0.06 mm apart
ROOM_MM: Final = 6.2  # on the iris plane


@dataclass(frozen=True)
class Texels:
    """For every texel: its place on the maps, its pixel, the surface that it is seen through.

    ``radius_mm`` and ``angle`` are on the maps, ``x_px`` and ``y_px`` in the photograph,
    ``surface_mm`` the distance from the eye's axis of the corneal point in front of it, above and
    below scaled by the limbus's height (5.85 on the limbus), ``bearing`` that point's direction
    from the axis, ``transmitted`` the share of light that leaves the cornea towards the camera.
    Both angles are in radians from +x, anticlockwise.
    """

    radius_mm: Field
    angle: Field
    x_px: Field
    y_px: Field
    surface_mm: Field
    bearing: Field
    transmitted: Field


def place_texels(pose: Pose, size_px: int) -> Texels:
    """Follow the light of every texel through the cornea to the photograph.

    The rays are solved on a coarse grid and interpolated by cubic splines: they bend smoothly.
    """
    line = ((np.arange(size_px) + 0.5) / size_px * 2 - 1) * MAP_EDGE_MM
    x, y = np.meshgrid(line, line)
    radius = np.hypot(x, y)
    plane = _unstretched(x, y, radius, pose)
    knots = np.linspace(-ROOM_MM, ROOM_MM, KNOTS)
    grid = np.stack(np.meshgrid(knots, knots), axis=-1)
    entry = pose.entry(grid)
    pixels = pose.project(entry)
    cosine = np.sum(unit(pose.camera_mm - entry) * surface_normal(entry), axis=-1)
    above = entry[..., 1] / pose.height_ratio
    clear = np.hypot(entry[..., 0], above) < LIMBUS_RADIUS_MM + 0.3
    at = [np.clip((v + ROOM_MM) / (2 * ROOM_MM) * (KNOTS - 1), 0, KNOTS - 1) for v in plane[::-1]]

    def between(values: Array) -> Field:
        return np.asarray(
            ndimage.map_coordinates(values, at, order=3, mode="nearest"), dtype=np.float32
        )

    right_mm, up_mm = between(entry[..., 0]), between(above)
    return Texels(
        radius_mm=radius.astype(np.float32),
        angle=np.arctan2(y, x).astype(np.float32),
        x_px=between(pixels[..., 0]),
        y_px=between(pixels[..., 1]),
        surface_mm=np.hypot(right_mm, up_mm),
        bearing=np.arctan2(up_mm, right_mm),
        transmitted=between((1.0 - fresnel(cosine)) * clear),
    )


def _unstretched(x: Array, y: Array, radius: Array, pose: Pose) -> tuple[Array, Array]:
    """Return where texels lie on the true iris: its pupil is larger, smaller, off the centre.

    Tissue stretches evenly between the pupil's edge and the root (Pamplona et al. 2009).
    """
    outer = (IRIS_RADIUS_MM - pose.pupil_mm) / (IRIS_RADIUS_MM - PUPIL_RADIUS_MM)
    true = np.where(
        radius < PUPIL_RADIUS_MM,
        radius * (pose.pupil_mm / PUPIL_RADIUS_MM),
        pose.pupil_mm + (radius - PUPIL_RADIUS_MM) * outer,
    )
    scale = true / np.maximum(radius, 1e-9)
    off = np.clip((IRIS_RADIUS_MM - radius) / (IRIS_RADIUS_MM - PUPIL_RADIUS_MM), 0.0, 1.0)
    return x * scale + pose.pupil_x_mm * off, y * scale + pose.pupil_y_mm * off


def sample(pixels: Field, texels: Texels) -> Field:
    """Return a picture's linear colours (height, width, 3) at every texel, cubic."""
    at = [texels.y_px, texels.x_px]
    parts = [
        ndimage.map_coordinates(pixels[..., c], at, order=3, mode="nearest", output=np.float32)
        for c in range(3)
    ]
    return np.maximum(np.stack(parts, axis=-1), 0.0)
