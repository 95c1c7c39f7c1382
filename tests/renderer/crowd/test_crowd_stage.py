"""Thirty people: where they stand, whom the picture needs, whose meshes they share."""

from __future__ import annotations

import moderngl
import numpy as np
import pytest

from renderer.camera import camera_radius_mm, views
from renderer.clip import ClipSpec
from renderer.clip_values import CROWDS, DISTANCES
from renderer.crowd.bodies import build_figures
from renderer.crowd.cast import CAST, TEMPLATES
from renderer.crowd.crowd import Crowd
from renderer.crowd.culling import in_view
from renderer.crowd.eye_groups import IRISES
from renderer.crowd.figures import Figure
from renderer.crowd.stage import CIRCLE, STAGE, members
from renderer.detail import Detail
from renderer.light import Light, Sky

LOW = Detail.uniform("low")
SUN = np.array([-0.44, 0.64, 0.63]) / np.linalg.norm([-0.44, 0.64, 0.63])


@pytest.fixture(scope="module")
def figures() -> tuple[Figure, ...]:
    return build_figures(members(30))


@pytest.fixture(scope="module")
def crowd(gl: moderngl.Context) -> Crowd:
    sh = np.zeros((9, 3))
    sh[0] = 1.0
    lit = gl.texture((2, 2), 1, np.ones(4, np.float32).tobytes(), dtype="f4")
    light = Light(
        Sky(sun_direction=SUN, sun_irradiance=np.full(3, 2.0), ambient_sh=sh),
        lit,
        np.eye(4, dtype=np.float32),
    )
    return Crowd(gl, ClipSpec(left=LOW, right=LOW, crowd=30), light)


def test_a_crowd_is_as_large_as_it_says_and_begins_with_the_five() -> None:
    assert [len(members(crowd)) for crowd in CROWDS] == [0, 5, 10, 30]
    for crowd in CROWDS[1:]:
        assert members(crowd)[:5] == STAGE


def test_nobody_walks_into_anybody() -> None:
    for time_s in np.arange(0.0, 12.0, 0.25):
        places = np.array([member.place_mm(time_s) for member in CIRCLE])
        apart = np.linalg.norm(places[:, None] - places[None], axis=2) + 1e6 * np.eye(len(places))
        apart[0, 1] = apart[1, 0] = 1e6  # the five's walker passes the waver as he always did
        assert apart.min() > 600.0
        assert np.linalg.norm(places, axis=1).min() > 900.0, "the main character stands here"


@pytest.mark.parametrize("distance", DISTANCES)
def test_nobody_comes_between_the_camera_and_the_face(distance: str) -> None:
    radius = camera_radius_mm(distance)
    for member in (member for member in CIRCLE if member.is_shown):
        for time_s in (0.0, 2.5, 5.0):
            place = np.array(member.place_mm(time_s))
            for camera in np.radians(np.linspace(-60, 60, 25)):
                towards = np.array([np.sin(camera), np.cos(camera)])
                before, aside = place @ towards, abs(place @ [towards[1], -towards[0]])
                # The face and shoulders fill 250 mm around the line of sight; a body 300 mm.
                if 0 < before < radius:
                    assert (aside - 300.0) * radius / (radius - before) > 120.0
                assert np.linalg.norm(place - radius * towards) > 500.0


def test_eight_meshes_dress_thirty_people(figures: tuple[Figure, ...]) -> None:
    assert len({id(figure.body.positions_mm) for figure in figures}) <= len(TEMPLATES) == 8
    looks = {(p.body, p.top, p.bottom, p.hair) for p in CAST}
    assert len(looks) == len(CAST) == 30
    assert {person.eye for person in CAST} <= set(IRISES)
    for figure in figures:
        height = figure.scale * np.ptp(figure.body.positions_mm[:, 1])
        assert height == pytest.approx(figure.member.person.stature_mm, rel=0.03)
        surface = figure.body.surface
        assert (surface[:, :3] >= 0).all()
        top = (np.abs(surface[:, :3] - figure.member.person.top) < 1e-9).all(axis=1)
        assert top.sum() > 200


def test_a_sphere_is_culled_only_when_it_is_wholly_outside() -> None:
    view = views(ClipSpec(left=LOW, right=LOW, distance="far", width=320, height=180), 0.0)[0]
    matrix = view.projection @ view.view_matrix
    edge_mm = camera_radius_mm("far") * np.tan(np.radians(6.0)) * 16 / 9
    centres = np.array(
        [[0, 0, 0], [edge_mm + 90, 0, 0], [edge_mm + 130, 0, 0], [0, 0, 9000.0], [0, 900, 0]]
    )
    seen = in_view(centres, np.full(5, 100.0), world_to_clip=matrix)
    assert seen.tolist() == [True, True, False, False, False]


def test_culling_changes_no_pixel(gl: moderngl.Context, crowd: Crowd) -> None:
    spec = ClipSpec(left=LOW, right=LOW, distance="medium", width=320, height=180)
    target = gl.framebuffer([gl.texture((320, 180), 4, dtype="f2")], gl.depth_texture((320, 180)))
    for azimuth in (-60.0, 0.0, 35.0):
        view = views(spec, azimuth)[0]
        pictures = []
        for numbers in (None, [n for n, f in enumerate(crowd.figures) if f.member.is_shown]):
            target.use()
            target.clear(depth=1.0)
            gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
            crowd.pose(0.7)
            seen = crowd.in_view(view.projection @ view.view_matrix)
            drawn = seen if numbers is None else numbers
            crowd.skin(drawn)
            crowd.meshes.light(
                crowd.light, projection=view.projection, camera_mm=view.position_mm, is_marked=True
            )
            crowd.meshes.draw(drawn, view_matrix=view.view_matrix)
            pictures.append(target.read(components=4, dtype="f2"))
        assert len(seen) < 28
        assert pictures[0] == pictures[1]


def test_only_those_who_are_seen_are_skinned(gl: moderngl.Context, crowd: Crowd) -> None:
    view = views(ClipSpec(left=LOW, right=LOW, distance="macroscopic"), 0.0)[0]
    target = gl.framebuffer([gl.texture((32, 32), 4, dtype="f2")], gl.depth_texture((32, 32)))
    target.use()
    crowd.draw(**view.uniforms, time_s=3.1)
    seen = crowd.in_view(view.projection @ view.view_matrix)
    assert crowd._skinned == set(seen)
    assert 0 < len(seen) < 15
