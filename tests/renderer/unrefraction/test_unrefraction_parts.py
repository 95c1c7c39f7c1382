"""Taking an iris from a photograph, part by part: ellipses, pose, rays, light, fill, relief."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from renderer.eye import maps as eye_maps
from renderer.iris.maps import PUPIL_RADIUS_MM
from renderer.unrefraction.edges import Edge, Edges
from renderer.unrefraction.ellipse import Ellipse, fit_ellipse, robust_ellipse
from renderer.unrefraction.fill import fill_hidden
from renderer.unrefraction.light import even_light
from renderer.unrefraction.pose import TELECENTRIC_MM, Pose, seen_through
from renderer.unrefraction.pose_fit import find_pose
from renderer.unrefraction.search import find_candidates
from renderer.unrefraction.texels import Texels, place_texels
from renderer.unrefraction.tissue import (
    MULTIPLE_SHARE,
    brownness,
    build_height,
    build_thickness,
    layered_share,
    scattering_of,
)

SIZE = 256


def test_an_ellipse_is_fitted_exactly_and_outliers_are_left_out() -> None:
    truth = Ellipse(120.0, 80.0, 60.0, 48.0, 0.6)
    points = truth.points(100)
    fitted = fit_ellipse(points)
    assert fitted is not None
    assert (fitted.x, fitted.y) == pytest.approx((120.0, 80.0), abs=1e-6)
    assert (fitted.major, fitted.minor) == pytest.approx((60.0, 48.0), abs=1e-6)
    lid = np.stack([np.linspace(70, 170, 40), np.full(40, 55.0)], axis=1)
    found = robust_ellipse(np.concatenate([points, lid]), tolerance=1.0)
    assert found is not None
    ellipse, support = found
    assert ellipse.minor == pytest.approx(48.0, abs=0.3)
    assert support[:100].all()
    assert support[100:].sum() < 8
    assert fit_ellipse(np.stack([np.arange(20.0), np.arange(20.0)], axis=1)) is None


@pytest.mark.parametrize("yaw_deg", [0.0, 20.0, 33.0])
def test_the_entry_point_is_where_the_camera_sees_the_iris_point(
    level_pose: Pose, yaw_deg: float
) -> None:
    pose = dataclasses.replace(level_pose, yaw=math.radians(yaw_deg), distance_mm=150.0)
    line = np.linspace(-5.0, 5.0, 21)
    points = np.stack(np.meshgrid(line, line), axis=-1)
    points = points[np.hypot(points[..., 0], points[..., 1]) < 5.0]
    entry = pose.entry(points)
    np.testing.assert_allclose(seen_through(entry[..., :2], pose.camera_mm), points, atol=2e-4)


def test_the_cornea_magnifies_the_pupil(level_pose: Pose) -> None:
    """4.00 mm look 4.44 mm wide off the axis: renderer/eye/test_eyes.py says the same of GL."""
    wide = np.ptp(level_pose.pupil()[:, 0]) / level_pose.px_per_mm
    assert wide == pytest.approx(4.44 * (1 + 0.005 / 2.0), abs=0.02)


@pytest.mark.parametrize(("yaw_deg", "pitch_deg"), [(0, 0), (20, 0), (-14, 14), (5, -28)])
def test_a_pose_is_found_from_its_own_edges(
    level_pose: Pose, yaw_deg: float, pitch_deg: float
) -> None:
    truth = dataclasses.replace(
        level_pose, yaw=math.radians(yaw_deg), pitch=math.radians(pitch_deg), pupil_mm=1.6
    )
    edges = Edges(*(_edge(points) for points in (truth.pupil(), truth.limbus())))
    found = find_pose(edges, turn=0.0, limbus_mm=11.7, distance_mm=TELECENTRIC_MM)
    assert math.degrees(found.yaw) == pytest.approx(yaw_deg, abs=1.5)
    assert math.degrees(found.pitch) == pytest.approx(pitch_deg, abs=1.5)
    assert found.pupil_mm == pytest.approx(1.6, abs=0.01)
    assert found.px_per_mm == pytest.approx(40.0, rel=0.005)


def _edge(points: np.ndarray) -> Edge:
    fitted = fit_ellipse(points)
    assert fitted is not None
    return Edge(points, fitted, 1.0)


@pytest.fixture(scope="module")
def texels(level_pose: Pose) -> Texels:
    return place_texels(dataclasses.replace(level_pose, pupil_mm=3.0), SIZE)


def test_texels_at_the_maps_pupil_lie_on_the_photographs_pupil(
    texels: Texels, level_pose: Pose
) -> None:
    edge = np.abs(texels.radius_mm - PUPIL_RADIUS_MM) < 0.03
    apparent = np.hypot(texels.x_px - 300.0, texels.y_px - 280.0)[edge] / 40.0
    entry = level_pose.entry(np.array([3.0, 0.0]))[0]
    assert apparent.mean() == pytest.approx(entry, abs=0.02)
    upper = texels.y_px[np.abs(texels.angle - 1.57) < 0.1].mean()
    assert upper < 280.0, "the maps' y points up, the picture's down"


def test_a_slope_of_the_light_is_taken_off_and_fibres_stay(texels: Texels) -> None:
    fibres = 0.2 + 0.05 * np.sign(np.sin(40 * texels.angle))
    slope = np.exp(0.08 * texels.radius_mm * np.sin(texels.angle))
    seen = (texels.radius_mm > 2.1) & (texels.radius_mm < 5.2)
    ring = (texels.radius_mm > 2.5) & (texels.radius_mm < 4.0)

    def unevenness(light: np.ndarray) -> float:
        level = even_light(
            np.repeat((fibres * light)[..., None], 3, axis=-1).astype(np.float32),
            texels,
            seen=seen,
            pupil_mm=3.0,
        )[..., 0]
        top = level[ring & (texels.angle > 1.2) & (texels.angle < 1.9)].mean()
        low = level[ring & (texels.angle < -1.2) & (texels.angle > -1.9)].mean()
        assert level[ring].std() / level[ring].mean() == pytest.approx(0.25, abs=0.06)
        return float(top / low)

    assert unevenness(np.ones_like(slope)) == pytest.approx(1.0, abs=0.02)
    assert unevenness(slope) == pytest.approx(1.0, abs=0.06), "was 1.6 before"


def test_sectors_of_tissue_are_not_taken_for_light(texels: Texels) -> None:
    sectors = sum(0.15 / k**0.5 * np.cos(k * texels.angle + k * k) for k in range(1, 7))
    seen = (texels.radius_mm > 2.1) & (texels.radius_mm < 5.2)
    look = np.repeat(np.exp(-1.5 + sectors)[..., None], 3, axis=-1).astype(np.float32)
    level = even_light(look, texels, seen=seen, pupil_mm=3.0)[..., 0]
    ring = (texels.radius_mm > 4.0) & (texels.radius_mm < 4.3)
    kept = np.polyfit(sectors[ring], np.log(level[ring]), 1)[0]
    assert kept == pytest.approx(1.0, abs=0.1), "was 0.5 when all slow waves were light's"


def test_hidden_tissue_is_filled_like_the_rest_and_seen_tissue_stays(texels: Texels) -> None:
    rng = np.random.Generator(np.random.PCG64(1))
    grain = rng.uniform(0.8, 1.2, texels.radius_mm.shape)
    look = (0.1 + 0.04 * texels.radius_mm) * grain
    colour = np.stack([look, 0.8 * look, 0.5 * look], axis=-1).astype(np.float32)
    height = texels.radius_mm * np.sin(texels.angle)
    known = (height < 3.0) & (texels.radius_mm < 5.4)
    spoilt = np.where(known[..., None], colour, np.float32(0.9))
    filled = fill_hidden(spoilt, known, radius_mm=texels.radius_mm, angle=texels.angle)
    inner = (height < 2.4) & (texels.radius_mm < 5.0)
    np.testing.assert_allclose(filled[inner], colour[inner], rtol=1e-4)
    hidden = (height > 3.3) & (texels.radius_mm < 5.0)
    assert filled[hidden].mean(axis=0) == pytest.approx(colour[hidden].mean(axis=0), rel=0.08)
    assert filled[hidden][:, 0].std() > 0.4 * colour[hidden][:, 0].std(), "grain, no smear"


def test_bright_fibres_stand_high_and_dark_gaps_are_cavities(texels: Texels) -> None:
    fibre = np.sin(50 * texels.angle)
    look = 0.2 * np.exp(0.5 * fibre)
    albedo = np.repeat(look[..., None], 3, axis=-1).astype(np.float32)
    height, cavity = build_height(albedo, texels.radius_mm)
    ring = (texels.radius_mm > 3.0) & (texels.radius_mm < 4.5)
    crest, gap = ring & (fibre > 0.8), ring & (fibre < -0.8)
    assert height[crest].mean() > height[gap].mean() + 0.05
    assert cavity[crest].mean() > cavity[gap].mean() + 0.02
    thickness = build_thickness(albedo, height, texels.radius_mm)
    assert thickness.shape == (SIZE, SIZE, 4)
    assert thickness[crest, 1].mean() > thickness[gap, 1].mean() > 0.0


def test_brown_irises_have_a_thick_border_layer_and_brown_scattering() -> None:
    brown, blue = (np.array(c, np.float32) for c in ((0.12, 0.06, 0.03), (0.15, 0.2, 0.3)))
    assert brownness(brown) > 0.7
    assert brownness(blue) < 0.2
    tissue = scattering_of(brown)
    assert np.all(tissue.sigma_s <= tissue.sigma_t)
    assert np.all(np.diff(tissue.sigma_s, axis=1) < 0), "red scatters most"
    assert scattering_of(blue).sigma_s[1, 2] > scattering_of(blue).sigma_s[1, 0]


def test_even_layers_reflect_their_colour_and_thin_ones_less() -> None:
    tissue = scattering_of(np.array([0.15, 0.2, 0.3], np.float32))
    mean = np.array([0.02, 0.12, 0.2, 0.05], np.float32)
    layers = np.stack([mean, 0.5 * mean])[None]
    share = layered_share(layers, tissue, mean_mm=mean)
    np.testing.assert_allclose(share[0, 0], 1.0, atol=0.02)
    assert np.all(share[0, 1] < 0.99)
    assert MULTIPLE_SHARE == eye_maps.MULTIPLE_SHARE


def test_noise_shows_no_eye() -> None:
    noise = np.random.Generator(np.random.PCG64(2)).uniform(0, 1, (300, 400, 3))
    assert all(found.score < 0.1 for found in find_candidates(noise.astype(np.float32)))
