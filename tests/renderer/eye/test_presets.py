"""The two presets, on the irises that clips show."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from skimage.color import deltaE_ciede2000, xyz2lab

from renderer.detail import STANDARD_LODS, Detail
from renderer.eye.calibration import OUTER_MM, RUFF_MM
from renderer.iris.maps import iris_maps

F0 = 0.0207  # what the tear film mirrors of a sky of radiance 1
RGB_TO_XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750]]
    + [[0.0193339, 0.1191920, 0.9503041]]
)


def mean_colour(bench: Any, detail: Detail, **spec: Any) -> np.ndarray:
    """Return the iris's mean linear colour (3,) under a uniform sky, without what is mirrored."""
    pixels = bench.picture(bench.eyes(detail, **spec), size=(64, 64))
    radius = bench.radius_mm(pixels)
    inner = 0.56 * spec.get("pupil_mm", 4.0) + RUFF_MM
    mirrors = detail.reflection in {"medium", "high", "ultra"}
    mean = pixels[(radius > inner) & (radius < OUTER_MM)].mean(axis=0)
    return np.asarray(mean - (F0 if mirrors else 0.0), dtype=np.float64)


@pytest.mark.parametrize(
    ("colour", "seed", "pupil_mm"), [("blue", 1, 4.0), ("brown", 2, 2.5), ("hazel", 3, 6.5)]
)
def test_calibrated_lods_have_their_maps_mean_colour(
    real_bench: Any, colour: str, seed: int, pupil_mm: float
) -> None:
    """Luminance within 5 %, colour within CIEDE2000 3 between all four, as the design says."""
    spec = {"preset": "calibrated", "iris_colour": colour, "iris_seed": seed, "pupil_mm": pupil_mm}
    means = np.array(
        [mean_colour(real_bench, Detail.uniform(level), **spec) for level in STANDARD_LODS]
    )
    luminance = means @ RGB_TO_XYZ[1]
    assert luminance.max() < 1.05 * luminance.min()
    lab = xyz2lab(means @ RGB_TO_XYZ.T)
    differences = deltaE_ciede2000(lab[:, None], lab[None, :])
    assert differences.max() < 3.0
    own = iris_maps(seed, colour, size_px=1, base_px=256).albedo[0, 0] @ RGB_TO_XYZ[1]
    np.testing.assert_allclose(luminance, own, rtol=0.05)


@pytest.mark.parametrize(
    ("colour", "seed", "toward_sun"),
    [("blue", 1, (-0.5, 0.5, math.sqrt(0.5))), ("brown", 2, (0.0, 0.0, 1.0))],
)
def test_in_the_thesiss_preset_subsurface_darkens(
    real_bench: Any, colour: str, seed: int, toward_sun: tuple[float, float, float]
) -> None:
    """By about a tenth, wherever the sun stands, without a new hue."""
    spec = {"iris_colour": colour, "iris_seed": seed, "toward_sun": toward_sun}
    row = Detail.uniform("ultra").with_levels(reflection="off")
    layered = mean_colour(real_bench, row, **spec)
    share = layered / mean_colour(real_bench, row.with_levels(subsurface="off"), **spec)
    assert (share > 0.84).all()
    assert (share < 0.95).all()
    assert share.max() < 1.04 * share.min()


def test_in_the_thesiss_preset_caustics_change_the_iriss_brightness(real_bench: Any) -> None:
    ultra = Detail.uniform("ultra").with_levels(reflection="off")
    whole, without = (
        mean_colour(real_bench, ultra.with_levels(caustics=level), sun=2.0, sky=0.3)
        for level in ("ultra", "off")
    )
    assert (np.abs(whole / without - 1) > 0.05).all()


def test_a_wider_pupil_gathers_the_tissue(real_bench: Any) -> None:
    """The same tissue on a narrower ring: colours follow the map's radius, not the eye's."""
    row = Detail.uniform("off").with_levels(texture="high")
    narrow, wide = (
        real_bench.picture(real_bench.eyes(row, pupil_mm=pupil), size=(160, 160))
        for pupil in (3.0, 6.0)
    )
    line = np.abs(np.arange(160) - 79.5) * 14 / 160
    along = {}
    for name, pixels, pupil in (("narrow", narrow, 3.0), ("wide", wide, 6.0)):
        share = (line - pupil / 2) / (5.85 - pupil / 2)
        inside = (share > 0.15) & (share < 0.85) & (np.arange(160) > 80)
        along[name] = np.interp(
            np.linspace(0.2, 0.8, 30), share[inside], pixels[79:81, inside].mean(axis=(0, 2))
        )
    assert np.corrcoef(along["narrow"], along["wide"])[0, 1] > 0.8
