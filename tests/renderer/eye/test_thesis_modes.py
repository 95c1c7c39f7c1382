"""The thesis's own forms of two effects: its subsurface sum and its painted caustics."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from renderer.detail import Detail
from renderer.eye.painted_caustic import BRUSH_PX, painted_caustic

LOW_SUN = (-math.sin(math.radians(65)), 0.0, math.cos(math.radians(65)))
PLAIN = Detail.uniform("off").with_levels(caustics="ultra", tessellation="ultra")


def shrunk(pattern: np.ndarray) -> np.ndarray:
    return pattern.reshape(256, 4, 256, 4).mean(axis=(1, 3))


def test_the_pattern_is_grey_in_8_bits_and_ends_at_the_iriss_root() -> None:
    pattern = painted_caustic(256)
    assert pattern.shape == (256, 256)
    np.testing.assert_allclose(pattern * 255, np.rint(pattern * 255), atol=1e-4)
    line = (np.arange(256) + 0.5) / 256 * 12 - 6
    x, y = np.meshgrid(line, line)
    assert pattern[np.hypot(x, y) > 5.9].max() == 0
    assert pattern[x > 2].mean() > 10 * pattern[x < -2].mean()


def test_both_sizes_are_one_painting_but_the_small_one_is_coarse() -> None:
    """Strokes are as wide as the brush: at 256 texels four times as wide on the iris."""
    small, large = painted_caustic(256), shrunk(painted_caustic(1024))
    assert np.corrcoef(small.ravel(), large.ravel())[0, 1] > 0.8
    bright = [(field > 0.6).mean() for field in (small, painted_caustic(1024))]
    assert bright[0] > 2.0 * bright[1]
    assert BRUSH_PX * 12 / 256 > 0.065  # wider than the iris's strands


def painted(bench: Any, row: Detail, **changes: Any) -> np.ndarray:
    light = {"sun": 2.0, "sky": 0.2, "toward_sun": LOW_SUN, "caustic_pattern": "painted"}
    return np.asarray(bench.picture(bench.eyes(row, **{**light, **changes}), size=(128, 128)))


def test_painted_caustics_lighten_the_iris_opposite_a_low_sun(bench: Any) -> None:
    without = painted(bench, PLAIN.with_levels(caustics="off"))
    added = painted(bench, PLAIN) - without
    radius = bench.radius_mm(added)
    column = np.indices(added.shape[:2])[1]
    iris = (radius > 2.2) & (radius < 4.8)
    assert added[iris].min() > -1e-4
    assert added[iris & (column > 84)].mean() > 10 * added[iris & (column < 44)].mean()
    assert added[iris].max() > 0.2 * without[iris].mean()


def test_painted_caustics_take_the_iriss_colour(bench: Any) -> None:
    added = painted(bench, PLAIN) - painted(bench, PLAIN.with_levels(caustics="off"))
    red, green, blue = added.sum(axis=(0, 1))
    assert red / green == pytest.approx(1.5, rel=0.02)
    assert green / blue == pytest.approx(2.0, rel=0.02)


def test_painted_caustics_fade_as_the_sun_comes_from_the_front(bench: Any) -> None:
    def total(toward_sun: tuple[float, float, float]) -> float:
        with_it = painted(bench, PLAIN, toward_sun=toward_sun)
        without = painted(bench, PLAIN.with_levels(caustics="off"), toward_sun=toward_sun)
        return float((with_it - without).sum())

    assert total((0.05, 0.0, math.sqrt(1 - 0.05**2))) < 0.1 * total(LOW_SUN)


def test_painted_caustics_turn_with_the_sun(bench: Any) -> None:
    low = math.sin(math.radians(65))
    from_above = painted(bench, PLAIN, toward_sun=(0.0, low, LOW_SUN[2]))
    added = from_above - painted(
        bench, PLAIN.with_levels(caustics="off"), toward_sun=(0.0, low, LOW_SUN[2])
    )
    assert added[:50].sum() > 10 * added[78:].sum()


def test_painted_and_computed_caustics_differ(bench: Any) -> None:
    computed = painted(bench, PLAIN, caustic_pattern="computed")
    assert np.abs(painted(bench, PLAIN) - computed).max() > 0.05


def test_a_small_painting_looks_wrong_where_a_small_computed_map_does_not(bench: Any) -> None:
    """What the thesis's viewers noticed is the painting's coarseness, not the map's size."""

    def change(pattern: str) -> float:
        small, large = (
            painted(bench, PLAIN.with_levels(caustics=level), caustic_pattern=pattern)
            for level in ("high", "ultra")
        )
        return float(np.sqrt(np.mean((small - large) ** 2)))

    assert change("painted") > 5 * change("computed")


@pytest.mark.parametrize("level", ["off", "low", "medium"])
def test_the_modes_change_nothing_where_the_table_says_none(bench: Any, level: str) -> None:
    row = Detail.uniform("low").with_levels(caustics=level, subsurface=level)
    plain = bench.picture(bench.eyes(row, sun=2.0))
    modes = bench.eyes(row, sun=2.0, caustic_pattern="painted", subsurface_samples=10)
    np.testing.assert_array_equal(plain, bench.picture(modes))


def test_fewer_samples_of_the_thesiss_sum_are_brighter(bench: Any) -> None:
    row = Detail.uniform("ultra").with_levels(texture="off", reflection="off", sclera="low")
    seen = {
        samples: bench.picture(bench.eyes(row, sun=2.0, subsurface_samples=samples))[32, 48, 1]
        for samples in (2, 10, 50, 200, 0)
    }
    assert seen[2] > seen[10] > seen[50] > seen[200] > 0.999 * seen[0]
    assert seen[10] > 1.02 * seen[0]


def test_high_and_ultra_take_the_same_number_of_samples(bench: Any) -> None:
    base = Detail.uniform("ultra").with_levels(texture="off", reflection="off", sclera="low")
    high, ultra = (
        bench.picture(
            bench.eyes(base.with_levels(subsurface=level), sun=2.0, subsurface_samples=10)
        )
        for level in ("high", "ultra")
    )
    np.testing.assert_allclose(high, ultra, rtol=1e-3, atol=1e-4)
