from __future__ import annotations

import math

import numpy as np
import pytest

from renderer.eye.anatomy import APEX_MM, GLOBE_RADIUS_MM, IRIS_Z_MM, LIMBUS_RADIUS_MM
from renderer.eye.optics import (
    cornea_from_inside,
    corneal_sag,
    fresnel,
    refract,
    surface_height,
    surface_normal,
    to_iris_plane,
    unit,
)


def test_sag_follows_bakers_table() -> None:
    radii = np.array([1, 2, 3, 4, 5, 5.5, 5.85])
    expected = [0.064, 0.260, 0.594, 1.082, 1.750, 2.164, 2.492]
    np.testing.assert_allclose(corneal_sag(radii), expected, atol=5e-4)


@pytest.mark.parametrize("angle_deg", [0.0, 20.0, 45.0, 70.0, 89.0])
def test_refraction_obeys_snell(angle_deg: float) -> None:
    angle = math.radians(angle_deg)
    incident = np.array([math.sin(angle), 0.0, -math.cos(angle)])
    bent = refract(incident, np.array([0.0, 0.0, 1.0]), ior_ratio=1 / 1.336)
    assert math.sin(angle) == pytest.approx(1.336 * math.hypot(bent[0], bent[1]), abs=1e-12)
    assert np.linalg.norm(bent) == pytest.approx(1.0)


def test_total_reflection_gives_no_direction() -> None:
    angle = math.asin(1 / 1.336) + 0.01
    incident = np.array([math.sin(angle), 0.0, math.cos(angle)])
    assert np.isnan(refract(incident, np.array([0.0, 0.0, -1.0]), ior_ratio=1.336)).all()


def test_fresnel_is_exact_at_the_references_angles() -> None:
    angles = np.radians([0, 45, 60, 70, 80, 85])
    expected = [0.0207, 0.0283, 0.060, 0.134, 0.349, 0.584]
    np.testing.assert_allclose(fresnel(np.cos(angles)), expected, atol=5e-4)


def test_fresnel_is_the_same_from_both_sides_of_the_cornea() -> None:
    outside = math.radians(50)
    inside = math.asin(math.sin(outside) / 1.336)
    from_inside = fresnel(math.cos(inside), ior=1 / 1.336)
    assert float(from_inside) == pytest.approx(float(fresnel(math.cos(outside))), rel=1e-9)
    assert float(fresnel(0.3, ior=1 / 1.336)) == 1.0


def test_the_surface_is_cornea_in_front_and_globe_behind() -> None:
    near, _ = surface_height(np.linspace(0, 3.5, 30))
    np.testing.assert_allclose(near, APEX_MM - corneal_sag(np.linspace(0, 3.5, 30)), atol=1e-4)
    radii = np.linspace(8.0, 11.0, 30)
    np.testing.assert_allclose(
        surface_height(radii)[0], np.sqrt(GLOBE_RADIUS_MM**2 - radii**2), atol=1e-4
    )


def test_the_limbus_is_smooth() -> None:
    r = np.linspace(0.0, 11.0, 11001)
    height, slope = surface_height(r)
    np.testing.assert_allclose(
        np.diff(height) / np.diff(r), (slope[1:] + slope[:-1]) / 2, atol=2e-5
    )
    curvature = np.diff(slope) / np.diff(r)
    assert np.abs(np.diff(curvature)).max() < 0.02  # a crease would be a spike of hundreds
    raised = height - np.maximum(APEX_MM - corneal_sag(np.minimum(r, 8.5)), 0)
    assert raised[np.argmin(np.abs(r - LIMBUS_RADIUS_MM))] == pytest.approx(0.075, abs=0.001)


def test_normals_stand_on_the_surface() -> None:
    r = np.array([0.0, 2.0, 5.85, 7.0, 9.0])
    height, slope = surface_height(r)
    points = np.column_stack([r * 0.6, r * 0.8, height])
    along = unit(np.column_stack([np.full(5, 0.6), np.full(5, 0.8), slope]))
    np.testing.assert_allclose(np.sum(surface_normal(points) * along, axis=1), 0.0, atol=1e-9)
    behind = np.array([3.0, 4.0, -10.2])
    np.testing.assert_allclose(surface_normal(behind), behind / np.linalg.norm(behind))


@pytest.mark.parametrize("slant", [0.2, 1.0, 2.0, 4.0])
def test_rays_from_the_iris_meet_the_surface_and_come_back(slant: float) -> None:
    origin = np.array([[1.0, -2.0, IRIS_Z_MM]])
    direction = unit(np.array([[0.4 * slant, slant, 1.0]]))
    hit = cornea_from_inside(origin, direction)
    height, _ = surface_height(np.hypot(hit[0, 0], hit[0, 1]))
    assert hit[0, 2] == pytest.approx(float(height), abs=1e-9)
    np.testing.assert_allclose(to_iris_plane(hit, -direction), origin[:, :2], atol=1e-9)
    assert surface_normal(hit)[0] @ direction[0] > 0


def test_rays_into_the_limbus_wall_meet_no_cornea() -> None:
    origin = np.array([[5.0, 0.0, IRIS_Z_MM]])
    assert np.isnan(cornea_from_inside(origin, np.array([[0.9995, 0.0, 0.0316]]))).all()
