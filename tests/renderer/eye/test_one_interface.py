"""One index for the cornea: how far a single surface lands from the true pair, exactly traced."""

from __future__ import annotations

import numpy as np
import pytest

from renderer.eye.anatomy import (
    APEX_MM,
    CORNEA_IOR,
    CORNEA_RADIUS_MM,
    IRIS_Z_MM,
)
from renderer.eye.optics import conic_normal, corneal_sag, fresnel, refract, to_iris_plane, unit

CORNEA, AQUEOUS, TEARS = 1.376, 1.336, 1.337
THICKNESS_MM, POSTERIOR_RADIUS_MM = 0.53, 6.5
VIEW_DEG = (0, 30, 50, 60, 70)


def entries(view_deg: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the points (n, 3) of the cornea that a far viewer sees, and the view direction."""
    angle = np.radians(view_deg)
    direction = np.array([-np.sin(angle), 0.0, -np.cos(angle)])
    x, y = np.meshgrid(np.linspace(-5.5, 5.5, 81), np.linspace(-5.5, 5.5, 81))
    r = np.hypot(x, y).ravel()
    points = np.column_stack([x.ravel(), y.ravel(), APEX_MM - corneal_sag(np.minimum(r, 5.5))])
    is_seen = (r < 5.5) & (conic_normal(points) @ -direction > 0.2)
    return points[is_seen], direction


def through_one(view_deg: float, *, ior: float) -> np.ndarray:
    points, direction = entries(view_deg)
    bent = refract(
        np.broadcast_to(direction, points.shape), conic_normal(points), ior_ratio=1 / ior
    )
    return to_iris_plane(points, bent)


def through_both(view_deg: float) -> np.ndarray:
    """Trace air, cornea, aqueous humour: Baker's conic, then a sphere of 6.5 mm, 0.53 mm deeper."""
    points, direction = entries(view_deg)
    bent = refract(
        np.broadcast_to(direction, points.shape), conic_normal(points), ior_ratio=1 / CORNEA
    )
    centre = np.array([0.0, 0.0, APEX_MM - THICKNESS_MM - POSTERIOR_RADIUS_MM])
    offset = points - centre
    along = np.sum(bent * offset, axis=1)
    root = np.sqrt(along**2 - np.sum(offset**2, axis=1) + POSTERIOR_RADIUS_MM**2)
    inner = points + (-along - root)[:, None] * bent
    return to_iris_plane(inner, refract(bent, unit(inner - centre), ior_ratio=CORNEA / AQUEOUS))


def error_mm(view_deg: float, ior: float) -> float:
    """Return the rms distance on the iris, where both land within 5 mm of the axis."""
    one, both = through_one(view_deg, ior=ior), through_both(view_deg)
    inside = np.hypot(*both.T) < 5.0
    return float(np.sqrt(np.mean(np.sum((one - both)[inside] ** 2, axis=1))))


@pytest.mark.parametrize("view_deg", VIEW_DEG)
def test_our_index_lands_where_the_true_pair_does(view_deg: float) -> None:
    ours, thesis = error_mm(view_deg, CORNEA_IOR), error_mm(view_deg, 1.378)
    assert ours < 0.035
    assert thesis > 2 * ours


def test_no_other_index_is_much_better() -> None:
    """1.336 is within 0.01 mm (rms over all angles) of the best single index."""
    indexes = np.linspace(1.30, 1.39, 46)
    rms = [np.sqrt(np.mean([error_mm(v, ior) ** 2 for v in VIEW_DEG])) for ior in indexes]
    ours = np.sqrt(np.mean([error_mm(v, CORNEA_IOR) ** 2 for v in VIEW_DEG]))
    assert ours - min(rms) < 0.01


def test_the_tear_film_decides_what_is_mirrored() -> None:
    """The outermost surface is the tear film's; the one beneath it adds 0.0002."""
    film = float(fresnel(1.0, ior=TEARS))
    beneath = ((CORNEA - TEARS) / (CORNEA + TEARS)) ** 2
    assert beneath == pytest.approx(0.0002, abs=5e-5)
    assert float(fresnel(1.0)) == pytest.approx(film + beneath, abs=5e-4)
    assert float(fresnel(1.0, ior=1.378)) > 1.2 * film


def test_the_pupil_looks_larger_by_the_closed_form() -> None:
    """Paraxial optics: m = n / (n - (n - 1) D / R); rays near the axis agree with it."""
    n, depth = CORNEA_IOR, APEX_MM - IRIS_Z_MM
    magnification = n / (n - (n - 1) * depth / CORNEA_RADIUS_MM)
    points, _ = entries(0.0)
    near_axis = np.hypot(points[:, 0], points[:, 1]) < 0.4
    landed = through_one(0.0, ior=n)
    ratio = np.hypot(*points[near_axis][:, :2].T) / np.maximum(np.hypot(*landed[near_axis].T), 1e-9)
    away = np.hypot(*points[near_axis][:, :2].T) > 0.1
    np.testing.assert_allclose(ratio[away], magnification, rtol=2e-3)
