"""A panorama of the horizon as a canvas, and how a tree and a house are painted on it.

Pure numpy. Each texel keeps what is there (albedo, coverage), how it lies (normal) and how open it
is to the sky, not how it looks: the shader lights it, so one bake serves every sun.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float32]

WIDTH: Final = 4096  # texels around the horizon: 11.4 per degree, twice what a cornea can show
HEIGHT: Final = 640
LOWEST_DEG: Final = -6.0  # elevation of the lowest row's edge
STEP_DEG: Final = 360.0 / WIDTH
EYE_HEIGHT_M: Final = 1.62  # above the ground: the viewpoint of every map
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


@dataclass(frozen=True)
class Building:
    """One facade that faces the viewer, with floors of windows and a pitched roof."""

    azimuth_deg: float
    distance_m: float
    width_m: float
    floors: int
    wall: tuple[float, float, float]
    roof: tuple[float, float, float]


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
    window, u, v = _window(azimuth, elevation, half_width=radius, half_height=radius)
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
    normal = _to_world(local, azimuth) * openness
    albedo = leaf * picked[..., 1:]
    mask = picked[..., 0] * (u**2 + v**2 < radius**2)
    panorama.paint(window, mask.astype(np.float32), albedo=albedo, normal=normal)


def _paint_trunk(panorama: Panorama, tree: Tree, *, top_m: float) -> None:
    half = math.degrees(0.022 * tree.height_m / tree.distance_m)
    bottom = math.degrees(math.atan2(-EYE_HEIGHT_M, tree.distance_m))
    top = math.degrees(math.atan2(top_m - EYE_HEIGHT_M, tree.distance_m))
    window, u, v = _window(
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
        normal=_to_world(local, tree.azimuth_deg) * 0.8,
    )


def paint_building(panorama: Panorama, building: Building, rng: np.random.Generator) -> None:
    """Paint one facade: plinth, rows of framed windows, cornice and a pitched roof."""
    eaves = building.floors * 3.3 + 1.0
    ridge = eaves + 3.4
    half_width = math.degrees(math.atan2(building.width_m / 2, building.distance_m))
    low = math.degrees(math.atan2(-EYE_HEIGHT_M, building.distance_m))
    high = math.degrees(math.atan2(ridge - EYE_HEIGHT_M, building.distance_m))
    window, u, v = _window(
        building.azimuth_deg, (low + high) / 2, half_width=half_width, half_height=(high - low) / 2
    )
    along = np.tan(np.radians(u)) * building.distance_m  # metres on the facade
    reach = building.distance_m / np.cos(np.radians(u))
    up = np.tan(np.radians(v + (low + high) / 2)) * reach + EYE_HEIGHT_M
    bay, floor = along / 2.6, (up - 1.0) / 3.3
    across, rise = bay - np.floor(bay), floor - np.floor(floor)
    is_wall = up < eaves
    frame = is_wall & (np.abs(across - 0.5) < 0.27) & (np.abs(rise - 0.52) < 0.33) & (floor > 0)
    pane = frame & (np.abs(across - 0.5) < 0.22) & (np.abs(rise - 0.52) < 0.29)
    pane &= (np.abs(across - 0.5) > 0.018) & (np.abs(rise - 0.62) > 0.012)
    hash_of_window = np.sin(
        np.floor(bay) * 12.9898 + np.floor(floor) * 78.233 + building.azimuth_deg
    )
    curtain = pane & (hash_of_window > 0.45)
    albedo = np.where(is_wall[..., None], building.wall, building.roof).astype(np.float32)
    albedo *= (1 - 0.25 * (np.abs(up - eaves) < 0.18))[..., None]
    albedo[frame] = 0.66, 0.65, 0.62
    albedo[pane] = 0.025, 0.028, 0.03
    albedo[curtain] = 0.30, 0.29, 0.27
    albedo *= rng.uniform(0.95, 1.05, (1, 1, 1)).astype(np.float32)
    local = np.zeros((*u.shape, 3))
    local[..., 2] = 1.0
    local[~is_wall] = 0.0, 0.6, 0.8
    openness = np.clip(0.55 + 0.05 * up, 0.5, 0.9)[..., None]
    slope = np.clip((ridge - up) / 0.1, 0, 1)
    mask = np.clip((building.width_m / 2 - np.abs(along)) / 0.1, 0, 1) * slope
    normal = _to_world(local, building.azimuth_deg) * openness
    panorama.paint(
        window, mask.astype(np.float32), albedo=albedo, normal=normal, glass=pane.astype(np.float32)
    )


def _window(
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


def _to_world(local: npt.NDArray[np.floating], azimuth_deg: float) -> Array:
    """Turn normals from a facing frame (right, up, towards the viewer) to world space."""
    angle = math.radians(azimuth_deg)
    right = np.array([math.cos(angle), 0.0, -math.sin(angle)])
    towards = -np.array([math.sin(angle), 0.0, math.cos(angle)])
    world = local[..., :1] * right + local[..., 1:2] * [0.0, 1.0, 0.0] + local[..., 2:] * towards
    return np.asarray(world, dtype=np.float32)
