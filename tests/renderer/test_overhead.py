"""The scene from above: who and what is in the picture."""

from __future__ import annotations

import pytest

from renderer.camera import IRIS_PX, radius_of_px, views
from renderer.clip import ClipSpec
from renderer.clip_values import CROWDS
from renderer.crowd.stage import FRONT, GROUND_MM, members
from renderer.detail import Detail
from renderer.overhead import on_picture, overhead_view, reach_mm

LOW = Detail.uniform("low")


def spec_of(crowd: int) -> ClipSpec:
    return ClipSpec(left=LOW, right=LOW, crowd=crowd, width=320, height=180)


@pytest.mark.parametrize("crowd", CROWDS)
@pytest.mark.parametrize("distance", IRIS_PX)
def test_everybody_and_the_camera_are_in_the_picture(crowd: int, distance: str) -> None:
    spec = spec_of(crowd)
    radius_mm = radius_of_px(IRIS_PX[distance])
    view = overhead_view(spec, reach_mm=reach_mm(radius_mm))
    points = [
        (x, y, z)
        for member in members(crowd)
        if member.path == FRONT  # others walk past behind them, in and out of the picture
        for x, z in (member.place_mm(time_s) for time_s in (0.0, 2.5, 5.0))
        for y in (GROUND_MM, 150.0)
    ]
    for azimuth_deg in (-180.0, -60.0, 0.0, 60.0):
        (camera, *_) = views(spec, azimuth_deg, distance_px=IRIS_PX[distance])
        points.append(tuple(camera.position_mm))
    places = [on_picture(view, point) for point in (*points, (0.0, 0.0, 0.0))]
    assert all(place and 0.0 < place[0] < 1.0 and 0.0 < place[1] < 1.0 for place in places)
    # And no wider than that.
    across, down = ([place[axis] for place in places if place] for axis in (0, 1))
    if crowd and distance in ("macroscopic", "near"):
        assert max(max(across) - min(across), max(down) - min(down)) > 0.6


def test_the_picture_changes_by_steps_as_the_camera_goes_away() -> None:
    assert [reach_mm(away) for away in (170.0, 1300.0, 1301.0, 5020.0)] == [
        *(1300.0, 1300.0, 2600.0, 5200.0)
    ]
