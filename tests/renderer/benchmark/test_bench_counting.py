"""A shader that counts itself: by hand on a small one, and every LoD's compiles."""

from __future__ import annotations

import moderngl
import numpy as np
import pytest

from renderer.benchmark.counting import Tally, counted, tally
from renderer.clip import ClipSpec
from renderer.detail import LEVELS, Detail
from renderer.eye.model import eye_constants
from renderer.gl.program import build_program

VERTEX = """#version 430 core
void main() { gl_Position = vec4(ivec2(gl_VertexID & 1, gl_VertexID >> 1) * 4 - 1, 0.0, 1.0); }
"""
FRAGMENT = """#version 430 core
const float SCALE = 2.0 * 3.0;       // a constant: nothing at run time
uniform sampler2D u_map;
struct Pair { float a; float b; };
out vec4 f_radiance;

/* called twice: counts twice */
float twice(float x) { return x * 2.0; }

void main() {
    float sum = -1.0;                                       // a sign is no operation
    const float half_of_it = 0.5 * 4.0;
    for (int i = 0; i < 3; ++i) sum += texture(u_map, vec2(0.5)).r;   // 3 fetches, 3 operations
    if (gl_FragCoord.x < 1.0) sum = twice(sum) - twice(1.0);          // 2 + 1, left column only
    else if (gl_FragCoord.x < 2.0) { sum *= sqrt(sum + 4.0); }        // 3, next column only
    int k = 0;
    while (k < 2) { k++; sum = max(sum, texelFetch(u_map, ivec2(0), 0).g); }  // 2 fetches, 2
    f_radiance = vec4(gl_FragCoord.y < 1.0 ? 0.0 : abs(sum), 0.0, 0.0, 1.0);  // 1
}
"""


def words(expression: str) -> list[str]:
    return expression.split()


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("float a = b * c + d - 1.0 ;", Tally(0, 3)),
        ("return - b ;", Tally(0, 0)),
        ("a = ( - b ) * - c ;", Tally(0, 1)),
        ("a += b ;", Tally(0, 1)),
        ("h ^= h >> 15 ;", Tally(0, 2)),
        ("a = vec3 ( b ) . x ;", Tally(0, 0)),
        ("if ( a < b && c >= d )", Tally(0, 0)),
        ("n = normalize ( textureLod ( u_map , uv * 2.0 , 0.0 ) . xyz ) ;", Tally(1, 2)),
        ("const float a = 2.0 * 3.0 ;", Tally(0, 0)),
        ("v [ 0 ] * v [ 1 ] ;", Tally(0, 1)),
    ],
)
def test_operations_are_counted_as_the_module_says(expression: str, expected: Tally) -> None:
    assert tally(words(expression)) == expected


def test_a_shader_counts_the_path_that_each_pixel_takes(gl: moderngl.Context) -> None:
    program = gl.program(vertex_shader=VERTEX, fragment_shader=counted(FRAGMENT))
    white = gl.texture((1, 1), 4, bytes([255] * 4))
    white.use(0)
    target = gl.framebuffer([gl.texture((3, 2), 4, dtype="f4")])
    with gl.scope(target, moderngl.NOTHING):
        gl.vertex_array(program, []).render(moderngl.TRIANGLES, vertices=3)
    pixels = np.frombuffer(target.read(components=3, dtype="f4"), np.float32).reshape(2, 3, 3)
    every = 3 + 2 + 1
    assert pixels[0, :, 0].tolist() == [5, 5, 5]
    assert pixels[0, :, 1].tolist() == [every + 3, every + 3, every]
    assert pixels[..., 2].tolist() == [[0, 0, 0], [1, 1, 1]]


def test_what_counting_cannot_follow_is_refused() -> None:
    with pytest.raises(ValueError, match='"switch": counting knows if, for and while'):
        counted("#version 430 core\nvoid main() { switch (1) { default: break; } }")


@pytest.mark.parametrize("level", LEVELS)
def test_every_levels_shader_compiles_with_its_counters(gl: moderngl.Context, level: str) -> None:
    detail = Detail.uniform(level)
    for samples in (0, 10):
        spec = ClipSpec(left=detail, right=detail, subsurface_samples=samples)
        constants = eye_constants(detail, spec) | {"OWN_FACE": 1}
        program = build_program(
            gl, "eye.vert", fragment="eye.frag", constants=constants, rewrite_fragment=counted
        )
        assert program.is_active("u_view_matrix")
