import moderngl
import numpy as np
import pytest

from renderer.body.rig import skin_vertices
from renderer.camera import camera_radius_mm, views
from renderer.clip import ClipSpec
from renderer.clip_values import DISTANCES
from renderer.crowd.bodies import build_figures
from renderer.crowd.crowd import Crowd
from renderer.crowd.figure import BONES
from renderer.crowd.people import PEOPLE
from renderer.crowd.shares import light_shares
from renderer.crowd.stage import GROUND_MM, STAGE
from renderer.crowd.troupe import Troupe
from renderer.detail import Detail
from renderer.light import Light, Sky

SPEC = ClipSpec(
    left=Detail.uniform("low"), right=Detail.uniform("low"), distance="far", width=320, height=180
)
SUN = np.array([-0.44, 0.64, 0.63]) / np.linalg.norm([-0.44, 0.64, 0.63])


def flat_light(gl: moderngl.Context) -> Light:
    sh = np.zeros((9, 3))
    sh[0] = 1.0
    sky = Sky(sun_direction=SUN, sun_irradiance=np.array([2.0, 2.0, 2.0]), ambient_sh=sh)
    lit = gl.texture((2, 2), 1, np.ones(4, np.float32).tobytes(), dtype="f4")
    return Light(sky, lit, np.eye(4, dtype=np.float32))


@pytest.fixture(scope="module")
def crowd(gl: moderngl.Context) -> Crowd:
    return Crowd(gl, SPEC, flat_light(gl))


def draw(gl: moderngl.Context, crowd: Crowd, azimuth_deg: float, time_s: float) -> np.ndarray:
    size = (SPEC.width, SPEC.height)
    target = gl.framebuffer([gl.texture(size, 4, dtype="f2")], gl.depth_texture(size))
    target.use()
    target.clear(depth=1.0)
    gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
    view = views(SPEC, azimuth_deg)[0]
    crowd.draw(
        view_matrix=view.view_matrix,
        projection=view.projection,
        camera_mm=view.position_mm,
        time_s=time_s,
    )
    pixels = np.frombuffer(target.read(components=4, dtype="f2"), np.float16)
    return pixels.reshape(SPEC.height, SPEC.width, 4).astype(float)


def test_everyone_has_two_to_six_thousand_triangles_and_a_stature(crowd) -> None:
    assert len(crowd.figures) == 5
    for figure in crowd.figures:
        body = figure.body
        assert 2000 <= len(body.triangles) <= 6000
        assert np.ptp(body.positions_mm[:, 1]) == pytest.approx(
            figure.member.person.stature_mm, rel=0.03
        )
        np.testing.assert_allclose(body.weights.sum(axis=1), 1.0)
        assert body.bones.max() < len(BONES)
        assert len(np.unique(body.triangles)) == len(body.positions_mm)
    assert len({person.top for person in PEOPLE}) == 5


def test_the_gpu_skins_as_numpy_does(crowd) -> None:
    figure = crowd.figures[1]
    body = figure.body
    full = np.zeros((len(body.positions_mm), len(BONES)))
    np.add.at(full, (np.arange(len(full))[:, None], body.bones), body.weights)
    bones = Troupe((figure,)).bones(1.7)[0]
    expected = skin_vertices(body.positions_mm, bones, weights=full)
    posed = crowd.vertices(1.7)
    found = posed[figure.first_vertex : figure.first_vertex + len(expected)]
    np.testing.assert_allclose(found[:, :3], expected, atol=0.05)
    np.testing.assert_allclose(np.linalg.norm(found[:, 3:], axis=1), 1.0, atol=1e-4)
    assert expected[:, 1].min() == pytest.approx(GROUND_MM, abs=15.0)


def test_spheres_hold_the_posed_mesh(crowd) -> None:
    posed = crowd.vertices(2.2)[:, :3]
    bounds = crowd.bounds_mm()
    of_each = zip(
        np.split(bounds.centres_mm, bounds.firsts[1:]),
        np.split(bounds.reach_mm, bounds.firsts[1:]),
        strict=True,
    )
    for figure, (centres, radii) in zip(crowd.figures, of_each, strict=True):
        mesh = posed[figure.first_vertex : figure.first_vertex + len(figure.body.positions_mm)]
        beyond = np.linalg.norm(mesh[:, None] - centres[None], axis=2) - radii
        assert beyond.min(axis=1).max() <= 0.0


def test_nobody_in_the_picture_stands_before_the_face_from_any_azimuth() -> None:
    # The face and shoulders fill 250 mm around the line of sight; a body reaches 300 mm.
    for member in (member for member in STAGE if member.is_shown):
        azimuth = np.radians(member.azimuth_deg)
        place = member.distance_mm * np.array([np.sin(azimuth), np.cos(azimuth)])
        for distance in DISTANCES:
            radius = camera_radius_mm(distance)
            for camera in np.radians(np.linspace(-60, 60, 49)):
                towards = np.array([np.sin(camera), np.cos(camera)])
                before, aside = place @ towards, abs(place @ [towards[1], -towards[0]])
                if 0 < before < radius:
                    assert aside > 300.0
                    assert (aside - 300.0) * radius / (radius - before) > 120.0


def test_those_in_front_of_the_face_are_reflected_only() -> None:
    hidden = [member for member in STAGE if not member.is_shown]
    assert [member.action for member in hidden] == ["walk", "wave"]
    assert 800 < hidden[1].distance_mm < 1300
    assert abs(hidden[1].azimuth_deg) < 60


def test_bystanders_show_beside_the_face_at_far_and_leave_its_middle_free(gl, crowd) -> None:
    for azimuth in (-60.0, 0.0, 60.0):
        covered = draw(gl, crowd, azimuth, 1.0)[..., 3] > 0
        assert 0.02 < covered.mean() < 0.5
        assert not covered[:, 145:175].any()


def test_the_picture_depends_on_time_alone(gl, crowd) -> None:
    first = draw(gl, crowd, 30.0, 0.5)
    other = draw(gl, crowd, 30.0, 1.5)
    assert (draw(gl, crowd, 30.0, 0.5) == first).all()
    assert (other != first).any()


def test_a_crowd_of_none_draws_nothing(gl) -> None:
    nobody = ClipSpec(left=Detail.uniform("low"), right=Detail.uniform("low"), crowd=0)
    empty = Crowd(gl, nobody, flat_light(gl))
    assert not draw(gl, empty, 0.0, 1.0).any()
    assert empty.bounds_mm().centres_mm.shape == (0, 3)


def test_faces_turned_from_the_sun_get_none_of_it() -> None:
    figure = build_figures(STAGE[:1])[0]
    shares = light_shares(figure, SUN)
    assert shares.min() >= 0.0
    assert shares.max() <= 1.0
    assert 0.4 < shares[:, 0].mean() < 0.95
