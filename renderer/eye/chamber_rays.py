"""Rays from the iris through the cornea: where they leave, and where those it keeps come down.

The cornea mirrors what it keeps, totally where rays meet it at a slant. This depends on the eye's
anatomy alone, on no clip. Pure numpy.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from renderer.eye.anatomy import CORNEA_IOR, IRIS_Z_MM, LIMBUS_RADIUS_MM
from renderer.eye.caustics import MAP_EDGE_MM
from renderer.eye.optics import (
    cornea_from_inside,
    cornea_share,
    fresnel,
    refract,
    surface_normal,
    to_iris_plane,
)

Array = npt.NDArray[np.float64]

_ANGLES: Final = (24, 48)  # polar and azimuthal directions of the hemisphere
_HITS: Final = 3  # of a ray on the cornea: those from the root creep along it


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
    inside = np.broadcast_to(hemisphere(*_ANGLES), (len(distances), math.prod(_ANGLES), 3))
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


def hemisphere(polar: int, azimuthal: int) -> Array:
    """Return directions (n, 3) that share a hemisphere's cosine-weighted solid angle equally."""
    sine2 = (np.arange(polar) + 0.5) / polar
    turn = 2 * math.pi * (np.arange(azimuthal) + 0.5) / azimuthal
    sine2_grid, turn_grid = (grid.ravel() for grid in np.meshgrid(sine2, turn, indexing="ij"))
    sine = np.sqrt(sine2_grid)
    return np.column_stack(
        [sine * np.cos(turn_grid), sine * np.sin(turn_grid), np.sqrt(1.0 - sine2_grid)]
    )
