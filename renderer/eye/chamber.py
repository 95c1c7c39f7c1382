"""Light of the surroundings on the iris, seen from within the anterior chamber. Pure numpy.

From a point of the iris, rays are followed back through the cornea into the open: the radiance that
comes down a ray is n^2 (1 - F) times the radiance outside (Nicodemus). Lids that stand in the way
show their own skin. The result is smooth, so a small map per clip and eye holds it.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.eye.anatomy import CORNEA_IOR, IRIS_Z_MM, LIMBUS_RADIUS_MM
from renderer.eye.caustics import MAP_EDGE_MM
from renderer.eye.lids import LidRims
from renderer.eye.optics import conic_normal, cornea_from_inside, fresnel, refract
from renderer.spherical_harmonics import sh_basis

Array = npt.NDArray[np.float64]

LID_FRONT_MM: Final = 13.4  # radius of the lids' middle surface, which rays pass or hit
LID_SOFTNESS_MM: Final = 0.5
LID_SOFTENING: Final = 0.12  # per mm of way: grazing rays meet lashes and a rounded edge
LID_REFLECTANCE: Final = (0.38, 0.24, 0.18)  # skin, linear Rec. 709
_ANGLES: Final = (24, 48)  # polar and azimuthal directions of the hemisphere


def chamber_irradiance(
    ambient_sh: Array, eye_to_world: Array, *, rims: LidRims | None, size_px: int = 32
) -> npt.NDArray[np.float32]:
    """Return the surroundings' irradiance on the iris plane, (size_px, size_px, 3) float32.

    ``ambient_sh`` (9, 3) is in world space, ``eye_to_world`` the eye's rotation (3, 3). The square
    is that of the caustic map. Without ``rims`` nothing shades the cornea.
    """
    axis = (np.arange(size_px) + 0.5) / size_px * 2 * MAP_EDGE_MM - MAP_EDGE_MM
    plane = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    # Outside the limbus the nearest point inside stands in: bilinear fetches stay smooth.
    distance = np.hypot(*plane.T)
    plane *= np.minimum(1.0, 0.97 * LIMBUS_RADIUS_MM / np.maximum(distance, 1e-9))[:, None]
    skin = _skin_radiance(ambient_sh)

    def irradiance(point: Array) -> Array:
        hit, outside, transmitted = _rays_outside(point)
        radiance = np.maximum(sh_basis(outside @ eye_to_world.T) @ ambient_sh, 0.0)
        if rims is not None:
            openness = lid_openness(hit, outside, rims)[:, None]
            radiance = openness * radiance + (1.0 - openness) * skin
        return np.asarray(transmitted @ radiance)

    rows = [irradiance(point) for point in plane]
    scale = CORNEA_IOR**2 * math.pi / (_ANGLES[0] * _ANGLES[1])
    return (scale * np.asarray(rows)).reshape(size_px, size_px, 3).astype(np.float32)


def _rays_outside(point: Array) -> tuple[Array, Array, Array]:
    """Follow cosine-distributed rays from a point of the iris plane out of the cornea.

    Returns where they leave and in which direction, (n, 3) each, and their transmittance (n,).
    """
    directions = _hemisphere(*_ANGLES)
    hit = cornea_from_inside(
        np.broadcast_to(np.append(point, IRIS_Z_MM), directions.shape), directions
    )
    through = np.isfinite(hit[:, 0])
    hit, normal = hit[through], conic_normal(hit[through])
    outside = refract(directions[through], -normal, ior_ratio=CORNEA_IOR)
    escapes = np.isfinite(outside[:, 0])
    hit, normal, outside = hit[escapes], normal[escapes], outside[escapes]
    return hit, outside, 1.0 - fresnel(np.sum(outside * normal, axis=-1))


def _hemisphere(polar: int, azimuthal: int) -> Array:
    """Return directions (n, 3) that share a hemisphere's cosine-weighted solid angle equally."""
    sine2 = (np.arange(polar) + 0.5) / polar
    turn = 2 * math.pi * (np.arange(azimuthal) + 0.5) / azimuthal
    sine2_grid, turn_grid = (grid.ravel() for grid in np.meshgrid(sine2, turn, indexing="ij"))
    sine = np.sqrt(sine2_grid)
    return np.column_stack(
        [sine * np.cos(turn_grid), sine * np.sin(turn_grid), np.sqrt(1.0 - sine2_grid)]
    )


def lid_openness(points: Array, directions: Array, rims: LidRims) -> Array:
    """Return how freely rays (n, 3) leave the lids' opening: 1 open, 0 on a lid.

    ``shaders/lids.glsl`` has the same rule: the ray is followed to the lids' middle surface and
    compared with the rims there.
    """
    along = np.sum(points * directions, axis=-1)
    excess = np.sum(points**2, axis=-1) - LID_FRONT_MM**2
    reach = np.maximum(-along + np.sqrt(np.maximum(along**2 - excess, 0.0)), 0.0)
    at = points + reach[:, None] * directions
    upper = np.interp(at[:, 0], rims.upper_mm[:, 0], rims.upper_mm[:, 1])
    lower = np.interp(at[:, 0], rims.lower_mm[:, 0], rims.lower_mm[:, 1])
    room = np.minimum(upper - at[:, 1], at[:, 1] - lower)
    softness = LID_SOFTNESS_MM + LID_SOFTENING * reach
    share = np.clip(0.5 + room / (2 * softness), 0.0, 1.0)
    return np.asarray(share * share * (3.0 - 2.0 * share))


def _skin_radiance(ambient_sh: Array) -> Array:
    """Return what a lid leaves of the mean ambient light; half of its sky is hidden."""
    mean_radiance = 0.282095 * ambient_sh[0]
    return np.asarray(0.5 * np.asarray(LID_REFLECTANCE) * mean_radiance)
