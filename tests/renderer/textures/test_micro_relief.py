"""The micro-relief of skin: depth, spacing, pores; it tiles and repeats nothing."""

from __future__ import annotations

import numpy as np
import pytest

from renderer.textures import micro_relief
from renderer.textures.micro_relief import FACE_NETS, Field, Net, Tile

TILE = Tile(16.0, 512)
# Half as many cells on a tile of half the edge: the face's own relief on a quarter of its area.
NETS = tuple(
    Net((net.cells[0] // 2, net.cells[1] // 2), net.depth_mm, net.width_mm, net.bend_mm, net.tilt)
    for net in FACE_NETS
)


def rng(seed: int = 1) -> np.random.Generator:
    return np.random.Generator(np.random.PCG64(seed))


@pytest.fixture(scope="module")
def height() -> Field:
    return micro_relief.relief(rng(), TILE, nets=NETS, pores=220)


def test_the_relief_is_as_deep_as_skin(height: Field) -> None:
    """Rz of the face's skin without wrinkles: some 40 to 140 um."""
    low, high = np.percentile(height, (0.5, 99.5))
    assert 0.040 < high - low < 0.140
    x, y = micro_relief.slopes(height, TILE)
    assert 0.08 < np.sqrt((x * x + y * y).mean()) < 0.3


def test_furrows_are_spaced_like_the_skins_own() -> None:
    """Primary and secondary lines of the face cross a straight line every 0.2 to 0.5 mm."""
    height = micro_relief.relief(rng(), TILE, nets=NETS, pores=0)
    furrow = height - micro_relief.blurred(height, TILE, 0.15)
    deep = furrow < -0.15 * furrow.std()
    starts = (deep & ~np.roll(deep, 1, axis=1)).sum(axis=1).mean()
    assert 0.2 < TILE.edge_mm / starts < 0.5


def test_the_relief_tiles_without_a_seam(height: Field) -> None:
    for axis in (0, 1):
        step = np.abs(np.roll(height, -1, axis) - height)
        across = np.take(step, -1, axis).mean()
        assert across == pytest.approx(step.mean(), rel=0.25)


def test_nothing_repeats_within_a_tile(height: Field) -> None:
    spectrum = np.abs(np.fft.fft2(height)) ** 2
    echo = np.fft.ifft2(spectrum).real
    echo /= echo[0, 0]
    y, x = np.indices(echo.shape)
    away = np.hypot(np.minimum(x, 512 - x), np.minimum(y, 512 - y)) * TILE.texel_mm
    assert echo[away > 1.5].max() < 0.15


def test_pores_are_pits_of_a_tenth_to_a_third_of_a_millimetre() -> None:
    pits = micro_relief.pits(rng(), TILE, count=225)
    assert pits.min() >= 0.0
    assert 0.5 < pits.max() <= 1.2
    share = (pits > 0.1).mean() * TILE.edge_mm**2 / 225  # mm^2 a pore
    assert np.pi * 0.05**2 < share < np.pi * 0.165**2


def test_openness_is_full_on_the_flat_and_nought_at_the_bottom() -> None:
    field = np.zeros((512, 512))
    field[100:103, 100:103] = -0.2
    shut = micro_relief.openness(field, TILE, reach_mm=0.3, depth_mm=0.1)
    assert shut[101, 101] == 0.0
    assert shut[300, 300] == pytest.approx(1.0, abs=1e-6)


def test_the_same_seed_gives_the_same_relief(height: Field) -> None:
    again = micro_relief.relief(rng(), TILE, nets=NETS, pores=220)
    np.testing.assert_array_equal(height, again)
    other = micro_relief.relief(rng(2), TILE, nets=NETS, pores=220)
    assert abs(np.corrcoef(height.ravel(), other.ravel())[0, 1]) < 0.1
