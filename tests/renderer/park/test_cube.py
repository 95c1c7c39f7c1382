import moderngl
import numpy as np
import pytest

from renderer.gl.functions import gl_function
from renderer.park.cube_faces import FACE_AXES, FACES, face_directions, face_view, read_face
from renderer.park.cube_target import CubeTarget

COLOURS = [(1, 0, 0), (0, 1, 1), (0, 1, 0), (1, 0, 1), (0, 0, 1), (1, 1, 0)]
LOOK_UP = """
#version 430
uniform samplerCube u_cube;
uniform float u_lod;
in vec3 in_direction;
out vec4 v_colour;
void main() { v_colour = textureLod(u_cube, in_direction, u_lod); }
"""


def look_up(gl: moderngl.Context, cube: moderngl.TextureCube, directions, lod: float = 0.0):
    program = gl.program(vertex_shader=LOOK_UP, varyings=["v_colour"])
    program["u_lod"].value = lod
    cube.use(0)
    source = gl.buffer(np.asarray(directions, np.float32).tobytes())
    result = gl.buffer(reserve=len(directions) * 16)
    gl.vertex_array(program, [(source, "3f", "in_direction")]).transform(result, moderngl.POINTS)
    return np.frombuffer(result.read(), np.float32).reshape(-1, 4)


@pytest.fixture
def coloured(gl: moderngl.Context) -> CubeTarget:
    cube = CubeTarget(gl, 64, levels=4, depth=True)
    for face, colour in enumerate(COLOURS):
        cube.attach(face).clear(*colour, 1.0)
    cube.build_levels()
    return cube


def test_six_coloured_faces_read_back_through_their_directions(gl, coloured) -> None:
    forward = [axes[:, 2] for axes in FACE_AXES]
    for lod in (0.0, 3.0):
        found = look_up(gl, coloured.texture, forward, lod)
        np.testing.assert_allclose(found[:, :3], COLOURS, atol=1e-3, err_msg=f"level {lod}")


def test_directions_of_texels_are_those_that_find_them(gl) -> None:
    cube = CubeTarget(gl, 16)
    for face in range(6):
        target = cube.attach(face)
        target.clear(0, 0, 0, 0)
        target.scissor = (11, 3, 1, 1)
        target.clear(1, 1, 1, 1)
    directions = [face_directions(16, face)[3, 11] for face in range(6)]
    np.testing.assert_allclose(look_up(gl, cube.texture, directions)[:, 0], 1.0)
    assert all(read_face(cube.texture, face)[3, 11, 0] == 1.0 for face in range(6))


def test_a_point_drawn_through_a_faces_view_lands_on_its_direction() -> None:
    point = np.array([0.3, -0.5, 0.2])
    for face, axes in enumerate(FACE_AXES):
        seen = face_view(face)[:3, :3] @ point
        np.testing.assert_allclose(
            seen, [point @ axes[:, 0], point @ axes[:, 1], -point @ axes[:, 2]]
        )
        assert np.linalg.det(face_view(face)[:3, :3]) == pytest.approx(1.0), FACES[face]


def test_levels_below_a_rectangle_change_and_others_stay(gl, coloured) -> None:
    target = coloured.attach(4)
    target.scissor = (0, 0, 8, 8)
    target.clear(0.5, 0.5, 0.5, 1.0)
    coloured.build_levels([(4, (0, 0, 8, 8))])
    inside, outside = face_directions(8, 4)[0, 0], face_directions(8, 4)[4, 4]
    found = look_up(gl, coloured.texture, [inside, outside], 3.0)
    np.testing.assert_allclose(found[:, :3], [[0.5, 0.5, 0.5], COLOURS[4]], atol=1e-3)


def test_a_face_stays_a_target_and_forgets_the_last_scissor(coloured) -> None:
    target = coloured.attach(2)
    target.scissor = (0, 0, 1, 1)
    assert coloured.attach(3) is not target
    assert coloured.attach(2) is target
    target.clear(0.25, 0.5, 0.75, 1.0)
    np.testing.assert_allclose(
        read_face(coloured.texture, 2)[..., :3].min(axis=(0, 1)), [0.25, 0.5, 0.75]
    )


def test_a_gpus_own_levels_are_means_too(gl, monkeypatch) -> None:
    rng = np.random.Generator(np.random.PCG64(3))
    content = rng.uniform(size=(6, 64, 64, 4)).astype(np.float16)
    halved = CubeTarget(gl, 64, levels=4)
    with monkeypatch.context() as patch:
        patch.setattr("renderer.gl.context.SOFTWARE", ())
        built = CubeTarget(gl, 64, levels=4)
    directions = np.concatenate([face_directions(8, face).reshape(-1, 3) for face in range(6)])
    found = []
    for cube in (halved, built):
        for face in range(6):
            cube.texture.write(face, content[face].tobytes())
        cube.build_levels([(face, (0, 0, 64, 64)) for face in range(6)])
        found.append(look_up(gl, cube.texture, directions, 3.0))
    means = content.astype(np.float32).reshape(6, 8, 8, 8, 8, 4).mean(axis=(2, 4)).reshape(-1, 4)
    for values in found:
        np.testing.assert_allclose(values, means, atol=0.002)


def test_an_unknown_gl_function_says_which_libraries_are_missing(monkeypatch) -> None:
    def refuse(name: str) -> None:
        raise OSError(name)

    monkeypatch.setattr("ctypes.CDLL", refuse)
    with pytest.raises(
        RuntimeError, match=r"glNothing: not found .* apt-get install libegl1 libgl1"
    ):
        gl_function("glNothing")
