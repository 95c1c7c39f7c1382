"""Deterministic noise from an integer hash: the same bytes for the same seed, on any thread count.

Knows nothing of eyes. Every value is a smooth cubic B-spline over a lattice of hashed numbers, so a
field has no BLAS call and no generator whose state could depend on the order of evaluation.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy import ndimage

Field = npt.NDArray[np.float32]
Integers = npt.NDArray[np.integer]

# A cubic B-spline over independent uniform values has this standard deviation on average; dividing
# by it makes amplitudes comparable (1-D factor: sum of squared weights averaged over a cell).
_UNIFORM_STD = float(np.sqrt(1.0 / 3.0))
_AXIS_GAIN = float(np.sqrt(151.0 / 315.0))


def hash_lattice(x: Integers, y: Integers, seed: int) -> Field:
    """Return a hashed number in [-1, 1) for each pair of integers (PCG output permutation).

    Jarzynski and Olano 2020, "Hash functions for GPU rendering", pcg; applied once per word.
    """
    state = np.asarray(seed & 0xFFFFFFFF, np.uint32)
    for word in (x, y):
        state = (state + np.asarray(word).astype(np.uint32)) * np.uint32(747796405) + np.uint32(
            2891336453
        )
        mixed = ((state >> ((state >> np.uint32(28)) + np.uint32(4))) ^ state) * np.uint32(
            277803737
        )
        state = (mixed >> np.uint32(22)) ^ mixed
    return (state >> np.uint32(8)).astype(np.float32) * np.float32(2.0**-23) - np.float32(1.0)


def spline_weights(t: Field) -> list[Field]:
    """Return the four cubic B-spline weights at the fraction ``t`` of a cell."""
    u = np.float32(1.0) - t
    sixth = np.float32(1.0 / 6.0)
    return [
        u * u * u * sixth,
        (np.float32(3.0) * t * t * t - np.float32(6.0) * t * t + np.float32(4.0)) * sixth,
        (np.float32(3.0) * u * u * u - np.float32(6.0) * u * u + np.float32(4.0)) * sixth,
        t * t * t * sixth,
    ]


def noise_1d(line: Integers, x: Field, seed: int) -> Field:
    """Return noise of unit standard deviation along many independent lines.

    ``line`` numbers the line of each point, ``x`` is its position in cells on that line.
    """
    cell = np.floor(x)
    weights = spline_weights((x - cell).astype(np.float32))
    index = cell.astype(np.int64)
    total = np.zeros(np.shape(x), np.float32)
    for tap, weight in enumerate(weights):
        total += weight * hash_lattice(np.asarray(line), index + tap, seed)
    return total * np.float32(1.0 / (_UNIFORM_STD * _AXIS_GAIN))


def _axis_taps(count: int, cells: float) -> tuple[Integers, list[Field]]:
    position = ((np.arange(count, dtype=np.float64) + 0.5) / count * cells).astype(np.float64)
    cell = np.floor(position)
    return cell.astype(np.int64), spline_weights((position - cell).astype(np.float32))


def noise_grid(rows: int, columns: int, *, cells: tuple[float, float], seed: int) -> Field:
    """Return noise of unit standard deviation on a grid; ``cells`` lattice cells per axis."""
    return _grid(rows, columns, cells=cells, seed=seed, period=None)


def polar_noise(radii: int, angles: int, *, cells: tuple[float, int], seed: int) -> Field:
    """Return noise on a polar grid (radius, angle), seamless where the angle closes."""
    return _grid(radii, angles, cells=cells, seed=seed, period=cells[1])


def _grid(
    rows: int, columns: int, *, cells: tuple[float, float], seed: int, period: int | None
) -> Field:
    row, row_weights = _axis_taps(rows, cells[0])
    column, column_weights = _axis_taps(columns, cells[1])
    lattice_columns = np.arange(int(column[-1]) + 4 if period is None else period)
    lattice = hash_lattice(np.arange(int(row[-1]) + 4)[:, None], lattice_columns[None, :], seed)
    stretched = np.zeros((rows, lattice.shape[1]), np.float32)
    for tap, weight in enumerate(row_weights):
        stretched += weight[:, None] * lattice[row + tap]
    field = np.zeros((rows, columns), np.float32)
    for tap, weight in enumerate(column_weights):
        index = column + tap if period is None else (column + tap) % period
        field += weight[None, :] * stretched[:, index]
    return field * np.float32(1.0 / (_UNIFORM_STD * _AXIS_GAIN**2))


def sample_polar(grid: Field, radius01: Field, angle01: Field) -> Field:
    """Sample a polar grid (radii, angles) bilinearly; radius clamps, the angle wraps around."""
    radii, angles = grid.shape
    closed = np.concatenate([grid[:, -1:], grid, grid[:, :1]], axis=1)
    row = np.clip(radius01 * radii - 0.5, 0.0, radii - 1.0)
    column = np.mod(angle01, 1.0) * angles + 0.5
    sampled: Field = ndimage.map_coordinates(
        closed, [row.astype(np.float32), column.astype(np.float32)], order=1, mode="nearest"
    )
    return sampled
