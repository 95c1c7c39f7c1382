"""Distances and orbit, against plain projection."""

from __future__ import annotations

import math

import numpy as np
import pytest

from renderer.camera import IRIS_PX, LIMBUS_Z_MM, camera_radius_mm, iris_px, iris_px_of_frame, views
from renderer.clip import ClipSpec
from renderer.clip_values import DISTANCES
from renderer.detail import Detail
from renderer.eye.place import eye_centre_mm
from renderer.view import View

LOW = Detail.uniform("low")


def project(view: View, point_mm: np.ndarray) -> np.ndarray:
    clip = view.projection @ view.view_matrix @ np.append(point_mm, 1.0)
    x, y, width, height = view.rectangle
    return np.array(
        [x + (clip[0] / clip[3] + 1) / 2 * width, y + (clip[1] / clip[3] + 1) / 2 * height]
    )


@pytest.mark.parametrize("distance", DISTANCES)
def test_the_iris_has_its_size_in_pixels_when_seen_from_the_front(distance: str) -> None:
    spec = ClipSpec(left=LOW, right=LOW, distance=distance)
    for view in views(spec, 0.0):
        for eye in view.eyes:
            limbus = eye_centre_mm(eye) + [0, 0, LIMBUS_Z_MM]
            left, right = (project(view, limbus + [dx, 0, 0]) for dx in (-5.85, 5.85))
            assert right[0] - left[0] == pytest.approx(IRIS_PX[distance], rel=1e-4)
    assert iris_px(spec, 0.0) == pytest.approx((IRIS_PX[distance],) * 2, rel=1e-5)
    half = spec.resized(960, 540)
    assert iris_px(half, 0.0) == pytest.approx((IRIS_PX[distance] / 2,) * 2, rel=1e-5)


def test_one_eye_alone_has_the_whole_picture_at_macroscopic() -> None:
    (view,) = views(ClipSpec(left=LOW, right=LOW), 0.0, eyes=(1,))
    assert view.rectangle == (0, 0, 1920, 1080)
    assert view.eyes == (1,)
    limbus = eye_centre_mm(1) + [0, 0, LIMBUS_Z_MM]
    left, right = (project(view, limbus + [dx, 0, 0]) for dx in (-5.85, 5.85))
    assert (left + right) / 2 == pytest.approx([960, 540], abs=0.01)
    assert right[0] - left[0] == pytest.approx(IRIS_PX["macroscopic"], rel=1e-4)


def test_one_eye_alone_leaves_the_other_views_as_they_are() -> None:
    spec = ClipSpec(left=LOW, right=LOW, distance="near")
    (both,), (one,) = views(spec, 20.0), views(spec, 20.0, eyes=(0,))
    assert one.eyes == (0,)
    np.testing.assert_array_equal(one.view_matrix, both.view_matrix)
    assert one.rectangle == both.rectangle


def test_the_cameras_stand_where_the_design_says() -> None:
    radii_m = [camera_radius_mm(distance) / 1000 for distance in DISTANCES]
    assert radii_m == pytest.approx([0.17, 0.38, 1.5, 5.0], rel=0.08)


def test_macroscopic_shows_each_eye_in_the_middle_of_its_half() -> None:
    spec = ClipSpec(left=LOW, right=LOW)
    for azimuth in (-60.0, 0.0, 35.0):
        left, right = views(spec, azimuth)
        assert (left.eyes, right.eyes) == ((0,), (1,))
        assert project(left, eye_centre_mm(0)) == pytest.approx([480, 540], abs=0.01)
        assert project(right, eye_centre_mm(1)) == pytest.approx([1440, 540], abs=0.01)


@pytest.mark.parametrize("distance", ["near", "medium", "far"])
def test_elsewhere_one_camera_turns_about_the_middle_between_the_eyes(distance: str) -> None:
    spec = ClipSpec(left=LOW, right=LOW, distance=distance)
    (view,) = views(spec, 60.0)
    assert project(view, np.zeros(3)) == pytest.approx([960, 540], abs=0.01)
    bearing = math.degrees(math.atan2(view.position_mm[0], view.position_mm[2]))
    assert bearing == pytest.approx(60.0)
    near_eye, far_eye = eye_centre_mm(1), eye_centre_mm(0)
    assert np.linalg.norm(view.position_mm - near_eye) < np.linalg.norm(view.position_mm - far_eye)


def test_an_approach_has_one_camera_and_the_sizes_it_names() -> None:
    spec = ClipSpec(
        left=LOW,
        right=LOW,
        distance="macroscopic",
        motion="approach",
        approach_start_px=20.0,
        approach_end_px=240.0,
    )
    for frame, size in ((0, 20.0), (spec.frame_count - 1, 240.0)):
        assert iris_px_of_frame(spec, frame) == pytest.approx((size, size), rel=1e-5)
        (view,) = views(spec, 0.0, distance_px=spec.distance_px(frame))
        assert view.eyes == (0, 1)
    assert iris_px(spec, 0.0)[0] == pytest.approx(240.0, rel=1e-5), "without a frame: its end"
    both = [project(view, eye_centre_mm(eye))[0] for eye in (0, 1)]
    assert both[0] > 0.5 * 2.6 * 240.0
    assert both[1] < 1920 - 0.5 * 2.6 * 240.0
