"""What lids and lashes take from the globe's light: soft streaks and a dark band below the lid."""

from __future__ import annotations

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.eye.anatomy import GLOBE_RADIUS_MM, shader_constants
from renderer.eye.lids import LidRims
from renderer.gl.program import build_program
from renderer.spherical_harmonics import ambient_uniforms

Map = npt.NDArray[np.float32]

SIZE_PX = 384
RIM_EDGE_MM = 18.0  # lids.glsl's
EVEN_SKY = np.eye(9, 1).repeat(3, axis=1)  # the first harmonic alone


def shade(
    gl: moderngl.Context,
    rims: LidRims,
    *,
    elevation_deg: float = 42.0,
    sky: npt.ArrayLike = EVEN_SKY,
) -> Map:
    """Return the clip's shade map (SIZE_PX, SIZE_PX, 4): sky in rgb, sun in a; row 0 below."""
    x = np.linspace(-RIM_EDGE_MM, RIM_EDGE_MM, 128)
    table = np.column_stack(
        [
            np.interp(x, curve[:, 0], curve[:, axis])
            for axis in (1, 2)
            for curve in (rims.upper_mm, rims.lower_mm)
        ]
    )
    rims_texture = gl.texture((128, 1), 4, table.astype(np.float32).tobytes(), dtype="f4")
    lit = gl.texture((2, 2), 1, np.ones(4, np.float32).tobytes(), dtype="f4")  # nothing before it
    program = build_program(
        gl, "screen.vert", fragment="eye_shade_map.frag", constants=shader_constants()
    )
    elevation = np.radians(elevation_deg)
    program.set(
        u_lid_rims=rims_texture,
        u_sun_shadow=lit,
        u_world_to_shadow=np.zeros((4, 4)) + np.diag([0.0, 0.0, 0.0, 1.0]),
        u_sun_direction=(0.0, np.sin(elevation), np.cos(elevation)),
        u_eye_to_world=np.eye(4),
        u_map_px=SIZE_PX,
        **ambient_uniforms(np.asarray(sky)),
    )
    target = gl.framebuffer([gl.texture((SIZE_PX, SIZE_PX), 4, dtype="f4")])
    with gl.scope(target, moderngl.NOTHING):
        gl.vertex_array(program.gl_program, []).render(moderngl.TRIANGLES, vertices=3)
    pixels = np.frombuffer(target.read(components=4, dtype="f4"), np.float32)
    return pixels.reshape(SIZE_PX, SIZE_PX, 4).copy()


def rows(shade_map: Map, low_mm: float, high_mm: float) -> Map:
    """Return the map's rows between two heights and its middle columns, 12 mm wide."""
    first, last = (round((0.5 + 0.5 * y / GLOBE_RADIUS_MM) * SIZE_PX) for y in (low_mm, high_mm))
    side = round(SIZE_PX * 6.0 / (2 * GLOBE_RADIUS_MM))
    return shade_map[first:last, SIZE_PX // 2 - side : SIZE_PX // 2 + side]


def streaks(sun: Map) -> float:
    """Return how much the sun's share changes from column to column, root mean square."""
    return float(np.sqrt(np.mean(np.diff(sun, axis=1) ** 2)))


def test_sunlight_below_the_upper_lid_is_streaked_and_ends_at_the_tips(
    gl: moderngl.Context, average_rims: tuple[LidRims, LidRims]
) -> None:
    sun = shade(gl, average_rims[0])[..., 3]
    near, far = rows(sun, -0.5, 1.5), rows(sun, -4.0, -2.0)
    assert streaks(near) > 10 * streaks(far)
    assert streaks(near) > 0.01
    assert near.min() > 0.05  # hairs, not a second lid
    assert 0.03 < 1 - near.mean() < 0.4


def test_lashes_take_nothing_where_no_lid_is(gl: moderngl.Context) -> None:
    x = np.linspace(-RIM_EDGE_MM, RIM_EDGE_MM, 5)
    away = [np.column_stack([x, np.full(5, y), np.full(5, 8.0)]) for y in (40.0, -40.0)]
    sun = shade(gl, LidRims(*away))[..., 3]
    np.testing.assert_allclose(rows(sun, -4.0, 4.0), 1.0, atol=1e-3)


def test_a_low_sun_shines_under_the_lashes(
    gl: moderngl.Context, average_rims: tuple[LidRims, LidRims]
) -> None:
    low = shade(gl, average_rims[0], elevation_deg=2.0)[..., 3]
    high = shade(gl, average_rims[0], elevation_deg=42.0)[..., 3]
    assert rows(low, -0.5, 1.5).mean() > 0.98
    assert rows(high, -0.5, 1.5).mean() < 0.97


def test_the_sky_fades_under_the_upper_lid(
    gl: moderngl.Context, average_rims: tuple[LidRims, LidRims]
) -> None:
    """Dark where lid and globe meet, open in the middle: photographs show some 2 mm of shade."""
    sky = shade(gl, average_rims[0])[..., 1]
    column = rows(sky, -3.0, 2.6).mean(axis=1)
    assert column[0] > 0.85
    assert column[-1] < 0.82 * column[0]
    falls = column[len(column) // 2 :]
    assert (np.diff(falls) < 0.005).all()


def test_a_sky_from_above_is_hidden_most(
    gl: moderngl.Context, average_rims: tuple[LidRims, LidRims]
) -> None:
    above = np.zeros((9, 3))
    above[0], above[1] = 1.0, 0.55
    even = rows(shade(gl, average_rims[0])[..., 1], 1.0, 2.6).mean()
    assert rows(shade(gl, average_rims[0], sky=above)[..., 1], 1.0, 2.6).mean() < 0.97 * even


def test_skin_colours_what_the_lids_leave(
    gl: moderngl.Context, average_rims: tuple[LidRims, LidRims]
) -> None:
    white = np.zeros((9, 3))
    white[0] = 1.0
    under_lid = rows(shade(gl, average_rims[0], sky=white), 2.2, 2.6)
    assert under_lid[..., :3].max() < 0.95
    assert under_lid[..., 0].mean() > 1.02 * under_lid[..., 2].mean()


def test_without_lids_the_whole_sky_counts(gl: moderngl.Context) -> None:
    x = np.linspace(-RIM_EDGE_MM, RIM_EDGE_MM, 5)
    away = [np.column_stack([x, np.full(5, y), np.full(5, 8.0)]) for y in (2000.0, -2000.0)]
    sky = shade(gl, LidRims(*away))[..., :3]
    np.testing.assert_allclose(rows(sky, -4.0, 4.0), 1.0, atol=1e-3)
