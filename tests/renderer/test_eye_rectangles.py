"""Rectangles that hold the eyes."""

from __future__ import annotations

import pytest

from renderer.clip import ClipSpec
from renderer.clip_values import DISTANCES
from renderer.detail import Detail
from renderer.eye_rectangles import eye_rectangles, frame_rectangles

LOW = Detail.uniform("low")


@pytest.mark.parametrize("distance", DISTANCES)
def test_rectangles_stay_on_the_picture_and_do_not_overlap(distance: str) -> None:
    spec = ClipSpec(left=LOW, right=LOW, distance=distance)
    for azimuth in (-60.0, 0.0, 60.0):
        (rows_l, cols_l), (rows_r, cols_r) = eye_rectangles(spec, azimuth)
        for rows, cols in ((rows_l, cols_l), (rows_r, cols_r)):
            assert 0 <= rows.start < rows.stop <= spec.height
            assert 0 <= cols.start < cols.stop <= spec.width
        assert (cols_l.start + cols_l.stop) < (cols_r.start + cols_r.stop)


def test_a_frame_has_the_rectangles_of_its_camera() -> None:
    spec = ClipSpec(left=LOW, right=LOW, motion="approach", approach_azimuth_deg=15.0)
    last = spec.frame_count - 1
    assert frame_rectangles(spec, last) == eye_rectangles(spec, 15.0, distance_px=160.0)
    first, end = (frame_rectangles(spec, number)[0][1] for number in (0, last))
    assert end.stop - end.start > 8 * (first.stop - first.start)
