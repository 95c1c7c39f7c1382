import moderngl
import numpy as np
import pytest

from renderer.camera import views
from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.park.cube_faces import face_directions, read_face
from renderer.park.environments import project_to_sh
from renderer.park.sky import LUMINANCE, clear_sky
from renderer.park.surroundings import Surroundings, level_count

SPEC = ClipSpec(left=Detail.uniform("low"), right=Detail.uniform("low"))


def irradiance(sh: np.ndarray, n: np.ndarray) -> np.ndarray:
    """Evaluate what shaders/light.glsl evaluates (Ramamoorthi and Hanrahan 2001, eq. 13)."""
    x, y, z = n
    c1, c2, c3, c4, c5 = 0.429043, 0.511664, 0.743125, 0.886227, 0.247708
    return (
        c1 * sh[8] * (x * x - y * y)
        + c3 * sh[6] * z * z
        + c4 * sh[0]
        - c5 * sh[6]
        + 2 * c1 * (sh[4] * x * y + sh[7] * x * z + sh[5] * y * z)
        + 2 * c2 * (sh[3] * x + sh[1] * y + sh[2] * z)
    )


@pytest.fixture(scope="module")
def park(gl: moderngl.Context) -> Surroundings:
    return Surroundings(gl, SPEC)


def test_constant_surroundings_give_pi_times_their_radiance() -> None:
    sh = project_to_sh(np.full((6, 32, 32, 3), 0.25))
    for n in ([1, 0, 0], [0, -1, 0], [0.6, 0, 0.8]):
        np.testing.assert_allclose(irradiance(sh, np.array(n, float)), np.pi * 0.25, rtol=1e-3)


def test_a_cosine_lobe_gives_its_closed_form() -> None:
    # Radiance max(d.y, 0) has irradiance 2 pi / 3 upwards; nine coefficients keep it to 1 %.
    faces = np.stack([face_directions(64, face)[..., 1:2].clip(0) for face in range(6)])
    sh = project_to_sh(np.repeat(faces, 3, axis=-1))
    np.testing.assert_allclose(irradiance(sh, np.array([0.0, 1.0, 0.0])), 2 * np.pi / 3, rtol=0.01)


def test_linear_radiance_gives_its_closed_form_along_every_axis() -> None:
    for axis in range(3):
        lobe = np.stack([1 + face_directions(32, face)[..., axis] for face in range(6)])
        sh = project_to_sh(np.repeat(lobe[..., None], 3, axis=-1))
        n = np.eye(3)[axis]
        np.testing.assert_allclose(irradiance(sh, n), np.pi + 2 * np.pi / 3, rtol=2e-3)
        np.testing.assert_allclose(irradiance(sh, -n), np.pi - 2 * np.pi / 3, rtol=2e-3)


def test_the_sky_lights_from_above_and_the_lawn_reflects_green(park) -> None:
    up = irradiance(park.sky.ambient_sh, np.array([0.0, 1.0, 0.0]))
    down = irradiance(park.sky.ambient_sh, np.array([0.0, -1.0, 0.0]))
    assert 0.8 < up @ LUMINANCE < 2.5
    assert down @ LUMINANCE < 0.5 * (up @ LUMINANCE)
    assert up[2] > up[0]
    assert down[1] > down[2]


def test_shader_and_numpy_agree_on_the_clear_sky(gl) -> None:
    # The bluest part of the drawn sky has no cloud: there the shader must equal the model.
    park = Surroundings(gl, SPEC)
    drawn = np.stack([read_face(park.cube(64), face)[..., :3] for face in range(6)])
    directions = np.stack([face_directions(64, face) for face in range(6)])
    model = clear_sky(SPEC.sun_azimuth_deg, SPEC.sun_elevation_deg)
    high = directions[..., 1] > 0.25
    expected = model.radiance(directions[high])
    error = np.abs(drawn[high] / expected - 1).max(axis=-1)
    assert (error < 0.01).mean() > 0.1


def test_the_sun_itself_is_not_in_the_cube(park) -> None:
    peak = max(read_face(park.cube(128), face).max() for face in range(6))
    assert 1.0 < peak < 20.0


def test_cubes_of_different_sizes_show_the_same_world(park) -> None:
    small = np.stack([read_face(park.cube(32), face)[..., :3] for face in range(6)])
    large = np.stack([read_face(park.cube(128), face)[..., :3] for face in range(6)])
    halved = large.reshape(6, 32, 4, 32, 4, 3).mean(axis=(2, 4))
    assert np.abs(small - halved).mean() < 0.12 * halved.mean()
    assert park.cube(128) is park.cube(128)


def test_levels_reach_down_to_32_pixels() -> None:
    assert [level_count(size) for size in (32, 128, 1024, 2048)] == [1, 3, 6, 7]


def test_the_same_spec_gives_the_same_bytes(gl, park) -> None:
    again = Surroundings(gl, SPEC)
    assert all(again.cube(64).read(face) == park.cube(64).read(face) for face in range(6))


def test_background_is_smooth_sane_and_behind_everything(gl, park) -> None:
    target = gl.framebuffer([gl.texture((320, 180), 4, dtype="f2")], gl.depth_texture((320, 180)))
    target.use()
    target.clear(depth=1.0)
    target.scissor = (0, 0, 160, 180)
    target.clear(9.0, 0.0, 0.0, 1.0, depth=0.5)
    target.scissor = (0, 0, 320, 180)
    gl.enable_only(moderngl.DEPTH_TEST)
    view = views(SPEC.resized(320, 180), 0.0)[0]
    park.draw_background(view_matrix=view.view_matrix, projection=view.projection)
    pixels = np.frombuffer(target.read(components=4, dtype="f2"), np.float16)
    pixels = pixels.reshape(180, 320, 4)[..., :3].astype(float)
    assert (pixels[:, :160] == [9.0, 0.0, 0.0]).all(), "nearer things must stay"
    seen = pixels[:, 160:]
    assert 0.02 < seen.mean() < 0.8
    assert np.abs(np.diff(seen, axis=1)).max() < 0.03
