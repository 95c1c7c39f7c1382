"""Shader assembly: constants choose, errors name our files, uniforms are checked."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import moderngl
import numpy as np
import pytest

from renderer.detail import Detail
from renderer.gl import assembly, program, uniforms

VERTEX = "void main() { gl_Position = vec4(0.0); }\n"


@pytest.fixture
def shaders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(assembly, "SHADERS", tmp_path)
    (tmp_path / "v.vert").write_text(VERTEX)
    return tmp_path


def test_includes_nest_and_each_file_is_read_once(shaders: Path) -> None:
    (shaders / "a.glsl").write_text('#include "c.glsl"\nfloat a() { return c(); }\n')
    (shaders / "b.glsl").write_text('#include "c.glsl"\nfloat b() { return c(); }\n')
    (shaders / "c.glsl").write_text("float c() { return 1.0; }\n")
    (shaders / "f.frag").write_text('#include "a.glsl"\n#include "b.glsl"\nvoid main() {}\n')
    source = assembly.assemble("f.frag")
    assert source.files == ["f.frag", "a.glsl", "c.glsl", "b.glsl"]
    assert source.text.count("float c()") == 1


def test_a_missing_include_names_the_line_that_asks_for_it(shaders: Path) -> None:
    (shaders / "f.frag").write_text('\n#include "gone.glsl"\nvoid main() {}\n')
    with pytest.raises(FileNotFoundError, match=r"f\.frag:2: no shader file gone\.glsl"):
        assembly.assemble("f.frag")


def test_a_compile_error_names_our_file_and_line(gl: moderngl.Context, shaders: Path) -> None:
    (shaders / "a.glsl").write_text("float a() {\n    return missing;\n}\n")
    (shaders / "f.frag").write_text(
        '#include "a.glsl"\nout vec4 o;\nvoid main() { o = vec4(a()); }\n'
    )
    with pytest.raises(RuntimeError, match=r"a\.glsl:2"):
        program.build_program(gl, "v.vert", fragment="f.frag")


def test_a_misspelt_level_fails_to_compile(gl: moderngl.Context, shaders: Path) -> None:
    (shaders / "f.frag").write_text(
        "out vec4 o;\nvoid main() { o = vec4(REFLECTION >= HIHG ? 1.0 : 0.0); }\n"
    )
    constants = assembly.detail_constants(Detail.uniform("high"))
    with pytest.raises(RuntimeError, match="HIHG"):
        program.build_program(gl, "v.vert", fragment="f.frag", constants=constants)


def test_a_uniform_of_an_unselected_level_is_skipped_and_an_unknown_one_refused(
    gl: moderngl.Context, shaders: Path
) -> None:
    (shaders / "f.frag").write_text(
        "uniform float u_ior;\nuniform mat4 u_turn;\nout vec4 o;\n"
        "void main() { o = u_turn[0]; if (REFRACTION >= HIGH) o *= u_ior; }\n"
    )
    for level, active in (("medium", False), ("high", True)):
        constants = assembly.detail_constants(Detail.uniform(level))
        built = program.build_program(gl, "v.vert", fragment="f.frag", constants=constants)
        built.set(u_ior=1.336, u_turn=np.eye(4))
        assert built.is_active("u_ior") is active
        with pytest.raises(KeyError, match="u_iro: no shader of this program declares"):
            built.set(u_iro=1.0)


def test_a_name_that_is_no_plain_uniform_is_refused(gl: moderngl.Context, shaders: Path) -> None:
    (shaders / "a.vert").write_text("in vec4 a_p;\nvoid main() { gl_Position = a_p; }\n")
    (shaders / "f.frag").write_text("out vec4 o;\nvoid main() { o = vec4(1.0); }\n")
    built = program.build_program(gl, "a.vert", fragment="f.frag")
    with pytest.raises(TypeError, match="a_p: a Attribute, not a plain uniform"):
        uniforms.plain_uniform(built.gl_program, "a_p")


@pytest.fixture
def sums(gl: moderngl.Context, shaders: Path) -> Iterator[Callable[..., float]]:
    """A program that adds up a vector; it returns the sum that GL draws."""
    (shaders / "s.vert").write_text(
        "void main() { gl_Position = vec4(4.0 * (gl_VertexID & 1) - 1.0,"
        " 4.0 * (gl_VertexID >> 1) - 1.0, 0.0, 1.0); }\n"
    )
    (shaders / "f.frag").write_text(
        "uniform vec3 u_parts;\nout vec4 o;\nvoid main() { o = vec4(dot(u_parts, vec3(1.0))); }\n"
    )
    built = program.build_program(gl, "s.vert", fragment="f.frag")
    target = gl.framebuffer([gl.texture((1, 1), 1, dtype="f4")])
    screen = gl.vertex_array(built.gl_program, [])

    def drawn(parts: object) -> float:
        built.set(u_parts=parts)
        target.use()
        gl.enable_only(moderngl.NOTHING)
        screen.render(moderngl.TRIANGLES, vertices=3)
        return float(np.frombuffer(target.read(components=1, dtype="f4"), np.float32)[0])

    yield drawn
    target.release()


def test_an_array_that_changes_in_place_is_looked_into_again(sums: Callable[..., float]) -> None:
    parts = np.array([1.0, 2.0, 3.0])
    assert sums(parts) == 6.0
    parts[0] = 5.0
    assert sums(parts) == 10.0
    numbers = [1.0, 1.0, 1.0]
    assert sums(numbers) == 3.0
    numbers[2] = 4.0
    assert sums(numbers) == 6.0
    # A read-only look at numbers that somebody else may change is no constant.
    look = parts.view()
    look.flags.writeable = False
    assert sums(look) == 10.0
    parts[0] = 1.0
    assert sums(look) == 6.0


def test_constants_take_turns(sums: Callable[..., float]) -> None:
    first, second = uniforms.constant([1.0, 2.0, 3.0]), uniforms.constant([4.0, 5.0, 6.0])
    assert [sums(parts) for parts in (first, first, second, first)] == [6.0, 6.0, 15.0, 6.0]
    with pytest.raises(ValueError, match="read-only"):
        first[0] = 2.0
    source = np.ones(3)
    kept = uniforms.constant(source)
    source[0] = 9.0
    assert sums(kept) == 3.0
