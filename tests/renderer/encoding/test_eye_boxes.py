"""The encoder's boxes cover the eyes in every frame and stay on the picture."""

from __future__ import annotations

import numpy as np
import pytest

from renderer.clip import DISTANCES, ClipSpec
from renderer.detail import Detail
from renderer.encoding.eye_boxes import eye_boxes, frame_rectangles

LOW = Detail.uniform("low")


@pytest.mark.parametrize("distance", DISTANCES)
def test_the_boxes_hold_both_irises_in_every_frame(distance: str) -> None:
    spec = ClipSpec(left=LOW, right=LOW, distance=distance, duration_s=0.2)
    covered = np.zeros((spec.height, spec.width), bool)
    for box in eye_boxes(spec):
        assert 0 <= box.x < box.x + box.width <= spec.width
        assert 0 <= box.y < box.y + box.height <= spec.height
        covered[box.y : box.y + box.height, box.x : box.x + box.width] = True
    for number in range(spec.frame_count):
        for rows, columns in frame_rectangles(spec, number):
            row = (rows.start + rows.stop) // 2
            middle = (columns.start + columns.stop) / 2
            half_iris = (columns.stop - columns.start) / 2.6 / 2
            iris = covered[row, round(middle - half_iris) + 1 : round(middle + half_iris) - 1]
            assert iris.all(), (number, distance)


def test_what_surrounds_the_eyes_is_left_out() -> None:
    spec = ClipSpec(left=LOW, right=LOW, distance="macroscopic", duration_s=0.2)
    share = sum(box.width * box.height for box in eye_boxes(spec)) / (spec.width * spec.height)
    assert 0.15 < share < 0.25
