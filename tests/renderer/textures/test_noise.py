"""Hashed noise: reproducible, of unit deviation, smooth and seamless where it closes."""

from __future__ import annotations

import numpy as np

from renderer.textures.noise import hash_lattice, noise_1d, noise_grid, polar_noise, sample_polar


def test_the_hash_is_the_same_on_every_machine() -> None:
    values = hash_lattice(np.arange(3), np.arange(3), 7)
    assert values.tolist() == hash_lattice(np.arange(3), np.arange(3), 7).tolist()
    assert len(set(values.tolist())) == 3


def test_hashed_numbers_fill_their_range_evenly() -> None:
    values = hash_lattice(np.arange(300)[:, None], np.arange(300)[None, :], 1)
    assert abs(values.mean()) < 0.01
    assert abs(values.std() - 1.0 / np.sqrt(3.0)) < 0.01
    assert values.min() >= -1.0
    assert values.max() < 1.0
    assert abs(np.corrcoef(values[:-1].ravel(), values[1:].ravel())[0, 1]) < 0.02


def test_noise_has_unit_deviation_in_one_and_two_dimensions() -> None:
    grid = noise_grid(400, 500, cells=(57.3, 66.1), seed=3)
    assert abs(grid.std() - 1.0) < 0.08
    line = noise_1d(np.zeros(20000, np.int64), np.linspace(0, 900, 20000, dtype=np.float32), 3)
    assert abs(line.std() - 1.0) < 0.08


def test_lines_are_independent() -> None:
    x = np.linspace(0, 300, 6000, dtype=np.float32)
    first = noise_1d(np.full(x.size, 1), x, 3)
    second = noise_1d(np.full(x.size, 2), x, 3)
    assert abs(np.corrcoef(first, second)[0, 1]) < 0.15


def test_polar_noise_closes_without_a_seam() -> None:
    grid = polar_noise(40, 1000, cells=(5.0, 50), seed=4)
    steps = np.abs(np.roll(grid, -1, axis=1) - grid).max(axis=0)
    assert steps[-1] < 1.2 * steps[:-1].max()


def test_sampling_a_polar_grid_wraps_the_angle_and_clamps_the_radius() -> None:
    grid = polar_noise(16, 64, cells=(4.0, 8), seed=5)
    centre = (np.arange(64, dtype=np.float32) + 0.5) / 64
    row = np.full(64, 4.5 / 16, np.float32)
    np.testing.assert_allclose(sample_polar(grid, row, centre + 3.0), grid[4], atol=1e-3)
    beyond = sample_polar(grid, np.full(64, 9.0, np.float32), centre)
    np.testing.assert_allclose(beyond, grid[-1], atol=1e-4)
