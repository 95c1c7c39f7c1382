"""Light of the surroundings on the iris, seen from within the anterior chamber. Pure numpy.

From a point of the iris, rays are followed back through the cornea into the open: the radiance that
comes down a ray is n^2 (1 - F) times the radiance outside (Nicodemus). Lids that stand in the way
show their own skin. What the cornea keeps inside it mirrors back to the iris, totally where rays
meet it at a slant, and the iris lights itself. The result is smooth, so a small map per clip and
eye holds it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from renderer.eye.anatomy import CORNEA_IOR, IRIS_Z_MM, LIMBUS_RADIUS_MM
from renderer.eye.caustics import MAP_EDGE_MM
from renderer.eye.lids import LidRims
from renderer.eye.optics import (
    cornea_from_inside,
    cornea_share,
    fresnel,
    refract,
    surface_normal,
    to_iris_plane,
)

Array = npt.NDArray[np.float64]
Radiance = Callable[[Array], Array]  # of unit directions (n, 3) in world space, (n, 3)

LID_FRONT_MM: Final = 13.4  # radius of the lids' middle surface, which rays pass or hit
LID_SOFTNESS_MM: Final = 0.5
LID_SOFTENING: Final = 0.12  # per mm of way: grazing rays meet lashes and a rounded edge
LID_REFLECTANCE: Final = (0.38, 0.24, 0.18)  # skin, linear Rec. 709
_ANGLES: Final = (24, 48)  # polar and azimuthal directions of the hemisphere
_HITS: Final = 3  # of a ray on the cornea: those from the root creep along it
_BOUNCES: Final = 3  # of light between iris and cornea; a fourth adds less than 0.1 %


@dataclass(frozen=True)
class Window:
    """What the points of a map of the iris plane see through the cornea.

    Rays that leave: their point of the map (n,), where and in which direction they leave, (n, 3),
    and their share of all rays of the point (n,). ``mirror`` (points, points) is the share of the
    light that leaves each point of the iris, evenly to all sides, and comes back to another.
    """

    point: npt.NDArray[np.intp]
    exit_mm: Array
    outside: Array
    transmitted: Array
    mirror: Array


def chamber_irradiance(
    surroundings: Radiance,
    eye_to_world: Array,
    *,
    rims: LidRims | None,
    albedo: Array | None = None,
    size_px: int = 32,
) -> npt.NDArray[np.float32]:
    """Return the surroundings' irradiance on the iris plane, (size_px, size_px, 3) float32.

    ``eye_to_world`` is the eye's rotation (3, 3). The square is that of the caustic map. Without
    ``rims`` nothing shades the cornea. ``albedo`` (size_px, size_px, 3) is what the iris sends back
    to the cornea, which returns some of it; None is a black iris.
    """
    window = chamber_window(size_px)
    radiance = np.maximum(surroundings(window.outside @ eye_to_world.T), 0.0)
    if rims is not None:
        openness = lid_openness(window.exit_mm, window.outside, rims)[:, None]
        radiance = openness * radiance + (1.0 - openness) * _skin_radiance(surroundings)
    scale = CORNEA_IOR**2 * math.pi
    direct = scale * np.stack(
        [
            np.bincount(window.point, window.transmitted * channel, minlength=size_px**2)
            for channel in radiance.T
        ],
        axis=-1,
    )
    total = direct
    if albedo is not None:
        for _ in range(_BOUNCES):
            total = direct + window.mirror @ (albedo.reshape(-1, 3) * total)
    return total.reshape(size_px, size_px, 3).astype(np.float32)


@lru_cache(maxsize=2)
def chamber_window(size_px: int) -> Window:
    """Follow cosine-distributed rays from a map's points to the cornea, through it and back.

    The cornea is round, so rays are followed for each distance from the axis and turned.
    """
    points = _map_points(size_px)
    distances, number = np.unique(np.round(np.hypot(*points.T), 6), return_inverse=True)
    turn = np.arctan2(points[:, 1], points[:, 0])
    rays = math.prod(_ANGLES)
    point = np.broadcast_to(np.arange(len(points))[:, None], (len(points), rays))
    weight = np.full((len(points), rays), 1.0 / rays)
    mirror = np.zeros((len(points), len(points)))
    exits: list[tuple[npt.NDArray[Any], ...]] = []
    for hit in _follow(distances.astype(np.float64)):
        exit_mm = _turned(hit.exit_mm[number], turn)
        # The tissue over the limbus takes what meets it, from without and from within.
        weight = weight * np.nan_to_num(cornea_share(exit_mm))
        out = weight * (1.0 - hit.reflectance[number])
        leaves = out > 1e-4 / rays
        outside = _turned(hit.outside[number], turn)
        exits.append((point[leaves], exit_mm[leaves], outside[leaves], out[leaves]))
        weight = weight * hit.reflectance[number]
        lands = np.isfinite(hit.landing_mm[number, :, 0]) & (weight > 1e-4 / rays)
        landing = _turned(hit.landing_mm[number], turn)[lands]
        mirror += _spread(point[lands], landing, weight=weight[lands], size_px=size_px)
        weight = np.where(np.isfinite(hit.landing_mm[number, :, 0]), 0.0, weight)
    points_out, exit_mm, outside, out = (
        np.concatenate(parts) for parts in zip(*exits, strict=True)
    )
    return Window(points_out, exit_mm, outside, out, mirror)


@dataclass(frozen=True)
class _Hit:
    """Where rays meet the cornea from within: (distances, rays, ...), NaN where there is none.

    ``landing_mm`` is where the mirrored ray comes down on the iris plane; NaN if it meets the
    cornea again first.
    """

    exit_mm: Array
    outside: Array
    reflectance: Array
    landing_mm: Array


def _follow(distances: Array) -> Iterator[_Hit]:
    """Follow rays from points (distance, 0) of the iris plane along the cornea."""
    inside = np.broadcast_to(_hemisphere(*_ANGLES), (len(distances), math.prod(_ANGLES), 3))
    start = np.zeros_like(inside)
    start[..., 0], start[..., 2] = distances[:, None], IRIS_Z_MM
    for _ in range(_HITS):
        hit = cornea_from_inside(start, inside)
        normal = surface_normal(hit)
        cosine = np.sum(inside * normal, axis=-1)
        mirrored = inside - 2.0 * cosine[..., None] * normal
        comes_down = np.where(mirrored[..., 2:] < -1e-3, mirrored, np.nan)
        yield _Hit(
            hit,
            refract(inside, -normal, ior_ratio=CORNEA_IOR),
            fresnel(cosine, ior=1.0 / CORNEA_IOR),
            to_iris_plane(hit, comes_down),
        )
        start, inside = hit, mirrored


def _turned(vectors: Array, turn: Array) -> Array:
    """Turn vectors (n, rays, 2 or 3) about the axis by ``turn`` (n,) radians."""
    c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
    x, y = vectors[..., 0], vectors[..., 1]
    return np.concatenate(
        [np.stack([c * x - s * y, s * x + c * y], axis=-1), vectors[..., 2:]], axis=-1
    )


def _spread(
    point: npt.NDArray[np.intp], landing_mm: Array, *, weight: Array, size_px: int
) -> Array:
    """Return the weights between points and the map's texels where rays land, bilinear (n, n)."""
    texel = (landing_mm + MAP_EDGE_MM) * (size_px / (2 * MAP_EDGE_MM)) - 0.5
    base = np.floor(texel)
    share = texel - base
    total = np.zeros(size_px**4)
    for dx, dy in ((0, 0), (1, 0), (0, 1), (1, 1)):
        column, row = base[:, 0].astype(np.intp) + dx, base[:, 1].astype(np.intp) + dy
        part = np.abs(1 - dx - share[:, 0]) * np.abs(1 - dy - share[:, 1]) * weight
        part *= (column >= 0) & (column < size_px) & (row >= 0) & (row < size_px)
        texel_index = np.clip(row, 0, size_px - 1) * size_px + np.clip(column, 0, size_px - 1)
        total += np.bincount(point * size_px**2 + texel_index, part, minlength=size_px**4)
    return total.reshape(size_px**2, size_px**2)


def _map_points(size_px: int) -> Array:
    """Return the map's points (n, 2) in mm; outside the limbus the nearest one stands in.

    So bilinear fetches stay smooth there.
    """
    axis = (np.arange(size_px) + 0.5) / size_px * 2 * MAP_EDGE_MM - MAP_EDGE_MM
    plane = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    distance = np.hypot(*plane.T)
    plane *= np.minimum(1.0, 0.97 * LIMBUS_RADIUS_MM / np.maximum(distance, 1e-9))[:, None]
    return plane


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


def _skin_radiance(surroundings: Radiance) -> Array:
    """Return what a lid leaves of the mean ambient light; half of its sky is hidden."""
    front = _hemisphere(16, 32)
    # Cosine-weighted directions of one half stand for it evenly after dividing by the cosine.
    weight = 1.0 / np.concatenate([front[:, 2], front[:, 2]])
    around = surroundings(np.concatenate([front, -front]))
    mean_radiance = np.average(around, axis=0, weights=weight)
    return np.asarray(0.5 * np.asarray(LID_REFLECTANCE) * mean_radiance)
