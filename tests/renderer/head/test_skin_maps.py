"""The skin's pictures: what they hold, and what their smaller levels pass on as roughness."""

from __future__ import annotations

from collections.abc import Callable

import moderngl
import numpy as np
import pytest

from renderer.head import lid_relief, skin_maps
from renderer.head.buffers import TilePyramid, unroll
from renderer.head.face_mesh import FaceMesh, face_mesh
from renderer.head.lid_layout import ACROSS_MM, MAP_PX
from renderer.head.lid_relief import JUNCTION_MM
from renderer.head.skin_maps import SkinMaps


@pytest.fixture(scope="module")
def face() -> FaceMesh:
    return face_mesh()


@pytest.fixture(scope="module")
def lids(face: FaceMesh) -> np.ndarray:
    return skin_maps.lids_map(face)


def slopes(picture: np.ndarray) -> np.ndarray:
    return (picture[..., :2] / 255.0 - 0.5) * (2 * lid_relief.SLOPE_RANGE)


@pytest.mark.parametrize("make", [skin_maps.relief_tile, skin_maps.colour_tile])
def test_tiles_repeat_without_a_seam_and_average_to_the_middle(
    make: Callable[[], skin_maps.Bytes],
) -> None:
    tile = make().astype(float)
    for axis in (0, 1):
        inside = np.abs(np.diff(tile, axis=axis)).mean()
        across = np.abs(np.take(tile, 0, axis) - np.take(tile, -1, axis)).mean()
        assert across < 1.4 * inside
    middle = (0, 1, 3)
    np.testing.assert_allclose(tile.mean(axis=(0, 1))[list(middle)], 127.5, atol=2.5)


def test_the_lids_crepe_is_finer_than_the_cheeks_relief_and_finite(lids: np.ndarray) -> None:
    assert lids.shape == (1024, 2048, 4)
    skin = slopes(lids)[100:400]
    assert 0.08 < skin.std() < 0.3
    clipped = (np.abs(skin) > 0.99 * lid_relief.SLOPE_RANGE).mean()
    assert clipped < 0.01


def test_wrinkles_follow_the_upper_lid_and_radiate_from_the_outer_canthus(
    lids: np.ndarray,
) -> None:
    """Grooves darken: they reach further along themselves than across."""

    def reach(part: np.ndarray, axis: int) -> float:
        shut = part - part.mean()
        return float((shut * np.roll(shut, 8, axis)).mean() / shut.var())

    openness = lids[512:, :, 2].astype(float)
    upper = openness[90:240, 350:800]
    assert reach(upper, 1) > reach(upper, 0) + 0.1
    temple = np.roll(openness, 60, axis=1)[150:380, :120]
    assert reach(temple, 0) > reach(temple, 1) + 0.1


def test_margins_are_smoother_than_lids(lids: np.ndarray) -> None:
    assert slopes(lids)[8:30].std() < 0.6 * slopes(lids)[100:400].std()


def test_a_redder_line_runs_along_the_lower_margin_where_skin_ends(lids: np.ndarray) -> None:
    texel_mm = ACROSS_MM / MAP_PX[0]
    blood = lids[: MAP_PX[0], 1250:1850, 3].astype(float).mean(axis=1)
    line, beside = (round((JUNCTION_MM + way) / texel_mm) for way in (0.0, 0.32))
    assert blood[line] > blood[beside] + 20.0
    assert abs(int(np.argmax(blood[:40])) - line) * texel_mm < 0.1


def test_skin_between_lashes_and_crease_has_the_finest_crepe(
    lids: np.ndarray, face: FaceMesh
) -> None:
    """Upper lid, middle: more relief from 0.6 to 2.2 mm beyond the lashes than far above."""
    texel_mm = ACROSS_MM / MAP_PX[0]
    edge = round(float(face.lids[0].across_mm[40:50, face.lids[0].rim_row].mean()) / texel_mm)
    plate, above = (
        slopes(lids)[edge + round(low / texel_mm) : edge + round(high / texel_mm), 450:600]
        for low, high in ((0.6, 2.2), (7.0, 9.0))
    )
    assert plate.std() > 1.1 * above.std()


def test_both_eyes_have_skin_of_their_own(lids: np.ndarray) -> None:
    left, right = lids[100:400, :, 2].astype(float), lids[612:912, :, 2].astype(float)
    assert abs(np.corrcoef(left.ravel(), right.ravel())[0, 1]) < 0.3


def test_what_a_smaller_level_hides_of_the_slopes_becomes_roughness(
    gl: moderngl.Context,
) -> None:
    rng = np.random.Generator(np.random.PCG64(1))
    pixels = rng.integers(0, 256, (64, 32, 4)).astype(np.uint8)
    pyramid = TilePyramid(gl, pixels)
    assert pyramid.lost_variance(1.0) == 0.0
    blocks = (pixels[..., :2] / 255.0).reshape(16, 4, 8, 4, 2)
    within = blocks.var(axis=(1, 3)).mean(axis=(0, 1)).sum()
    assert pyramid.lost_variance(4.0) == pytest.approx(within, rel=1e-3)
    lost = [pyramid.lost_variance(2.0**level) for level in range(6)]
    assert (np.diff(lost) > 0).all()


def test_from_further_away_the_maps_lose_their_slopes(gl: moderngl.Context, face: FaceMesh) -> None:
    maps = SkinMaps(gl, face)
    near, far = maps.uniforms(30.0), maps.uniforms(1.0)
    assert max(near["u_lost_variance"]) < 0.01
    for close, distant in zip(near["u_lost_variance"], far["u_lost_variance"], strict=True):
        assert distant > close + 0.01
    assert far["u_relief"].size[0] < near["u_relief"].size[0]


def test_a_seam_gets_vertices_of_its_own() -> None:
    turn = np.array([0.0, 0.4, 0.8])
    triangles = np.array([[0, 1, 2], [2, 0, 1], [1, 2, 2]])
    source, renumbered = unroll(turn, triangles)
    np.testing.assert_array_equal(source, [0, 1, 2, 0, 1])
    np.testing.assert_array_equal(renumbered, [[3, 4, 2], [2, 3, 4], [1, 2, 2]])
    whole = turn[source] + (np.arange(5) >= 3)
    assert np.ptp(whole[renumbered], axis=1).max() < 0.7
