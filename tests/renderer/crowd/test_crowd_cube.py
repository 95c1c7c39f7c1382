import moderngl
import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.crowd.crowd import Crowd
from renderer.crowd.cube import TILES, CrowdCube, cover, touched_tiles
from renderer.detail import Detail
from renderer.light import Light, Sky
from renderer.park.cube_faces import FACE_AXES, face_directions, read_face

SPEC = ClipSpec(left=Detail.uniform("ultra"), right=Detail.uniform("ultra"))
SUN = np.array([-0.44, 0.64, 0.63]) / np.linalg.norm([-0.44, 0.64, 0.63])


@pytest.fixture(scope="module")
def crowd(gl: moderngl.Context) -> Crowd:
    sh = np.zeros((9, 3))
    sh[0] = 1.0
    sky = Sky(sun_direction=SUN, sun_irradiance=np.full(3, 2.0), ambient_sh=sh)
    lit = gl.texture((2, 2), 1, np.ones(4, np.float32).tobytes(), dtype="f4")
    return Crowd(gl, SPEC, Light(sky, lit, np.eye(4, dtype=np.float32)))


def faces(cube: CrowdCube) -> np.ndarray:
    return np.stack([read_face(cube.texture, face) for face in range(6)])


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


@pytest.mark.parametrize("face", range(6))
def test_a_sphere_touches_the_face_it_stands_before_and_not_the_opposite(face: int) -> None:
    centre = (FACE_AXES[face] @ np.array([0.3, -0.2, 1.0]))[None] * 1000
    tiles = touched_tiles(centre, np.array([100.0]), face)
    column, row = round((0.3 + 1) / 2 * TILES), round((-0.2 + 1) / 2 * TILES)
    assert tiles[row, column]
    assert 1 <= tiles.sum() <= 9
    assert not touched_tiles(centre, np.array([100.0]), face ^ 1).any()


def test_rectangles_cover_the_tiles_exactly() -> None:
    rng = np.random.Generator(np.random.PCG64(5))
    tiles = rng.uniform(size=(TILES, TILES)) < 0.4
    again = np.zeros((TILES, TILES), dtype=int)
    for x, y, width, height in cover(tiles):
        again[y : y + height, x : x + width] += 1
    np.testing.assert_array_equal(again, tiles.astype(int))


def test_without_a_crowd_the_cube_stays_empty(gl, crowd) -> None:
    nobody = ClipSpec(left=Detail.uniform("ultra"), right=Detail.uniform("ultra"), crowd=0)
    cube = CrowdCube(gl, 64, Crowd(gl, nobody, crowd.light))
    cube.render(1.0)
    assert not faces(cube).any()
