import numpy as np
import pytest

from renderer.park.sky import LUMINANCE, aureole, clear_sky, rgb_from_yxy


@pytest.mark.parametrize("elevation_deg", [10.0, 40.0, 75.0])
def test_a_white_wall_facing_the_sun_leaves_with_radiance_one(elevation_deg: float) -> None:
    sky = clear_sky(-35.0, elevation_deg)
    rng = np.random.Generator(np.random.PCG64(1))
    directions = rng.normal(size=(200_000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    directions[:, 1] = np.abs(directions[:, 1])
    from_sky = (np.maximum(directions @ sky.sun_direction, 0) @ sky.radiance(directions)) * (
        2 * np.pi / len(directions)
    )
    assert (sky.sun_irradiance + from_sky) @ LUMINANCE / np.pi == pytest.approx(1.0, abs=0.02)


def test_azimuth_zero_is_before_the_face_and_positive_to_the_viewers_right() -> None:
    np.testing.assert_allclose(clear_sky(0.0, 0.0).sun_direction, [0, 0, 1], atol=1e-12)
    np.testing.assert_allclose(clear_sky(90.0, 0.0).sun_direction, [1, 0, 0], atol=1e-12)
    np.testing.assert_allclose(clear_sky(17.0, 90.0).sun_direction, [0, 1, 0], atol=1e-12)


def test_a_low_sun_is_redder_than_a_high_one() -> None:
    low, high = (clear_sky(0.0, elevation).sun_irradiance for elevation in (6.0, 60.0))
    assert low[0] / low[2] > 2 * high[0] / high[2]


def test_the_sky_opposite_the_sun_is_blue_and_brightest_around_the_sun() -> None:
    sky = clear_sky(0.0, 40.0)
    away, near = sky.radiance(np.array([[0.0, 0.8, -0.6], [0.0, 0.7071, 0.7071]]))
    assert away[2] > 1.5 * away[0]
    assert near @ LUMINANCE > 3 * (away @ LUMINANCE)


def test_haze_sends_a_twentieth_of_the_beam_from_around_the_disc() -> None:
    angle = np.radians(np.linspace(0.0, 60.0, 20001))
    ring = 2 * np.pi * np.sin(angle) * aureole(angle)
    assert np.trapezoid(ring, angle) == pytest.approx(0.05, rel=0.03)
    sky = clear_sky(0.0, 40.0)
    tilt = np.radians([40.0, 41.0, 43.0, 50.0])
    glow = sky.radiance(np.stack([0 * tilt, np.sin(tilt), np.cos(tilt)], axis=1)) @ LUMINANCE
    assert (np.diff(glow) < 0).all()
    assert glow[0] > 8 * glow[3]


def test_the_white_point_gives_equal_channels() -> None:
    rgb = rgb_from_yxy(np.array([[0.7, 0.3127, 0.3290]]))
    np.testing.assert_allclose(rgb, 0.7, atol=2e-3)
