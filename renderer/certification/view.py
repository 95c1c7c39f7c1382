"""One picture to certify: where the camera stands, and which part of the eye each pixel shows.

Pure numpy. Eye space (the globe's centre is the origin; the gaze runs along +z of the world).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.camera import camera_radius_mm
from renderer.eye.anatomy import CORNEA_IOR, GLOBE_RADIUS_MM, LIMBUS_Z_MM, PROFILE_END_MM
from renderer.eye.optics import (
    cornea_share,
    refract,
    surface_height,
    surface_normal,
    to_iris_plane,
)
from renderer.view import Matrix, look_at, perspective

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

TARGET_MM: Final = np.array([0.0, 0.0, LIMBUS_Z_MM])  # the middle of every picture
HALF_MM: Final = 8.6  # half the picture's side at the eye: the iris and the white between the lids
ROOT_MM: Final = 5.5  # from here on the iris fades into the limbus


@dataclass(frozen=True)
class View:
    """A square picture of ``size_px`` from ``azimuth_deg`` at the macroscopic distance."""

    size_px: int
    azimuth_deg: float = 0.0

    @property
    def camera_mm(self) -> Array:
        """The camera in eye space."""
        turn = math.radians(self.azimuth_deg)
        radius = camera_radius_mm("macroscopic")
        return radius * np.array([math.sin(turn), 0.0, math.cos(turn)])

    @property
    def fov_deg(self) -> float:
        """The field of view, the same both ways."""
        distance = float(np.linalg.norm(self.camera_mm - TARGET_MM))
        return 2 * math.degrees(math.atan(HALF_MM / distance))

    @property
    def projection(self) -> Matrix:
        """OpenGL's projection."""
        radius = camera_radius_mm("macroscopic")
        return perspective(self.fov_deg, 1.0, 0.5 * radius, 2 * radius)

    def rays(self) -> Array:
        """Return the unit directions (n, n, 3) through the pixels' centres, first row on top."""
        scale = math.tan(math.radians(self.fov_deg) / 2)
        axis = ((np.arange(self.size_px) + 0.5) / self.size_px * 2 - 1) * scale
        x, y = np.meshgrid(axis, -axis)
        local = np.stack([x, y, -np.ones_like(x)], axis=-1)
        turned = local @ look_at(self.camera_mm, TARGET_MM)[:3, :3].astype(np.float64)
        return np.asarray(turned / np.linalg.norm(turned, axis=-1, keepdims=True))


def regions(view: View, pupil_mm: float) -> dict[str, Mask]:
    """Mark the pixels (n, n) of iris (between pupil and root), limbus, sclera, and all of them."""
    rays = view.rays()
    hit, meets = front_hit(view.camera_mm, rays)
    normal = surface_normal(hit)
    clear = np.where(hit[..., 2] > 0.0, cornea_share(hit), 0.0)
    bent = refract(rays, normal, ior_ratio=1 / CORNEA_IOR)
    landing = np.hypot(*np.moveaxis(to_iris_plane(hit, bent), -1, 0))
    # The back of the globe lies in the head: it is not drawn.
    faces = meets & (np.sum(normal * rays, axis=-1) < 0.0) & (hit[..., 2] > 0.0)
    faces = np.asarray(ndimage.binary_erosion(faces, border_value=1))  # pixels half outside
    in_iris = faces & (clear > 0.5) & (landing < ROOT_MM) & (landing > pupil_mm / 2)
    in_sclera = faces & (clear < 0.02)
    in_pupil = faces & (clear > 0.5) & (landing <= pupil_mm / 2)
    return {
        "iris": in_iris,
        "limbus": faces & ~in_iris & ~in_sclera & ~in_pupil,
        "sclera": in_sclera,
        "whole eye": faces,
    }


def front_hit(camera_mm: Array, rays: Array) -> tuple[Array, Mask]:
    """Return where rays (n, n, 3) meet the eye's front surface, and whether they do.

    Small steps from a sphere around the eye to the way's nearest point to its centre, then halves.
    """
    middle = -np.sum(camera_mm * rays, axis=-1)
    closest2 = np.sum(camera_mm**2) - middle**2
    near = middle - np.sqrt(np.maximum((GLOBE_RADIUS_MM + 1.1) ** 2 - closest2, 0.0))
    far = middle
    steps = np.linspace(0.0, 1.0, 129)[:, None, None]
    outside = np.stack(
        [_excess(camera_mm + t[..., None] * rays) for t in near + steps * (far - near)]
    )
    inside = outside < 0.0
    meets = np.asarray(inside.any(axis=0))
    first = np.argmax(inside, axis=0)
    high = near + first / 128 * (far - near)
    low = high - (far - near) / 128
    for _ in range(30):
        half = 0.5 * (low + high)
        is_in = _excess(camera_mm + half[..., None] * rays) < 0.0
        low, high = np.where(is_in, low, half), np.where(is_in, half, high)
    return camera_mm + high[..., None] * rays, meets


def _excess(points: Array) -> Array:
    """Return how far points lie outside the eye: negative within."""
    r = np.hypot(points[..., 0], points[..., 1])
    height, _ = surface_height(np.minimum(r, PROFILE_END_MM))
    globe = np.linalg.norm(points, axis=-1) - GLOBE_RADIUS_MM
    return np.where((points[..., 2] > 0.0) & (r < PROFILE_END_MM), points[..., 2] - height, globe)
