"""The park's horizon: which trees, shrubs and houses stand where. Pure numpy.

Painted from far to near on a panorama; the same seed gives the same bytes.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from renderer.park.buildings import Building, paint_building
from renderer.park.panorama import Panorama
from renderer.park.trees import Tree, leaf_stamps, paint_tree


def park_skyline(seed: int = 7) -> dict[str, npt.NDArray[np.uint8]]:
    """Return ``albedo`` and ``shape`` of the park's horizon, (HEIGHT, WIDTH, 4) uint8.

    Columns run from azimuth -180 to 180 degrees, rows upwards from LOWEST_DEG. Colours are linear,
    stored as square roots; normals times openness are stored around 0.5.
    """
    rng = np.random.Generator(np.random.PCG64(seed))
    panorama = Panorama()
    stamps = leaf_stamps(rng)
    things: list[Tree | Building] = [*_town(rng), *_wood(rng)]
    for thing in sorted(things, key=lambda thing: -thing.distance_m):
        if isinstance(thing, Building):
            paint_building(panorama, thing, rng)
        else:
            paint_tree(panorama, thing, rng=rng, stamps=stamps)
    albedo = np.concatenate(
        [np.sqrt(np.clip(panorama.albedo[..., :3], 0, 1)), panorama.albedo[..., 3:]], axis=-1
    )
    shape = np.concatenate([panorama.shape[..., :3] * 0.5 + 0.5, panorama.shape[..., 3:]], axis=-1)
    return {
        "albedo": (np.clip(albedo, 0, 1) * 255 + 0.5).astype(np.uint8),
        "shape": (np.clip(shape, 0, 1) * 255 + 0.5).astype(np.uint8),
    }


def _town(rng: np.random.Generator) -> list[Building]:
    """Rows of houses: before the face to both sides of an open view, and a few behind."""
    walls = [(0.52, 0.46, 0.37), (0.42, 0.24, 0.17), (0.62, 0.59, 0.53), (0.46, 0.42, 0.40)]
    roofs = [(0.16, 0.07, 0.05), (0.10, 0.10, 0.11), (0.19, 0.10, 0.07)]
    houses = []
    for start, end, distance in ((-68.0, -26.0, 68.0), (18.0, 62.0, 85.0), (150.0, 196.0, 190.0)):
        azimuth = start
        while azimuth < end:
            width = float(rng.uniform(13, 22))
            turn = math.degrees(width / distance)
            houses.append(
                Building(
                    azimuth + turn / 2,
                    distance * float(rng.uniform(0.97, 1.03)),
                    width,
                    int(rng.integers(3, 6)),
                    walls[int(rng.integers(len(walls)))],
                    roofs[int(rng.integers(len(roofs)))],
                )
            )
            azimuth += turn * 0.985  # neighbours overlap, so that no sky shows between
    return houses


def _wood(rng: np.random.Generator) -> list[Tree]:
    """A belt of trees around the lawn, denser behind the face, and a few close ones."""
    trees = []
    for azimuth in np.arange(-180.0, 180.0, 4.2):
        is_behind = abs(azimuth) > 100
        if not is_behind and rng.uniform() < 0.45:
            continue
        height = float(rng.uniform(7, 13))
        distance = float(rng.uniform(55, 90) if is_behind else rng.uniform(48, 80))
        trees.append(_tree(rng, azimuth + rng.uniform(-1.5, 1.5), distance=distance, height=height))
    for azimuth in np.concatenate([np.arange(95.0, 265.0, 1.9), np.arange(-88.0, 88.0, 5.3)]):
        trees.append(_shrub(rng, azimuth + rng.uniform(-0.8, 0.8)))
    close = (
        (-101, 19, 13), (-79, 26, 12), (-50, 40, 11), (8, 46, 10), (44, 34, 12), (74, 21, 13),
        (90, 32, 12), (107, 24, 14), (-140, 30, 13), (-168, 44, 12), (164, 38, 12), (143, 42, 11),
    )  # fmt: skip
    for azimuth, distance, height in close:
        trees.append(_tree(rng, azimuth, distance=distance, height=height))
    return trees


def _tree(rng: np.random.Generator, azimuth: float, *, distance: float, height: float) -> Tree:
    greens = np.array([[0.095, 0.170, 0.040], [0.135, 0.185, 0.045], [0.070, 0.135, 0.045]])
    leaf = greens[int(rng.integers(3))] * rng.uniform(0.85, 1.2)
    clumps = int(np.clip(9000 / distance, 110, 420))
    crown = height * float(rng.uniform(0.30, 0.40))
    return Tree(float(azimuth), distance, height, crown, (leaf[0], leaf[1], leaf[2]), clumps)


def _shrub(rng: np.random.Generator, azimuth: float) -> Tree:
    height = float(rng.uniform(1.6, 3.4))
    leaf = np.array([0.085, 0.135, 0.040]) * rng.uniform(0.8, 1.35)
    colour = (leaf[0], leaf[1], leaf[2])
    return Tree(float(azimuth), float(rng.uniform(44, 62)), height, height * 0.75, colour, 60)
