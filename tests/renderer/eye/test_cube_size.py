"""The cubes' automatic size: from the cornea's mirror, never above the table's."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye.anatomy import CORNEA_RADIUS_MM
from renderer.eye.cube_size import FINER, cube_px, largest_iris_px, shown_cube_px

ULTRA, LOW = Detail.uniform("ultra"), Detail.uniform("low")


def clip(**values: Any) -> ClipSpec:
    return ClipSpec(**{"left": ULTRA, "right": LOW, "cube_size": "auto", **values})


def mirrored_turn_rad(iris_px: float) -> float:
    """Return the angle between the mirrored rays of two neighbouring pixels at the apex."""
    x_mm = 11.7 / iris_px
    tilt = math.asin(x_mm / CORNEA_RADIUS_MM)
    normal = np.array([math.sin(tilt), math.cos(tilt)])
    view = np.array([0.0, -1.0])
    mirrored = view - 2 * (view @ normal) * normal
    return math.acos(mirrored @ np.array([0.0, 1.0]))


@pytest.mark.parametrize("iris_px", [5.0, 12.0, 40.0, 160.0, 350.0, 385.0, 700.0])
def test_two_texels_fit_into_a_pixels_angle_and_four_do_not(iris_px: float) -> None:
    texel_rad = 0.5 * math.pi / shown_cube_px(iris_px)
    assert 1 / (2 * FINER) < texel_rad / mirrored_turn_rad(iris_px) <= 1.001 / FINER


def test_the_size_follows_the_distance_and_the_picture() -> None:
    sizes = {d: cube_px(ULTRA, clip(distance=d)) for d in ("macroscopic", "near", "medium", "far")}
    assert sizes == {"macroscopic": 512, "near": 256, "medium": 64, "far": 16}
    assert cube_px(ULTRA, clip(width=3840, height=2160)) == 1024


def test_auto_never_exceeds_the_table_and_the_table_is_the_default() -> None:
    assert cube_px(Detail.uniform("medium"), clip()) == 128
    assert cube_px(LOW, clip()) == 0
    assert cube_px(ULTRA, clip(width=7680, height=4320)) == 2048
    assert cube_px(ULTRA, ClipSpec(left=ULTRA, right=ULTRA)) == 2048


def test_an_approach_needs_what_its_nearest_end_shows() -> None:
    ends = {"motion": "approach", "approach_start_px": 160.0, "approach_end_px": 12.0}
    there = clip(**ends)
    back = clip(**ends | {"approach_start_px": 12.0, "approach_end_px": 160.0})
    assert largest_iris_px(there) == largest_iris_px(back) == pytest.approx(176.0)
    assert cube_px(ULTRA, there) == 256


def test_old_clips_keep_their_names_and_auto_ones_have_others() -> None:
    assert ClipSpec(left=LOW, right=ULTRA).clip_id == "123a732dd9bed0c56b3b"
    assert clip().clip_id != clip(cube_size="table").clip_id


def test_an_unknown_size_is_told() -> None:
    with pytest.raises(ValueError, match='cube_size: unknown value "2048"; choose one of table'):
        clip(cube_size="2048")
