"""The white of the eye: not white, veined, smooth enough, the same for the same seed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from renderer.eye import sclera
from renderer.eye.scleral_vessels import vessel_density

SIZE_PX = 512


@pytest.fixture(scope="module", autouse=True)
def small_maps(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Bake at SIZE_PX instead of 2048, into a cache of our own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("OCULARIST_CACHE", str(tmp_path_factory.mktemp("bakes")))
        patch.setattr(sclera, "BASE_PX", SIZE_PX)
        yield


@pytest.fixture(scope="module")
def maps() -> sclera.ScleraMaps:
    return sclera.sclera_maps(1, size_px=SIZE_PX)


@pytest.fixture(scope="module")
def density() -> Any:
    return vessel_density(1, 1024)


def plane(size_px: int) -> tuple[Any, Any, Any]:
    line = ((np.arange(size_px) + 0.5) / size_px * 2.0 - 1.0) * sclera.HALF_SIZE_MM
    x, y = np.meshgrid(line, line)
    return x, y, np.hypot(x, y)


def test_the_white_is_a_warm_light_grey(maps: sclera.ScleraMaps) -> None:
    _, _, arc = plane(SIZE_PX)
    red, green, blue = maps.albedo[(arc > 7.0) & (arc < 11.0)].mean(axis=0)
    assert 0.60 < red < 0.75
    assert red > green > blue > 0.42
    assert maps.albedo.max() < 0.85


def test_the_nose_side_is_pinker_and_both_corners_yellower(maps: sclera.ScleraMaps) -> None:
    x, y, _ = plane(SIZE_PX)
    band = np.abs(y) < 4.0
    nose = maps.albedo[band & (x > 14.0) & (x < 18.0)].mean(axis=0)
    temple = maps.albedo[band & (x < -14.0) & (x > -18.0)].mean(axis=0)
    middle = maps.albedo[(np.abs(x) < 4.0) & (y > 7.5) & (y < 10.0)].mean(axis=0)
    assert nose[1] / nose[0] < temple[1] / temple[0]
    assert temple[2] / temple[1] < middle[2] / middle[1]


def test_vessels_cover_a_little_of_the_visible_white(density: Any) -> None:
    _, _, arc = plane(1024)
    band = (arc > 6.8) & (arc < 15.0)
    front, deep = density
    assert 0.02 < (front[band] > 0.1).mean() < 0.18
    assert 0.005 < (deep[band] > 0.1).mean() < 0.15


def test_no_vessel_lies_on_the_cornea(maps: sclera.ScleraMaps) -> None:
    _, _, arc = plane(SIZE_PX)
    inside = maps.albedo[arc < sclera.LIMBUS_ARC_MM - 0.3]
    assert (inside[:, 1] / inside[:, 0]).min() > 0.90


def test_vessels_are_red_against_the_white(maps: sclera.ScleraMaps, density: Any) -> None:
    front = density[0].reshape(SIZE_PX, 2, SIZE_PX, 2).mean(axis=(1, 3))
    _, _, arc = plane(SIZE_PX)
    band = (arc > 7.5) & (arc < 12.0)
    veined = maps.albedo[band & (front > 0.3)].mean(axis=0)
    bare = maps.albedo[band & (front < 0.01)].mean(axis=0)
    assert veined[1] / veined[0] < 0.92 * bare[1] / bare[0]


def test_deep_vessels_are_softer_than_those_in_front(density: Any) -> None:
    def sharpness(field: Any) -> float:
        steps = np.abs(np.diff(field, axis=1)).max() / field.max()
        return float(steps)

    front, deep = density
    assert sharpness(deep) < 0.6 * sharpness(front)


def test_normals_are_unit_and_tilt_little(maps: sclera.ScleraMaps) -> None:
    np.testing.assert_allclose(np.linalg.norm(maps.normal, axis=-1), 1.0, atol=1e-5)
    tilt_deg = np.degrees(np.arccos(np.clip(maps.normal[..., 2], -1.0, 1.0)))
    _, _, arc = plane(SIZE_PX)
    assert tilt_deg.max() < sclera.MAX_TILT_DEG
    assert tilt_deg[arc > 7.0].mean() > 0.3
    assert tilt_deg[arc < sclera.LIMBUS_ARC_MM - 0.4].max() < 0.2


def test_smaller_sizes_are_the_same_eye(maps: sclera.ScleraMaps) -> None:
    small = sclera.sclera_maps(1, size_px=128)
    assert small.albedo.shape == small.normal.shape == (128, 128, 3)
    np.testing.assert_allclose(
        small.albedo.mean(axis=(0, 1)), maps.albedo.mean(axis=(0, 1)), rtol=1e-3
    )


def test_size_one_is_the_mean_of_the_visible_white(maps: sclera.ScleraMaps) -> None:
    _, y, arc = plane(SIZE_PX)
    seen = (arc > sclera.LIMBUS_ARC_MM + 0.4) & (arc < 15.0) & (np.abs(y) < 7.2)
    off = sclera.mean_albedo(1)
    np.testing.assert_allclose(off, maps.albedo[seen].mean(axis=0), rtol=2e-3)


def test_the_map_ends_at_its_polar_angle() -> None:
    assert pytest.approx(math.radians(110.0) * 11.75) == sclera.HALF_SIZE_MM
    assert pytest.approx(6.12, abs=0.02) == sclera.LIMBUS_ARC_MM


def test_equal_seeds_give_equal_bytes_and_others_do_not() -> None:
    first, again = sclera.bake_sclera(5, size_px=128), sclera.bake_sclera(5, size_px=128)
    other = sclera.bake_sclera(6, size_px=128)
    assert all(first[name].tobytes() == again[name].tobytes() for name in first)
    assert first["albedo"].tobytes() != other["albedo"].tobytes()


def test_an_odd_size_is_refused() -> None:
    with pytest.raises(ValueError, match="300 is no map size; choose a power of two"):
        sclera.sclera_maps(1, size_px=300)
