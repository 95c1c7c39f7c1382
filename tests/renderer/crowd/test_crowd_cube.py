import moderngl
import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.crowd.crowd import Crowd
from renderer.crowd.cube import LEVELS, CrowdCube
from renderer.crowd.cube_tiles import TILES
from renderer.detail import Detail
from renderer.light import Light, Sky
from renderer.park.cube_faces import face_directions, read_face

SPEC = ClipSpec(left=Detail.uniform("ultra"), right=Detail.uniform("ultra"))
SUN = np.array([-0.44, 0.64, 0.63]) / np.linalg.norm([-0.44, 0.64, 0.63])


def light_from(gl: moderngl.Context, sun_direction: np.ndarray) -> Light:
    sh = np.zeros((9, 3))
    sh[0] = 1.0
    sky = Sky(sun_direction=sun_direction, sun_irradiance=np.full(3, 2.0), ambient_sh=sh)
    lit = gl.texture((2, 2), 1, np.ones(4, np.float32).tobytes(), dtype="f4")
    return Light(sky, lit, np.eye(4, dtype=np.float32))


@pytest.fixture(scope="module")
def crowd(gl: moderngl.Context) -> Crowd:
    return Crowd(gl, SPEC, light_from(gl, SUN))


def faces(cube: CrowdCube) -> np.ndarray:
    return np.stack([read_face(cube.texture, face) for face in range(6)])


def texels(cube: CrowdCube, level: int) -> np.ndarray:
    side = cube.size >> level
    read = [
        cube._cube.attach(face, level=level).read((side, side), components=4, dtype="f2")
        for face in range(6)
    ]
    return np.frombuffer(b"".join(read), np.float16).reshape(6, side, side, 4).astype(np.float32)


def bodies(pixels: np.ndarray) -> np.ndarray:
    return pixels[..., 3] == 1.0


def test_the_waver_is_seen_where_she_stands_and_the_sky_is_empty(gl, crowd) -> None:
    cube = CrowdCube(gl, 128, crowd)
    cube.render(0.0)
    pixels = faces(cube)
    directions = np.stack([face_directions(128, face) for face in range(6)])
    azimuth = np.degrees(np.arctan2(directions[..., 0], directions[..., 2]))
    at_waver = (np.abs(azimuth - 24) < 3) & (np.abs(directions[..., 1] + 0.3) < 0.1)
    assert at_waver.sum() > 20
    assert bodies(pixels)[at_waver].mean() > 0.95
    assert not pixels[directions[..., 1] > 0.5].any()


def test_all_five_are_in_the_reflection(gl, crowd) -> None:
    cube = CrowdCube(gl, 256, crowd)
    cube.render(2.0)
    seen = faces(cube)
    directions = np.stack([face_directions(256, face) for face in range(6)])
    for figure in crowd.figures:
        x_mm, z_mm = figure.member.place_mm(2.0)
        towards = np.array([x_mm, -450.0, z_mm])
        near = directions @ (towards / np.linalg.norm(towards)) > np.cos(np.radians(3))
        assert bodies(seen)[near].mean() > 0.5, figure.member.person.name


def test_the_walker_crosses_from_the_viewers_left_to_right(gl, crowd) -> None:
    cube = CrowdCube(gl, 128, crowd)
    directions = face_directions(128, 4)
    azimuth = np.degrees(np.arctan2(directions[..., 0], directions[..., 2]))
    for time, expected in ((1.7, -35.0), (2.5, 0.0)):
        cube.render(time)
        at = (np.abs(azimuth - expected) < 3) & (np.abs(directions[..., 1] + 0.25) < 0.06)
        assert bodies(read_face(cube.texture, 4))[at].mean() > 0.8


def test_partial_clearing_leaves_no_trace_of_earlier_frames(gl, crowd) -> None:
    used = CrowdCube(gl, 128, crowd)
    for time in (0.0, 1.0, 2.0, 3.0):
        used.render(time)
    fresh = CrowdCube(gl, 128, crowd)
    fresh.render(3.0)
    np.testing.assert_array_equal(faces(used), faces(fresh))


