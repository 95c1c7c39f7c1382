"""Ambient light as the shaders read it: one polynomial of the normal, its constants folded in."""

from __future__ import annotations

import math

import moderngl
import numpy as np
import pytest

from renderer.gl.program import build_program
from renderer.park.image import irradiance
from renderer.spherical_harmonics import ambient_uniforms, irradiance_terms, terms_irradiance


@pytest.fixture
def sky() -> np.ndarray:
    """Harmonics (9, 3) of a bright uneven sky whose irradiance stays above zero."""
    sh = np.random.default_rng(7).normal(size=(9, 3)) * 0.2
    sh[0] = (3.0, 3.5, 4.0)
    return sh


def normals(count: int) -> np.ndarray:
    n = np.random.default_rng(3).normal(size=(count, 3))
    return np.asarray(n / np.linalg.norm(n, axis=1, keepdims=True))


def test_the_terms_give_the_irradiance_of_the_harmonics(sky: np.ndarray) -> None:
    terms = irradiance_terms(sky)
    for n in normals(20):
        np.testing.assert_allclose(
            terms_irradiance(terms, n), irradiance(sky, n[None])[0], rtol=1e-5
        )


def test_an_even_sky_gives_pi_in_every_direction() -> None:
    even = np.zeros((9, 3))
    even[0] = 1 / 0.282095
    terms = irradiance_terms(even)
    for n in normals(5):
        np.testing.assert_allclose(terms_irradiance(terms, n), np.full(3, math.pi), rtol=1e-5)


def test_irradiance_never_falls_below_zero() -> None:
    sh = np.zeros((9, 3))
    sh[2] = 1.0  # light from in front, as much taken from behind
    assert (terms_irradiance(irradiance_terms(sh), np.array([0.0, 0.0, -1.0])) == 0).all()


def test_the_harmonics_stay_as_they_were(sky: np.ndarray) -> None:
    before = sky.copy()
    given = ambient_uniforms(sky)
    np.testing.assert_array_equal(sky, before)
    np.testing.assert_array_equal(given["u_ambient_sh"], before)
    ahead = irradiance(sky, np.array([[0.0, 0.0, 1.0]]))[0]
    np.testing.assert_allclose(given["u_ahead_irradiance"], ahead, rtol=1e-5)


def test_the_shader_sums_the_same_polynomial(gl: moderngl.Context, sky: np.ndarray) -> None:
    def asking(text: str) -> str:
        body = (
            "uniform vec3 u_n; out vec4 o; void main() { o = vec4(ambient_irradiance(u_n), 1.0); }"
        )
        return text.split("void main()", maxsplit=1)[0] + body

    program = build_program(gl, "screen.vert", fragment="fabric.frag", rewrite_fragment=asking)
    target = gl.framebuffer([gl.texture((1, 1), 4, dtype="f4")])
    terms = irradiance_terms(sky)
    array = gl.vertex_array(program.gl_program, [])
    for n in normals(6):
        program.set(u_ambient_terms=terms)
        asked = program.gl_program["u_n"]
        assert isinstance(asked, moderngl.Uniform)
        asked.value = tuple(n)
        with gl.scope(target, moderngl.NOTHING):
            array.render(moderngl.TRIANGLES, vertices=3)
        seen = np.frombuffer(target.read(components=3, dtype="f4"), np.float32)
        np.testing.assert_allclose(seen, terms_irradiance(terms, n), rtol=1e-5)
