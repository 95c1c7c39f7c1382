"""Trees and shrubs on the panorama: a trunk, then clumps of leaves. Pure numpy."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.park.panorama import (
    EYE_HEIGHT_M,
    STEP_DEG,
    Array,
    Panorama,
    texels_around,
    to_world,
)

_STAMP_PX: Final = 48


@dataclass(frozen=True)
class Tree:
    """One tree by its place (azimuth, distance), size and leaf colour (linear Rec. 709)."""

    azimuth_deg: float
    distance_m: float
    height_m: float
    crown_m: float
    leaf: tuple[float, float, float]
    clumps: int


def leaf_stamps(rng: np.random.Generator, count: int = 6) -> Array:
    """Return clumps of leaves, (count, size, size, 2): coverage and brightness of each leaf."""
    size = _STAMP_PX
    y, x = np.mgrid[0:size, 0:size].astype(np.float32) / (size - 1) * 2 - 1
    stamps = np.zeros((count, size, size, 2), np.float32)
    for stamp in stamps:
        for _ in range(70):
            radius = 0.82 * math.sqrt(rng.uniform())
            turn, tilt = rng.uniform(0, 2 * math.pi, 2)
            u, v = x - radius * math.cos(turn), y - radius * math.sin(turn)
            along = u * math.cos(tilt) + v * math.sin(tilt)
            across = v * math.cos(tilt) - u * math.sin(tilt)
            leaf = (along / 0.17) ** 2 + (across / 0.085) ** 2 < 1
            stamp[leaf] = 1.0, rng.uniform(0.65, 1.35)
    return stamps


def paint_tree(panorama: Panorama, tree: Tree, *, rng: np.random.Generator, stamps: Array) -> None:
    """Paint trunk, then clumps of leaves from back to front."""
    trunk_top = tree.height_m * 0.45 if tree.height_m > 4 else 0.0  # shrubs grow from the ground
    if trunk_top > 0:
        _paint_trunk(panorama, tree, top_m=trunk_top)
    # Clumps fill an ellipsoid whose shell is denser than its core, as light makes crowns grow.
    places = rng.normal(size=(tree.clumps, 3))
    places /= np.linalg.norm(places, axis=1, keepdims=True)
    places *= rng.uniform(0.25, 1.0, (tree.clumps, 1)) ** 0.45
    half_height = (tree.height_m - trunk_top * 0.62) / 2
    lift = tree.height_m - half_height
    lumps = 1 + 0.16 * np.sin(places @ rng.normal(size=(3, 3)) * 2.6).sum(axis=1, keepdims=True)
    offsets = places * lumps * [tree.crown_m, half_height, tree.crown_m]
    order = np.argsort(offsets[:, 2])
    sizes = rng.uniform(0.13, 0.24, tree.clumps) * tree.crown_m
    picks = rng.integers(len(stamps), size=tree.clumps)
    shades = rng.uniform(0.8, 1.2, tree.clumps)
    for clump in order:
        x, y, z = offsets[clump]
        depth = tree.distance_m - z
        azimuth = tree.azimuth_deg + math.degrees(x / depth)
        elevation = math.degrees(math.atan2(lift + y - EYE_HEIGHT_M, depth))
        radius = math.degrees(sizes[clump] / depth)
        inside = float(np.linalg.norm(places[clump]))
        openness = np.clip(0.35 + 0.5 * inside + 0.3 * y / half_height, 0.2, 1.0)
        _paint_clump(
            panorama,
            (azimuth, elevation, radius),
            stamp=stamps[picks[clump]],
            leaf=np.asarray(tree.leaf, np.float32) * np.float32(shades[clump]),
            crown=places[clump],
            openness=float(openness),
        )


def _paint_clump(
    panorama: Panorama,
    place: tuple[float, float, float],
    *,
    stamp: Array,
    leaf: Array,
    crown: npt.NDArray[np.float64],
    openness: float,
) -> None:
    azimuth, elevation, radius = place
    window, u, v = texels_around(azimuth, elevation, half_width=radius, half_height=radius)
    if u.size == 0:
        return
    last = _STAMP_PX - 1
    picked = stamp[
        np.clip(((v / radius + 1) / 2 * last).round().astype(int), 0, last),
        np.clip(((u / radius + 1) / 2 * last).round().astype(int), 0, last),
    ]
    depth = np.sqrt(np.clip(1 - (u / radius) ** 2 - (v / radius) ** 2, 0.0, 1.0))
    ball = np.stack([u / radius, v / radius, depth], axis=-1)
    local = 0.45 * ball + 0.75 * crown
    local /= np.linalg.norm(local, axis=-1, keepdims=True) + 1e-6
    normal = to_world(local, azimuth) * openness
    albedo = leaf * picked[..., 1:]
    mask = picked[..., 0] * (u**2 + v**2 < radius**2)
    panorama.paint(window, mask.astype(np.float32), albedo=albedo, normal=normal)


def _paint_trunk(panorama: Panorama, tree: Tree, *, top_m: float) -> None:
    half = math.degrees(0.022 * tree.height_m / tree.distance_m)
    bottom = math.degrees(math.atan2(-EYE_HEIGHT_M, tree.distance_m))
    top = math.degrees(math.atan2(top_m - EYE_HEIGHT_M, tree.distance_m))
    window, u, v = texels_around(
        tree.azimuth_deg, (top + bottom) / 2, half_width=half * 1.6, half_height=(top - bottom) / 2
    )
    width = half * (1.25 - 0.5 * (v / (top - bottom) + 0.5))
    mask = np.clip((width - np.abs(u)) / STEP_DEG + 0.5, 0, 1)
    across = np.clip(u / width, -1, 1)
    local = np.stack([across, 0 * across, np.sqrt(1 - across**2)], axis=-1)
    bark = (
        np.array([0.17, 0.135, 0.105], np.float32)
        * (0.85 + 0.3 * np.sin(u * 90 + v * 7))[..., None]
    )
    panorama.paint(
        window,
        mask.astype(np.float32),
        albedo=bark,
        normal=to_world(local, tree.azimuth_deg) * 0.8,
    )
