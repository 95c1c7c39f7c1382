"""Strands, ridges, crypts: the numbers of photographed irises, over seeds and colours.

Ranges: reference/eye-rendering.md, 1.4 and 1.6, whose scale is known to 30 %. Child strands are 50
to 65 micrometres wide and 91 to 117 apart, bundles 110 to 130 and 205 to 235. Where a border sheet
covers the strands (amber and browner) what is seen lies between the two.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from renderer.iris import openings
from renderer.iris.layout import PUPIL_RADIUS_MM, plan_iris
from renderer.iris.maps import bake_iris
from renderer.iris.pigment import FAMILIES
from renderer.iris.plane import HALF_SIZE_MM, iris_plane
from renderer.iris.statistics import circle, measure_strands, to_lab
from renderer.textures.sizes import unpack_albedo

SIZE_PX = 1024  # 12 micrometres a texel: fine enough for strands
BARE = (("blue", 1), ("grey", 4), ("green", 3), ("hazel", 5))
COVERED = (("amber", 2), ("brown", 1), ("dark-brown", 6))
ANGLES = 1440


@pytest.fixture(scope="module", params=BARE + COVERED, ids=lambda iris: f"{iris[0]}-{iris[1]}")
def baked(request: pytest.FixtureRequest) -> tuple[str, Any]:
    colour, seed = request.param
    return colour, unpack_albedo(bake_iris(seed, colour, size_px=SIZE_PX)["albedo"])


def lightness_around(albedo: Any, radii_mm: Any) -> Any:
    """Return L* along circles, (radii, ANGLES)."""
    rows = []
    for radius_mm in radii_mm:
        row = to_lab(circle(albedo, radius_mm))[:, 0]
        at = np.arange(ANGLES) / ANGLES * len(row)
        rows.append(np.interp(at, np.arange(len(row)), row, period=len(row)))
    return np.array(rows)


def test_strands_are_as_wide_and_as_far_apart_as_in_photographs(baked: tuple[str, Any]) -> None:
    colour, albedo = baked
    strands = measure_strands(albedo)
    is_bare = colour in dict(BARE)
    assert 0.050 * 0.7 < strands.width_mm < (0.065 if is_bare else 0.130) * 1.3
    assert 0.091 * 0.7 < strands.spacing_mm < (0.117 if is_bare else 0.235) * 1.3


def test_ridges_cover_a_third_and_differ_in_lightness_alone(baked: tuple[str, Any]) -> None:
    colour, albedo = baked
    strands = measure_strands(albedo)
    assert 0.30 <= strands.coverage <= 0.40
    lightness, red, yellow = strands.split
    # Browner tissue has less lightness to split: 8 of a blue iris's L* 50 are 5 of a brown's 30.
    least = {"brown": 5.0, "dark-brown": 4.0}.get(colour, 8.0)
    assert least < lightness < 18.0
    assert abs(red) < 2.5
    assert abs(yellow) < 2.5


def test_nothing_repeats_around_the_pupil(baked: tuple[str, Any]) -> None:
    circles = lightness_around(baked[1], np.linspace(2.3, 5.4, 40))
    power = np.abs(np.fft.rfft(circles - circles.mean(axis=1, keepdims=True), axis=1)) ** 2
    correlation = np.fft.irfft(power, axis=1).sum(axis=0)
    correlation /= correlation[0]
    at = correlation[ANGLES // 72 : ANGLES // 2 + 1]  # from 5 to 180 degrees
    is_peak = (at[1:-1] > at[:-2]) & (at[1:-1] > at[2:])
    assert at[1:-1][is_peak].max() < 0.2


def test_no_seam_where_the_angle_closes(baked: tuple[str, Any]) -> None:
    circles = lightness_around(baked[1], np.linspace(2.3, 5.4, 60))
    steps = np.abs(np.roll(circles, -1, axis=1) - circles).mean(axis=0)
    seams = steps[[-1, ANGLES // 2 - 1]]  # at angle 0 and at 180 degrees, where arctan2 jumps
    assert (seams < np.percentile(steps, 99.9)).all()


@pytest.mark.parametrize("colour", FAMILIES)
def test_no_iris_is_a_flat_disc(colour: str) -> None:
    albedo = unpack_albedo(bake_iris(9, colour, size_px=256)["albedo"])
    lightness = lightness_around(albedo, np.linspace(2.3, 5.5, 60))
    # Broad structure, seen from afar: zones along the radius and patches around the pupil.
    assert np.ptp(lightness.mean(axis=1)) > 4.0
    patches = lightness.reshape(60, 24, -1).mean(axis=2)
    assert patches.std(axis=1).mean() > 1.0


@pytest.mark.parametrize("seed", range(12))
def test_crypts_are_as_large_as_real_ones(seed: int) -> None:
    crypts = plan_iris(seed, freckle_rate=1.0, crypt_rate=1.0).crypts
    area_mm2 = 8.0 / 3.0 * crypts.half_width_mm * crypts.half_length_mm  # of a parabolic lens
    assert area_mm2.min() > 0.0149
    assert area_mm2.max() < 0.301
    assert 10 <= area_mm2.size <= 50


@pytest.mark.parametrize("seed", range(4))
def test_no_crypt_is_cut_off(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    layout = plan_iris(seed, freckle_rate=1.0, crypt_rate=1.0)
    plane = iris_plane(layout, 256)
    mask = openings.crypt_mask(plane, layout.crypts, seed)
    monkeypatch.setattr(openings, "reach_mm", lambda *_sizes: 12.0)
    everywhere = openings.crypt_mask(plane, layout.crypts, seed)
    np.testing.assert_allclose(mask, everywhere, atol=0.01)
    assert mask.max() > 0.5


def test_crypts_are_seen_as_dark_openings() -> None:
    crypts = plan_iris(3, freckle_rate=0.8, crypt_rate=1.0).crypts
    lightness = to_lab(unpack_albedo(bake_iris(3, "blue", size_px=512)["albedo"]))[..., 0]
    large = np.flatnonzero(crypts.half_width_mm > 0.10)
    assert large.size
    for i in large:
        row, column = (
            int((crypts.radius_mm[i] * turned(crypts.angle[i]) / HALF_SIZE_MM + 1.0) * 256)
            for turned in (np.sin, np.cos)
        )
        around = lightness_around_radius(lightness, float(crypts.radius_mm[i]))
        assert lightness[row - 1 : row + 2, column - 1 : column + 2].mean() < around


def lightness_around_radius(lightness: Any, radius_mm: float) -> float:
    """Return the median L* at a radius of a map of L*."""
    line = ((np.arange(len(lightness)) + 0.5) / len(lightness) * 2.0 - 1.0) * HALF_SIZE_MM
    radius = np.hypot(line[:, None], line[None, :])
    return float(np.median(lightness[np.abs(radius - radius_mm) < 0.05]))


def test_the_pupils_edge_is_crenated_like_a_ruff() -> None:
    edge = plan_iris(1, freckle_rate=1.0, crypt_rate=1.0).pupil_mm
    assert np.abs(edge - PUPIL_RADIUS_MM).max() < 0.08
    turns = np.count_nonzero(np.diff(np.sign(np.diff(np.concatenate([edge, edge[:2]])))))
    assert 60 <= turns / 2 <= 80


def test_a_known_pattern_is_measured_as_it_was_drawn() -> None:
    """Stripes of 0.1 mm, every other one of albedo 0.2 between others of 0.1."""
    line = ((np.arange(2048) + 0.5) / 1024 - 1.0) * HALF_SIZE_MM
    angle = np.arctan2(line[:, None], line[None, :])
    stripes = np.cos(angle * 140) > 0.0
    albedo = np.where(stripes, 0.2, 0.1).astype(np.float32)[..., None].repeat(3, axis=2)
    strands = measure_strands(albedo)
    assert strands.spacing_mm == pytest.approx(2 * np.pi * 4.55 / 140, rel=0.03)
    assert strands.width_mm == pytest.approx(0.5 * strands.spacing_mm, rel=0.05)
    assert strands.coverage == pytest.approx(0.5, abs=0.05)
    apart = to_lab([0.2] * 3)[0] - to_lab([0.1] * 3)[0]
    assert strands.split[0] == pytest.approx(apart, rel=0.2)
    assert np.abs(strands.split[1:]).max() < 0.1
