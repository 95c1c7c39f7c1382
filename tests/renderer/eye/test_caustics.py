from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import ndimage

from renderer.eye.anatomy import (
    APEX_MM,
    CORNEA_ASPHERICITY,
    CORNEA_IOR,
    CORNEA_RADIUS_MM,
    LIMBUS_HEIGHT_RATIO,
    LIMBUS_INSET_MM,
    LIMBUS_RADIUS_MM,
    SUN_ANGULAR_RADIUS_DEG,
)
from renderer.eye.caustics import MAP_EDGE_MM, Front, caustic_map, entering_rays, lit_flux_mm2
from renderer.eye.optics import corneal_sag

IRIS_RADIUS_MM = 5.6  # the disc of the reference's table


def hard_limbus(entry_mm: np.ndarray) -> np.ndarray:
    return np.where(np.hypot(entry_mm[..., 0], entry_mm[..., 1]) < LIMBUS_RADIUS_MM, 1.0, 0.0)


def conic(r_mm: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    sag = corneal_sag(r_mm)
    return APEX_MM - sag, -r_mm / (CORNEA_RADIUS_MM - CORNEA_ASPHERICITY * sag)


# Baker's cornea alone, cut off at a round limbus: what the reference's values were traced with.
REFERENCE = Front(conic, hard_limbus)


def sun_at(angle_deg: float) -> np.ndarray:
    return np.array([math.sin(math.radians(angle_deg)), 0.0, math.cos(math.radians(angle_deg))])


def texels(size: int) -> tuple[np.ndarray, np.ndarray]:
    axis = (np.arange(size) + 0.5) / size * 2 * MAP_EDGE_MM - MAP_EDGE_MM
    return np.meshgrid(axis, axis)


def test_the_flux_along_the_axis_is_the_limbus_discs_times_the_transmittance() -> None:
    assert lit_flux_mm2(sun_at(0), rays=512, front=REFERENCE) == pytest.approx(105.1, abs=0.1)


@pytest.mark.parametrize("angle_deg", [0.0, 45.0, 75.0])
def test_the_map_holds_all_the_flux(angle_deg: float) -> None:
    gain = caustic_map(sun_at(angle_deg), 128)[..., 2]
    on_map = float(gain.sum(dtype=np.float64)) * (2 * MAP_EDGE_MM / 128) ** 2
    assert on_map == pytest.approx(lit_flux_mm2(sun_at(angle_deg), rays=512), rel=2e-3)


@pytest.mark.parametrize(
    ("angle_deg", "mean"),
    [(0, 1.04), (30, 0.89), (45, 0.72), (60, 0.52), (70, 0.39), (80, 0.28), (90, 0.18)],
)
def test_mean_irradiance_follows_the_references_table(angle_deg: float, mean: float) -> None:
    gain = caustic_map(sun_at(angle_deg), 128, front=REFERENCE)[..., 2]
    iris = np.hypot(*texels(128)) < IRIS_RADIUS_MM
    assert float(gain[iris].mean()) == pytest.approx(mean, rel=0.012, abs=0.005)


def test_the_crescent_lies_opposite_the_light() -> None:
    gain = caustic_map(sun_at(70), 256, front=REFERENCE)[..., 2]
    x, y = texels(256)
    inside = gain * (np.hypot(x, y) < 5.5)
    row, column = np.unravel_index(int(np.argmax(inside)), gain.shape)
    assert x[row, column] < -2.0
    assert inside.max() == pytest.approx(0.95, abs=0.05)
    unlit = gain[np.hypot(x, y) < IRIS_RADIUS_MM] < 0.01
    assert float(unlit.mean()) == pytest.approx(0.25, abs=0.03)


def test_the_iris_is_lit_from_behind_the_horizon() -> None:
    assert lit_flux_mm2(sun_at(100), rays=256) > 5.0
    assert float(caustic_map(sun_at(100), 128)[..., 2].max()) > 2.0


def test_the_map_has_no_ripple_from_the_lattice() -> None:
    gain = caustic_map(sun_at(0), 256)[..., 2]
    x, y = texels(256)
    ripple = gain - ndimage.gaussian_filter(gain, 4.0)
    assert float(np.abs(ripple[np.hypot(x, y) < 4.0]).max()) < 0.006


def test_the_direction_at_the_centre_is_the_axis_rays() -> None:
    sun = sun_at(40)
    _, inside, _ = entering_rays(sun, np.zeros((1, 2)))
    np.testing.assert_allclose(inside[0, 0], -sun[0] / CORNEA_IOR, atol=1e-12)
    landing, _, _ = entering_rays(sun, np.zeros((1, 2)))
    size = 256
    column = int((landing[0, 0] + MAP_EDGE_MM) / (2 * MAP_EDGE_MM) * size)
    direction = caustic_map(sun, size)[size // 2, column]
    assert float(direction[0]) == pytest.approx(inside[0, 0], abs=0.01)


def test_a_wider_light_softens_the_edge_and_keeps_the_flux() -> None:
    sharp, soft = (
        caustic_map(sun_at(60), 128, light_radius_deg=radius_deg, front=REFERENCE)[..., 2]
        for radius_deg in (SUN_ANGULAR_RADIUS_DEG, 10.0)
    )
    assert np.abs(np.diff(soft, axis=1)).max() < 0.6 * np.abs(np.diff(sharp, axis=1)).max()
    assert float(soft.sum()) == pytest.approx(float(sharp.sum()), rel=5e-3)


def test_a_sun_behind_the_head_lights_nothing() -> None:
    assert lit_flux_mm2(sun_at(150), rays=128) == 0.0
    assert not caustic_map(sun_at(150), 64)[..., 2].any()


def test_the_drawn_limbus_is_oval_and_soft() -> None:
    """It lets through what its own clear share leaves of the disc, and its shadow has no edge."""
    disc_mm2 = math.pi * LIMBUS_RADIUS_MM**2 * LIMBUS_HEIGHT_RATIO
    inset = ((LIMBUS_RADIUS_MM - LIMBUS_INSET_MM) / LIMBUS_RADIUS_MM) ** 2
    transmittance = 0.979  # 1 - 0.0207 along the axis, hardly less up to the limbus
    assert lit_flux_mm2(sun_at(0), rays=256) == pytest.approx(
        disc_mm2 * inset * transmittance, rel=0.005
    )
    drawn, hard = (
        caustic_map(sun_at(70), 128, **front)[..., 2] for front in ({}, {"front": REFERENCE})
    )
    assert np.abs(np.diff(drawn, axis=1)).max() < 0.5 * np.abs(np.diff(hard, axis=1)).max()