def test_radiance_is_premultiplied_by_coverage(gl, crowd) -> None:
    cube = CrowdCube(gl, 128, crowd)
    cube.render(2.0)
    pixels = faces(cube)
    alpha = pixels[..., 3]
    assert (pixels[alpha == 0] == 0).all()
    shadow = (alpha > 0) & (alpha < 1)
    assert shadow.any()
    assert (pixels[shadow][:, :3] == 0).all()
    assert np.unique(alpha[shadow]).size == 1


def test_tiles_hold_every_drawn_pixel(gl, crowd) -> None:
    cube = CrowdCube(gl, 128, crowd)
    cube.render(2.7)
    drawn = faces(cube)[..., 3].reshape(6, TILES, 8, TILES, 8).max(axis=(2, 4)) > 0
    assert drawn.any()
    assert not (drawn & ~cube._drawn).any()
    assert cube._drawn.mean() < 0.5


def test_on_a_gpu_whole_faces_are_drawn_and_show_the_same(gl, crowd, monkeypatch) -> None:
    with monkeypatch.context() as patch:
        patch.setattr("renderer.gl.context.SOFTWARE", ())
        whole = CrowdCube(gl, 128, crowd)
    chosen = CrowdCube(gl, 128, crowd)
    monkeypatch.setattr(whole, "_chosen_draws", None)
    for time in (0.4, 2.9):  # the walker has left the places of the first time by the second
        for cube in (whole, chosen):
            cube.render(time)
        assert faces(chosen)[..., 3].any()
        np.testing.assert_array_equal(faces(whole), faces(chosen))
        for level in range(1, LEVELS):
            # Halves of halves, each rounded to half floats.
            found, expected = texels(whole, level), texels(chosen, level)
            assert expected[..., 3].any()
            np.testing.assert_allclose(found, expected, rtol=0.002, atol=1e-5)


def test_long_shadows_of_a_low_sun_leave_no_trace(gl, crowd, monkeypatch) -> None:
    elevation = np.radians(5.0)
    sun = np.array([0.0, np.sin(elevation), np.cos(elevation)])
    monkeypatch.setattr(crowd, "light", light_from(gl, sun))
    used = CrowdCube(gl, 128, crowd)
    used.render(0.0)
    used.render(1.5)
    fresh = CrowdCube(gl, 128, crowd)
    fresh.render(1.5)
    np.testing.assert_array_equal(faces(used), faces(fresh))
    for level in (1, 4):
        np.testing.assert_allclose(texels(used, level), texels(fresh, level), atol=0.002)


def test_a_frame_asks_gl_for_few_draws_and_no_new_targets(gl, crowd, monkeypatch) -> None:
    chosen = CrowdCube(gl, 64, crowd)
    with monkeypatch.context() as patch:
        patch.setattr("renderer.gl.context.SOFTWARE", ())
        whole = CrowdCube(gl, 64, crowd)
    chosen.render(0.6)
    draws: list[int] = []
    drawing = moderngl.VertexArray.render

    def counted(self, mode, *, vertices: int, first: int) -> None:
        draws.append(vertices)
        drawing(self, mode, vertices=vertices, first=first)

    monkeypatch.setattr(moderngl.VertexArray, "render", counted)
    monkeypatch.setattr(moderngl.Context, "framebuffer", None)
    whole.render(0.7)
    assert len(draws) == 2 * 6  # on each face all shadows, then all figures
    assert draws[1] == 3 * sum(len(figure.body.triangles) for figure in crowd.figures)
    draws.clear()
    chosen.render(0.9)
    assert 4 <= len(draws) <= 2 * 6


def test_without_a_crowd_the_cube_stays_empty(gl, crowd) -> None:
    nobody = ClipSpec(left=Detail.uniform("ultra"), right=Detail.uniform("ultra"), crowd=0)
    cube = CrowdCube(gl, 64, Crowd(gl, nobody, crowd.light))
    cube.render(1.0)
    assert not faces(cube).any()
