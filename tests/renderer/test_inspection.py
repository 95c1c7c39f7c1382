"""Frames from anywhere with their counters, in real GL."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import moderngl
import numpy as np
import pytest

from renderer.camera import radius_of_px
from renderer.clip import ClipSpec
from renderer.crowd.stage import FRONT, STAGE
from renderer.detail import Detail
from renderer.frame.frame import FrameRenderer
from renderer.gl.context import identify
from renderer.inspection import Inspector, Viewpoint, at_least_as_sharp
from renderer.overhead import on_picture, overhead_view, reach_mm
from renderer.scene import Scene
from renderer.view import View

LOW = Detail.uniform("low")
SPEC = ClipSpec(left=LOW, right=LOW, distance="near", width=192, height=108, crowd=0)


@pytest.fixture(scope="module")
def inspector(gl: moderngl.Context, standard_scene: Scene) -> Inspector:
    scenes = [standard_scene]

    def renderer(spec: ClipSpec, **options: Any) -> FrameRenderer:
        made = FrameRenderer(gl, spec, scene=scenes[-1], **options)
        scenes.append(made.scene)
        return made

    studio: Any = SimpleNamespace(
        gl=gl, gl_renderer=identify(gl).renderer, renderer=renderer, close=lambda: None
    )
    return Inspector(studio)


def test_the_camera_goes_where_it_is_sent(inspector: Inspector) -> None:
    near = inspector.shot(SPEC, Viewpoint(distance_px=320.0))
    far = inspector.shot(SPEC, Viewpoint(distance_px=80.0))
    aside = inspector.shot(SPEC, Viewpoint(distance_px=80.0, azimuth_deg=40.0, elevation_deg=20.0))
    assert near.iris_px == pytest.approx((32.0, 32.0), rel=0.05)
    assert far.iris_px == pytest.approx((8.0, 8.0), rel=0.05)
    assert near.visible_px[0] > 8 * far.visible_px[0] > 0
    assert np.abs(aside.pixels.astype(int) - far.pixels).mean() > 5.0
    assert near.frame_ms > 0.0
    assert near.lods == ("low", "low")


def test_triangles_follow_the_tessellation_and_lines_show_it(inspector: Inspector) -> None:
    fine = SPEC.swapped()
    fine = ClipSpec(**{**vars(SPEC), "left": LOW.with_levels(tessellation="medium")})
    few, many = (inspector.shot(spec, Viewpoint(distance_px=320.0)) for spec in (SPEC, fine))
    # The eye, and its outlines.
    assert many.triangles - few.triangles == pytest.approx(2 * 350, rel=0.25)
    assert many.lods == ("own levels", "low")
    lines = inspector.shot(SPEC, Viewpoint(distance_px=320.0, wireframe=True))
    assert np.abs(lines.pixels.astype(int) - few.pixels).max() > 40
    assert lines.visible_px == few.visible_px  # of the eye, not of its lines


def test_one_eye_alone_has_the_whole_picture(inspector: Inspector) -> None:
    halves = ClipSpec(**{**vars(SPEC), "distance": "macroscopic"})
    both = inspector.shot(halves, Viewpoint())
    left = inspector.shot(halves, Viewpoint(eyes=(0,)))
    assert both.visible_px[1] > 0
    assert left.visible_px[1] == 0
    assert left.visible_px[0] >= both.visible_px[0] > 0


def above(spec: ClipSpec, viewpoint: Viewpoint) -> View:
    return overhead_view(spec, reach_mm=reach_mm(radius_of_px(viewpoint.distance_px)))


def test_the_scene_from_above_shows_the_person_where_it_says(inspector: Inspector) -> None:
    view = above(SPEC, Viewpoint())
    seen = inspector.overhead(SPEC, Viewpoint())
    place = on_picture(view, (0.0, -50.0, -80.0))
    assert place is not None
    row, column = int(place[1] * SPEC.height), int(place[0] * SPEC.width)
    assert 0 < row < SPEC.height
    assert 0 < column < SPEC.width
    grass = seen.pixels[10:20, 10:20].reshape(-1, 3).mean(axis=0)
    person = seen.pixels[row - 1 : row + 2, column - 1 : column + 2].reshape(-1, 3).mean(axis=0)
    assert np.abs(person - grass).max() > 25.0
    assert on_picture(view, 2.0 * view.position_mm) is None


def test_the_scene_from_above_shows_those_whom_only_the_eyes_see(
    inspector: Inspector, monkeypatch: pytest.MonkeyPatch
) -> None:
    alone, together = (replace(SPEC, crowd=crowd) for crowd in (0, 5))
    monkeypatch.setattr("renderer.overhead.members", lambda _crowd: STAGE)  # one camera for both
    view = above(together, Viewpoint())
    amid = Viewpoint(time_s=FRONT.centre_s)  # the walker passes the face
    empty, seen = (inspector.overhead(spec, amid).pixels for spec in (alone, together))
    changed = np.abs(seen.astype(int) - empty).max(axis=-1) > 40
    for member in STAGE[:2]:  # the walker and the waver
        x, z = member.place_mm(amid.time_s)
        place = on_picture(view, (x, -300.0, z))
        assert place is not None
        row, column = int(place[1] * SPEC.height), int(place[0] * SPEC.width)
        assert changed[row - 2 : row + 3, column - 2 : column + 3].mean() > 0.6, member.action
    before, after = (inspector.shot(spec, amid).pixels for spec in (alone, together))
    assert np.abs(after.astype(int) - before).max(axis=-1).mean() < 5.0  # a clip still hides them


def test_cubes_of_the_clips_distance_give_way_to_larger_ones_nearer_by() -> None:
    auto = replace(SPEC, cube_size="auto")
    assert at_least_as_sharp(auto, 160.0) is auto
    assert at_least_as_sharp(auto, 161.0) == replace(auto, cube_size="table")
    assert at_least_as_sharp(SPEC, 1000.0) is SPEC
