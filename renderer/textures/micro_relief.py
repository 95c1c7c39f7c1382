"""The micro-relief of skin as a periodic height map: furrows, plateaus, pores. Pure numpy.

Knows millimetres, not faces. Sources: primary furrows 20 to 100 um deep that bound polygons, finer
secondary ones across them (Hashimoto 1974; Piérard et al. 2004); follicles of 0.1 to 0.3 mm.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

Field = npt.NDArray[np.float64]

NEIGHBOURS: Final = (-1, 0, 1)


@dataclass(frozen=True)
class Tile:
    """A periodic square: its edge in mm and in texels."""

    edge_mm: float
    edge_px: int

    @property
    def texel_mm(self) -> float:
        """Edge of a texel in mm."""
        return self.edge_mm / self.edge_px


@dataclass(frozen=True)
class Net:
    """Furrows between polygons: cells along x and y, depth and half width in mm.

    ``bend_mm`` lets the furrows wander; ``tilt`` is the slope of the plateaus (standard deviation).
    """

    cells: tuple[int, int]
    depth_mm: float
    width_mm: float
    bend_mm: float
    tilt: float


# Of the face: polygons of about 0.55 mm, crossed by a finer net of 0.26 mm.
FACE_NETS: Final = (
    Net(cells=(54, 62), depth_mm=0.015, width_mm=0.09, bend_mm=0.16, tilt=0.055),
    Net(cells=(112, 128), depth_mm=0.013, width_mm=0.055, bend_mm=0.08, tilt=0.05),
)


def relief(rng: np.random.Generator, tile: Tile, *, nets: tuple[Net, ...], pores: int) -> Field:
    """Return heights in mm (edge_px, edge_px), zero mean, with so many pores on the tile."""
    height = sum(net_relief(rng, tile, net) for net in nets)
    height = height + 0.0030 * periodic_noise(rng, tile, 0.06)
    height = height + 0.010 * periodic_noise(rng, tile, 0.45)
    height = blurred(height - 0.105 * pits(rng, tile, count=pores), tile, 0.022)
    return np.asarray(height - height.mean())


def net_relief(rng: np.random.Generator, tile: Tile, net: Net) -> Field:
    """Return the heights in mm of one net: tilted plateaus, furrows of uneven depth."""
    distance, plateau = _polygons(rng, tile, net)
    uneven = np.clip(1.0 + 0.4 * periodic_noise(rng, tile, 0.9), 0.2, 2.0)
    open_ground = 1.0 - np.exp(-distance / net.width_mm)
    return np.asarray(plateau * open_ground - net.depth_mm * uneven * (1.0 - open_ground))


def _polygons(rng: np.random.Generator, tile: Tile, net: Net) -> tuple[Field, Field]:
    """Return for each texel the way in mm to the nearest furrow and its plateau's height."""
    size = tile.edge_px
    columns, rows = net.cells
    point = rng.uniform(0.08, 0.92, (rows, columns, 2))
    tilt = rng.normal(0.0, net.tilt, (rows, columns, 2))
    edge = np.array([tile.edge_mm / columns, tile.edge_mm / rows])
    bend = [net.bend_mm * periodic_noise(rng, tile, 0.5) for _ in range(2)]
    grid_y, grid_x = np.indices((size, size)) * tile.texel_mm
    x, y = (grid_x + bend[0]) / edge[0], (grid_y + bend[1]) / edge[1]
    cell_x, cell_y = np.floor(x).astype(int), np.floor(y).astype(int)
    nearest, second = np.full((2, size, size), 9e9)
    plateau = np.zeros((size, size))
    for dy in NEIGHBOURS:
        for dx in NEIGHBOURS:
            at = ((cell_y + dy) % rows, (cell_x + dx) % columns)
            away_x = (x - cell_x - dx - point[at][..., 0]) * edge[0]
            away_y = (y - cell_y - dy - point[at][..., 1]) * edge[1]
            distance = np.hypot(away_x, away_y)
            own = distance < nearest
            second = np.where(own, nearest, np.minimum(second, distance))
            lean = tilt[at]
            plateau = np.where(own, lean[..., 0] * away_x + lean[..., 1] * away_y, plateau)
            nearest = np.minimum(nearest, distance)
    return (second - nearest) / 2, plateau


def pits(rng: np.random.Generator, tile: Tile, *, count: int) -> Field:
    """Return pores as depths 0 to about 1: pits of 0.1 to 0.3 mm, no two close to each other."""
    rows = max(1, int(np.sqrt(count)))
    columns = max(1, round(count / rows))
    cell = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 2)
    place = (cell + rng.uniform(0.1, 0.9, cell.shape)) / [columns, rows] * tile.edge_px
    # Most pores are fine; a few are wide and deep.
    largeness = rng.beta(1.2, 4.0, len(place))
    radius = (0.045 + 0.11 * largeness) / tile.texel_mm
    depth = 0.15 + 0.85 * largeness
    squash = rng.uniform(0.65, 1.0, len(place))
    angle = rng.uniform(0, np.pi, len(place))
    reach = np.arange(-12, 13)
    field = np.zeros((tile.edge_px, tile.edge_px))
    for (x, y), r, d, s, a in zip(place, radius, depth, squash, angle, strict=True):
        dx, dy = reach[None, :] + int(x) - x, reach[:, None] + int(y) - y
        along, across = dx * np.cos(a) + dy * np.sin(a), dy * np.cos(a) - dx * np.sin(a)
        d2 = (along / r) ** 2 + (across / (r * s)) ** 2
        rows_, columns_ = (int(y) + reach) % tile.edge_px, (int(x) + reach) % tile.edge_px
        field[np.ix_(rows_, columns_)] += d * np.exp(-d2)
    return np.minimum(field, 1.2)


def slopes(height_mm: Field, tile: Tile) -> tuple[Field, Field]:
    """Return the slopes d height / dx and d height / dy of a periodic height map."""
    x, y = (
        (np.roll(height_mm, -1, axis) - np.roll(height_mm, 1, axis)) / (2 * tile.texel_mm)
        for axis in (1, 0)
    )
    return x, y


def openness(height_mm: Field, tile: Tile, *, reach_mm: float, depth_mm: float) -> Field:
    """Return how open to light each texel lies, 0 to 1: 0 where ``depth_mm`` below its vicinity."""
    below = blurred(height_mm, tile, reach_mm) - height_mm
    return np.asarray(np.clip(1.0 - np.maximum(below, 0.0) / depth_mm, 0.0, 1.0))


def periodic_noise(rng: np.random.Generator, tile: Tile, size_mm: float) -> Field:
    """Return periodic noise of zero mean and unit variance with features of about ``size_mm``."""
    noise = blurred(rng.standard_normal((tile.edge_px, tile.edge_px)), tile, size_mm)
    return np.asarray((noise - noise.mean()) / noise.std())


def blurred(field: Field, tile: Tile, size_mm: float) -> Field:
    """Blur periodically by a Gaussian of standard deviation ``size_mm``."""
    fy = np.fft.fftfreq(tile.edge_px)[:, None]
    fx = np.fft.rfftfreq(tile.edge_px)[None, :]
    sigma = size_mm / tile.texel_mm
    gain = np.exp(-2 * (np.pi * sigma) ** 2 * (fx * fx + fy * fy))
    return np.asarray(np.fft.irfft2(np.fft.rfft2(field) * gain, s=field.shape))
