"""What tells an iris's zones apart: collarette, pupillary zone, bundles, furrows, sectors, ruff."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import ndimage

from renderer.iris.angles import ANGLES
from renderer.iris.inner_strands import pupillary_tubes
from renderer.iris.layout import IrisLayout, plan_iris
from renderer.iris.maps import bake_iris
from renderer.iris.pigment import FAMILIES
from renderer.iris.plane import HALF_SIZE_MM
from renderer.iris.statistics import circle, to_lab
from renderer.iris.strands import ciliary_tubes
from renderer.textures.sizes import unpack_albedo

SIZE_PX = 768
IRISES = (("blue", 1), ("blue", 2), ("brown", 1))


@pytest.fixture(scope="module", params=IRISES, ids=lambda iris: f"{iris[0]}-{iris[1]}")
def baked(request: pytest.FixtureRequest) -> tuple[IrisLayout, Any]:
    """Return an iris's plan and its CIE L*a*b* map."""
    colour, seed = request.param
    look = FAMILIES[colour]
    layout = plan_iris(seed, freckle_rate=look.freckles, crypt_rate=look.crypts)
    return layout, to_lab(unpack_albedo(bake_iris(seed, colour, size_px=SIZE_PX)["albedo"]))


def along(lab: Any, radius_mm: Any) -> Any:
    """Return the map along a closed curve of radii, (ANGLES, 3)."""
    angle = np.arange(ANGLES) / ANGLES * 2.0 * np.pi
    at = [
        (radius_mm * turned / HALF_SIZE_MM + 1.0) * len(lab) / 2.0 - 0.5
        for turned in (np.sin(angle), np.cos(angle))
    ]
    return np.stack([ndimage.map_coordinates(lab[..., c], at, order=1) for c in range(3)], axis=-1)


def test_the_collarette_is_paler_than_what_lies_inside_and_outside(baked: Any) -> None:
    layout, lab = baked
    ring, inside, outside = (
        np.mean([along(lab, layout.collarette_mm + beyond)[:, 0].mean() for beyond in ways])
        for ways in ((-0.03, 0.02, 0.07), (-0.40, -0.32, -0.25), (0.9, 1.0, 1.1))
    )
    assert ring > inside + 5.0
    assert ring > outside + 9.0


@pytest.mark.parametrize("seed", range(6))
def test_the_collarette_is_an_uneven_zigzag_at_two_fifths(seed: int) -> None:
    layout = plan_iris(seed, freckle_rate=1.0, crypt_rate=1.0)
    share = (layout.collarette_mm - 2.0) / 3.85
    assert 0.24 < share.mean() < 0.42
    bends = layout.collarette_mm - ndimage.gaussian_filter1d(
        layout.collarette_mm, ANGLES / 20, mode="wrap"
    )
    assert 0.085 < bends.std() < 0.2
    assert 20 <= layout.cusp_angle.size <= 40


def test_pupillary_strands_are_finer_and_straighter_than_ciliary_ones() -> None:
    layout = plan_iris(1, freckle_rate=1.0, crypt_rate=1.0)
    inner = pupillary_tubes(layout, 1, step_mm=0.02)
    outer = ciliary_tubes(layout, 1, index=2, step_mm=0.02)
    assert np.median(inner.half_width_mm) < 0.8 * np.median(outer.half_width_mm)
    lean = [np.median(np.abs(lean_deg(tubes))) for tubes in (inner, outer)]
    assert 1.5 * lean[0] < lean[1]
    # Reference: 12 to 24 degrees between strands and the radius.
    assert 8.0 < lean[1] < 24.0


def lean_deg(tubes: Any) -> Any:
    """Return the angle between each step of strands and the radius, in degrees."""
    same = np.diff(tubes.tube) == 0
    x, y = tubes.x_mm.astype(float), tubes.y_mm.astype(float)
    step = np.stack([np.diff(x), np.diff(y)], axis=1)[same]
    radial = np.stack([x[:-1], y[:-1]], axis=1)[same]
    cross = radial[:, 0] * step[:, 1] - radial[:, 1] * step[:, 0]
    return np.degrees(np.arctan2(cross, np.abs((radial * step).sum(axis=1))))


def test_whole_bundles_differ_so_that_the_ciliary_zone_is_not_combed(baked: Any) -> None:
    _, lab = baked
    spread = []
    for radius_mm in np.linspace(4.0, 5.0, 12):
        line = circle(lab, radius_mm)[:, 0]
        step_mm = 2.0 * np.pi * radius_mm / len(line)
        near, far = (
            ndimage.gaussian_filter1d(line, width_mm / step_mm, mode="wrap")
            for width_mm in (0.08, 0.5)
        )
        spread.append((near - far).std())
    assert np.mean(spread) > 2.9


def test_furrows_are_dark_arcs_in_the_outer_half() -> None:
    depths = []
    for seed in (2, 3, 6):
        layout = plan_iris(seed, freckle_rate=0.0, crypt_rate=1.0)
        lab = to_lab(unpack_albedo(bake_iris(seed, "blue", size_px=SIZE_PX)["albedo"]))
        furrows = layout.furrows
        for ring, strength, half in zip(
            furrows.radius_mm, furrows.strength, furrows.half_width_mm, strict=True
        ):
            assert 3.9 < ring.mean() < 5.6
            deep = strength > 0.5
            beside = [along(lab, ring + side * 3.0 * half)[deep, 0] for side in (-1.0, 1.0)]
            depths.extend((np.mean(beside, axis=0) - along(lab, ring)[deep, 0]).tolist())
    assert len(depths) > 500
    assert 2.0 < np.mean(depths) < 15.0


def test_hue_varies_a_little_from_sector_to_sector(baked: Any) -> None:
    _, lab = baked
    rings = np.mean([along(lab, radius_mm) for radius_mm in np.linspace(4.0, 5.2, 25)], axis=0)
    sectors = rings.reshape(16, -1, 3).mean(axis=1)
    assert 0.9 < sectors[:, 1:].std(axis=0).max() < 4.0


def test_the_ruff_is_dark_and_of_uneven_width(baked: Any) -> None:
    layout, lab = baked
    ways = np.linspace(0.02, 0.4, 40)
    lightness = np.stack([along(lab, layout.pupil_mm + way)[:, 0] for way in ways])
    tissue = np.median(lightness[-8:])
    width = ways[np.argmax(lightness > 0.75 * tissue, axis=0)]
    assert 0.04 < np.median(width) < 0.16
    assert np.percentile(width, 95) - np.percentile(width, 5) > 0.06
    assert np.median(lightness[2]) < 0.6 * tissue
