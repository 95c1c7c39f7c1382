import hashlib

import numpy as np
import pytest

from renderer.park.buildings import Building, paint_building
from renderer.park.panorama import LOWEST_DEG, STEP_DEG, WIDTH, Panorama
from renderer.park.skyline import park_skyline
from renderer.textures.tiling import tiling_noise


@pytest.fixture(scope="module")
def skyline() -> dict[str, np.ndarray]:
    return park_skyline()


def test_sky_shows_above_the_trees_everywhere_and_gaps_remain_at_the_horizon(skyline) -> None:
    covered = skyline["albedo"][..., 3] > 127
    horizon = round(-LOWEST_DEG / STEP_DEG)
    assert not covered[-60:].any()
    assert 0.4 < covered[horizon + 20].mean() < 0.95


def test_normals_of_what_is_painted_face_the_viewer(skyline) -> None:
    covered = skyline["albedo"][..., 3] == 255
    normals = skyline["shape"][..., :3].astype(float) / 255 * 2 - 1
    azimuth = np.radians((np.arange(WIDTH) + 0.5) * STEP_DEG - 180)
    away = np.stack([np.sin(azimuth), np.zeros(WIDTH), np.cos(azimuth)], axis=-1)
    outwards = (normals * away).sum(axis=-1)[covered]
    assert outwards.mean() < -0.2


def test_a_house_on_the_seam_of_the_panorama_is_whole() -> None:
    panorama = Panorama()
    house = Building(180.0, 80.0, 20.0, 4, (0.5, 0.5, 0.5), (0.1, 0.1, 0.1))
    paint_building(panorama, house, np.random.Generator(np.random.PCG64(1)))
    row = panorama.albedo[round(3.0 / STEP_DEG - LOWEST_DEG / STEP_DEG), :, 3]
    half = np.degrees(np.arctan(10.0 / 80.0)) / STEP_DEG
    assert row[: int(half) - 1].min() == row[-int(half) + 1 :].min() == 1.0
    assert row[int(half) + 2 : -int(half) - 2].max() == 0.0


def test_noise_is_uniform_tiles_and_repeats_bit_for_bit() -> None:
    noise = tiling_noise()
    assert hashlib.sha256(noise.tobytes()).digest() == hashlib.sha256(tiling_noise()).digest()
    for channel in range(4):
        assert np.ptp(np.bincount(noise[..., channel].ravel(), minlength=256)) == 0
    smooth = noise[..., 0].astype(int)
    step = np.abs(np.diff(smooth, axis=0)).mean()
    assert np.abs(smooth[0] - smooth[-1]).mean() < 1.5 * step
