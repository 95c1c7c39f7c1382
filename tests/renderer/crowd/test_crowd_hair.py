"""Bystanders' hair is made of locks: an uneven outline, tips, and nothing that shows through."""

from __future__ import annotations

import moderngl
import numpy as np
import pytest

from renderer.body.makehuman import Floats, base_mesh
from renderer.body.phenotype import phenotype
from renderer.crowd.bodies import cached_body
from renderer.crowd.cast import CAST, TEMPLATES
from renderer.crowd.face_parts import brows
from renderer.crowd.figure import Body
from renderer.crowd.hair import SHEEN
from renderer.crowd.hair_styles import STYLES
from renderer.crowd.locks import comb
from renderer.crowd.pieces import PARTS
from renderer.crowd.scalp import directions, hairline, hits
from renderer.gl.program import build_program
from renderer.light import Light, Sky


def corners(body: Body, *names: str) -> Floats:
    """Return the corners (m, 3, 3) of the triangles of parts."""
    numbers = [PARTS.index(name) for name in names]
    return body.positions_mm[body.triangles[np.isin(body.parts[body.triangles[:, 0]], numbers)]]


def outline_relief_mm(body: Body) -> float:
    """Return how far the head's upper outline, seen from before, strays from a smooth curve."""
    steps = np.arange(7)
    shares = np.array([[a, b, 6 - a - b] for a in steps for b in steps if a + b <= 6]) / 6
    points = np.einsum("sk,tkc->tsc", shares, corners(body, "hair")).reshape(-1, 3)
    x, y = points[:, 0], points[:, 1] - (points[:, 1].max() - 90.0)
    bins = np.rint(np.degrees(np.arctan2(x, y)) / 2).astype(int)
    is_upper = np.abs(bins) <= 30
    reach = np.zeros(61)
    np.maximum.at(reach, bins[is_upper] + 30, np.hypot(x, y)[is_upper])
    place = np.linspace(-1, 1, 61)
    return float(np.std(reach - np.polynomial.Polynomial.fit(place, reach, 6)(place)))


@pytest.mark.parametrize("name", ["walker", "elder", "sprinter", "student", "grandmother"])
def test_the_outline_of_hair_has_a_relief(name: str) -> None:
    """A cap lifted off the scalp strays by 0.4 mm."""
    assert outline_relief_mm(cached_body(TEMPLATES[name])) > 0.65


@pytest.mark.parametrize("name", STYLES)
def test_hair_ends_in_tips_of_its_own_beyond_and_before_the_hairline(name: str) -> None:
    style = STYLES[name]
    rng = np.random.Generator(np.random.PCG64(3))
    tips = comb(style, base_mesh().vertices_mm, rng).points_mm[-2]
    front = tips[tips[:, 2] > 100.0]
    assert len(front) > 8
    drop = np.diff(front[:, 1], n=2)
    assert np.std(drop) > 0.35 * style.tips_mm
    beside = np.sort(np.abs(np.diff(front[:, 0])))
    assert beside[0] > 1.0  # neighbours do not cross


@pytest.mark.parametrize("name", TEMPLATES)
def test_no_scalp_shows_through_hair(name: str) -> None:
    """Wherever hair grows, and beside the face where it hangs, the outermost surface is hair."""
    body = cached_body(TEMPLATES[name])
    bare = STYLES[TEMPLATES[name].hair_style].bare_mm / 95.0
    turn = np.radians(np.arange(-180.0, 180.0, 10.0))
    polar = np.linspace(0.1, 0.86, 9)[:, None] * (hairline(tuple(turn.tolist())) - bare)
    rays = directions(polar, turn).reshape(-1, 3)
    hair = corners(body, "hair")
    middle = np.array([0.0, hair[..., 1].max() - 105.0, 48.0])
    skin, grown = (
        hits(np.broadcast_to(part, (len(rays), *part.shape)), middle, rays)[0]
        for part in (corners(body, "skin"), hair)
    )
    out = [np.where(np.isfinite(way), way, 0.0).max(axis=1) for way in (skin, grown)]
    assert (out[1] > out[0]).mean() == 1.0


@pytest.mark.parametrize("name", ["walker", "right", "elder"])
def test_painted_brows_are_smooth_curves(name: str) -> None:
    """Carried over by the nearest vertices they were jagged: jumps of 4 mm from step to step."""
    person = TEMPLATES[name]
    shape = base_mesh().vertices_mm + phenotype(races=person.races, **person.build)
    for brow in brows(person, shape):
        rows = brow.positions_mm.reshape(3, -1, 3)[:, 1:-1, 1]
        assert np.abs(np.diff(rows, n=3, axis=1)).max() < 1.5


def test_everybody_wears_hair_of_a_style_and_its_strands_run_from_furrow_to_ridge() -> None:
    assert {person.hair_style for person in CAST} == set(STYLES)
    for name in ("walker", "right"):
        body = cached_body(TEMPLATES[name])
        strand = body.surface[body.parts == PARTS.index("hair"), 3]
        assert set(np.unique(strand)) == {*SHEEN, np.mean(SHEEN)}  # between them on the crown
        assert 0.45 < (strand == SHEEN[0]).mean() < 0.55


def test_hair_shows_strands_near_by_and_none_where_they_would_be_finer_than_pixels(
    gl: moderngl.Context,
) -> None:
    near, far = (strand_contrast(gl, width) for width in (120, 6))
    assert near > 0.15
    assert far < 0.02


def strand_contrast(gl: moderngl.Context, width: int) -> float:
    """Return the contrast of a flat lock, furrow to ridge, that is so many pixels wide."""
    program = build_program(gl, "crowd.vert", fragment="crowd.frag")
    sh = np.zeros((9, 3))
    sh[0] = 1.0
    lit = gl.texture((2, 2), 1, np.ones(4, np.float32).tobytes(), dtype="f4")
    light = Light(Sky(np.array([0.0, 0.0, 1.0]), np.ones(3), sh), lit, np.eye(4, dtype=np.float32))
    program.set(
        u_view_matrix=np.eye(4),
        u_projection=np.eye(4),
        u_camera_mm=np.array([0.0, 1000.0, 1.0]),
        u_marked=0.0,
        **light.uniforms(),
    )
    rows = [
        [x, y, 0.0, 0.0, 0.0, 1.0, 0.1, 0.1, 0.1, SHEEN[int(x > 0)], 1.0, 1.0, 0.0]
        for x in (-1.0, 1.0)
        for y in (-1.0, 1.0)
    ]
    layout = "3f 3f 4f 2f 1f", "p_world", "n_world", "in_surface", "in_light", "in_mark"
    quad = gl.buffer(np.array(rows, np.float32).tobytes())
    target = gl.framebuffer([gl.texture((width, 4), 4, dtype="f4")])
    target.use()
    gl.disable(moderngl.CULL_FACE | moderngl.DEPTH_TEST)
    vertices = gl.vertex_array(program.gl_program, [(quad, *layout)])
    vertices.render(moderngl.TRIANGLE_STRIP)
    seen = np.frombuffer(target.read(components=3, dtype="f4"), np.float32).reshape(4, width, 3)
    return float(seen[2].std() / seen[2].mean())
