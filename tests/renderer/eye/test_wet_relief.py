"""The fine relief of the wet white, and the iris as a relief."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from renderer.detail import Detail
from renderer.eye.micro_relief import RMS_SLOPE, SLOPE_RANGE, TILE_PX, micro_relief_tile

OFF = Detail.uniform("off")


@pytest.fixture(scope="module")
def tile() -> np.ndarray:
    return micro_relief_tile()


def slopes(tile: np.ndarray) -> np.ndarray:
    return np.asarray((2 * tile[..., :2] - 1) * SLOPE_RANGE)


def test_the_tile_has_the_slope_it_says(tile: np.ndarray) -> None:
    assert tile.shape == (TILE_PX, TILE_PX, 4)
    square = np.sum(slopes(tile) ** 2, axis=-1)
    assert math.sqrt(square.mean()) == pytest.approx(RMS_SLOPE, rel=0.03)
    np.testing.assert_allclose(tile[..., 2] * SLOPE_RANGE**2, np.minimum(square, 0.25), atol=2e-3)


def test_the_tile_repeats_without_a_seam(tile: np.ndarray) -> None:
    inside = np.abs(np.diff(tile, axis=1)).mean()
    across = np.abs(tile[:, 0] - tile[:, -1]).mean()
    assert across < 1.3 * inside


def test_some_folds_are_far_steeper_than_the_rest(tile: np.ndarray) -> None:
    """Glints stand alone where few facets tilt enough: longer tails than a normal law's."""
    steep = np.hypot(*np.moveaxis(slopes(tile), -1, 0))
    assert np.percentile(steep, 99.5) > 2.6 * RMS_SLOPE
    assert np.median(steep) < RMS_SLOPE


def glints(bench: Any, sclera: str) -> np.ndarray:
    """Return the red of the visible white under a sun that it mirrors, seen from the side."""
    row = OFF.with_levels(sclera=sclera, reflection="high", tessellation="ultra")
    half = math.radians(48.0)
    sun = (math.sin(half * 2), 0.0, math.cos(half * 2))
    eyes = bench.eyes(row, sun=2.0, sky=0.0, toward_sun=sun)
    pixels = bench.picture(eyes, size=(160, 160))
    return np.asarray(pixels[60:100, 125:160, 0])


def test_relief_breaks_the_suns_image_on_the_white_into_glints(bench: Any) -> None:
    plain, wet = glints(bench, "medium"), glints(bench, "ultra")

    def edges(red: np.ndarray) -> float:
        return float(np.abs(np.diff(red, axis=0)).mean() / red.mean())

    assert edges(wet) > 2 * edges(plain)
    assert wet.max() > plain.max()


def test_a_slanting_view_shifts_the_iriss_relief(real_bench: Any) -> None:
    """Both levels have the same map here: relief alone tells them apart, more so at a slant."""

    def shift(azimuth_deg: float) -> float:
        flat, relief = (
            real_bench.picture(
                real_bench.eyes(OFF.with_levels(texture=level, tessellation="ultra")),
                size=(160, 160),
                azimuth_deg=azimuth_deg,
            )
            for level in ("medium", "high")
        )
        iris = (radius := real_bench.radius_mm(flat)) < 4.5
        iris &= radius > 2.4
        return float(np.abs(relief - flat)[iris].mean() / flat[iris].mean())

    assert shift(0.0) < 0.001
    assert shift(40.0) > 0.004  # 0.04 mm at a pixel of 0.09


def test_a_small_iris_is_drawn_flat(real_bench: Any) -> None:
    flat, relief = (
        real_bench.picture(
            real_bench.eyes(OFF.with_levels(texture=level, tessellation="ultra")),
            size=(64, 64),
            azimuth_deg=40.0,
        )
        for level in ("medium", "high")
    )
    np.testing.assert_allclose(flat, relief, atol=1e-4)


def test_relief_shades_the_iris_away_from_the_sun(real_bench: Any) -> None:
    low_sun = (-math.sin(math.radians(55)), 0.0, math.cos(math.radians(55)))
    flat, relief = (
        real_bench.picture(
            real_bench.eyes(
                OFF.with_levels(texture=level, tessellation="ultra"),
                sun=2.0,
                sky=0.0,
                toward_sun=low_sun,
            ),
            size=(128, 128),
        )
        for level in ("medium", "high")
    )
    iris = (radius := real_bench.radius_mm(flat)) < 4.5
    iris &= radius > 2.4
    ratio = relief[iris][:, 1] / np.maximum(flat[iris][:, 1], 1e-4)
    assert np.percentile(ratio, 5) < 0.6  # in shade
    assert np.percentile(ratio, 95) > 1.15  # facing the sun
