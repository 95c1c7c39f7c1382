"""Hairs on the GPU: their ribbons, and coverage that is the same at every scale."""

from __future__ import annotations

import moderngl
import numpy as np
import numpy.typing as npt
import pytest

from renderer.head.strand_group import Strands
from renderer.head.strands import StrandMesh, blending, ribbons, strand_programs

SIZE_PX = 128
SHAFT = 24  # points of a hair
LENGTH_MM = 8.0


def rng() -> np.random.Generator:
    return np.random.Generator(np.random.PCG64(3))


def straight(count: int, width_mm: float, *, slope: float = 0.3) -> Strands:
    """Return ``count`` hairs side by side in the plane z = 0."""
    s = np.linspace(-0.5, 0.5, SHAFT) * LENGTH_MM
    x = (np.arange(count) + 0.5) / count * 24.0 - 12.0
    points = np.stack(
        [x[:, None] + slope * s, np.broadcast_to(s, (count, SHAFT)), np.zeros((count, SHAFT))], -1
    )
    return Strands(points, np.full(count, width_mm), np.zeros((count, 3)))


def darkness_mm2(gl: moderngl.Context, strands: Strands, px_per_mm: float) -> float:
    """Return the area that black hairs darken on white."""
    return float(darkness(gl, strands, px_per_mm).sum()) / px_per_mm**2


def darkness(
    gl: moderngl.Context,
    strands: Strands,
    px_per_mm: float,
    *,
    around_mm: tuple[float, float, float] | None = None,
) -> npt.NDArray[np.floating]:
    """Draw black hairs on white, in parallel projection from far; return what is dark, 0 to 1.

    Rows run upwards from the lowest. ``around_mm`` makes locks of them that lie on a body.
    """
    target = gl.framebuffer(
        [gl.texture((SIZE_PX, SIZE_PX), 4, dtype="f2")], gl.depth_texture((SIZE_PX, SIZE_PX))
    )
    target.use()
    target.clear(1.0, 1.0, 1.0, 1.0)
    mesh = StrandMesh(gl, strands, rng(), around_mm=around_mm)
    program = strand_programs(gl)[mesh.kind]
    away_mm = 1e4
    clip = np.diag([2 * px_per_mm / SIZE_PX, 2 * px_per_mm / SIZE_PX, -1e-3, 1.0])
    program.set(
        u_view_matrix=np.eye(4),
        u_projection=clip,
        u_camera_mm=(0.0, 0.0, away_mm),
        u_pixel_per_mm=px_per_mm * away_mm,
        u_pixel_mm=1.0 / px_per_mm,
        u_sun_direction=(0.0, 0.0, 1.0),
        u_sun_irradiance=(0.0, 0.0, 0.0),
        u_ambient_sh=np.zeros((9, 3)),
    )
    mesh.write_sun(np.zeros(len(mesh.points_mm)))
    with blending(gl):
        mesh.draw(program, clip, camera_mm=np.array([0.0, 0.0, away_mm]))
    image = np.frombuffer(target.read(components=4, dtype="f4"), np.float32).reshape(-1, 4)
    assert image[:, 3].min() == 1.0  # the picture stays opaque
    return 1.0 - image[:, 0].reshape(SIZE_PX, SIZE_PX)


def true_area_mm2(strands: Strands) -> float:
    """Return the area of hairs that narrow to a point: two thirds of length times width.

    Their roots take 0.016 off: they swell from 0.6 of the width over the first 0.08.
    """
    way = np.linalg.norm(strands.points_mm[0, -1] - strands.points_mm[0, 0])
    return float(strands.width_mm.sum() * way * (2 / 3 - 0.016))


@pytest.mark.parametrize("px_per_mm", [0.9, 3.0, 10.0])
def test_a_hair_darkens_as_much_as_it_covers_at_every_scale(
    gl: moderngl.Context, px_per_mm: float
) -> None:
    strands = straight(1, 0.28)
    assert darkness_mm2(gl, strands, px_per_mm) == pytest.approx(true_area_mm2(strands), rel=0.1)


def test_a_hair_narrows_from_its_root_to_a_point(gl: moderngl.Context) -> None:
    px_per_mm, width_mm = 10.0, 0.4
    across_mm = darkness(gl, straight(1, width_mm, slope=0.0), px_per_mm).sum(axis=1) / px_per_mm
    y_mm = (np.arange(SIZE_PX) + 0.5 - SIZE_PX / 2) / px_per_mm
    for place in (0.1, 0.5, 0.8, 0.95):
        here = np.abs(y_mm - (place - 0.5) * LENGTH_MM) < 0.2
        assert across_mm[here].mean() / width_mm == pytest.approx(1 - place**2, abs=0.06)
    assert across_mm[np.abs(y_mm) > 0.52 * LENGTH_MM].max() == 0.0


def test_hairs_too_thin_to_draw_one_by_one_are_stood_for_by_others(gl: moderngl.Context) -> None:
    strands = straight(100, 0.02)
    shown = darkness_mm2(gl, strands, 2.0)
    assert shown == pytest.approx(true_area_mm2(strands), rel=0.12)


def test_a_hair_keeps_its_darkness_when_the_picture_shifts_by_part_of_a_pixel(
    gl: moderngl.Context,
) -> None:
    areas = []
    for shift in (0.0, 0.13, 0.29, 0.41):
        strands = straight(1, 0.06, slope=0.0)
        strands.points_mm[..., 0] += shift
        areas.append(darkness_mm2(gl, strands, 2.5))
    assert np.ptp(areas) < 0.06 * np.mean(areas)


def test_a_hair_a_little_thicker_is_a_little_darker(gl: moderngl.Context) -> None:
    areas = [darkness_mm2(gl, straight(1, width), 6.0) for width in (0.10, 0.105, 0.11)]
    assert areas[1] / areas[0] == pytest.approx(1.05, abs=0.01)
    assert areas[2] / areas[0] == pytest.approx(1.10, abs=0.01)


def test_the_ground_does_not_shine_in_dashes_between_hairs_that_touch(
    gl: moderngl.Context,
) -> None:
    """A seam that runs across pixels is as dark on their edges as on their middles."""
    px_per_mm, row = 10.0, 46
    width_px = darkness(gl, straight(1, 0.4, slope=0.0), px_per_mm)[row].sum()
    dark = []
    for shift_px in (0.0, 0.25, 0.5, 0.75):
        strands = straight(2, 0.4, slope=0.0)
        middle_px = np.array([-0.5, 0.5]) * width_px + shift_px
        strands.points_mm[..., 0] = (middle_px / px_per_mm)[:, None]
        dark.append(darkness(gl, strands, px_per_mm)[row].sum())
    assert np.ptp(dark) < 0.08  # of a pixel


@pytest.mark.parametrize("slope", [0.03, 0.4])
def test_a_lock_on_the_outline_is_a_line_without_gaps(gl: moderngl.Context, slope: float) -> None:
    s = np.linspace(-0.5, 0.5, SHAFT) * 30.0
    points = np.stack([s, slope * s, np.zeros(SHAFT)], axis=-1)[None]
    lock = Strands(points, np.array([1.9]), np.zeros((1, 3)))
    # It lies on a body below it: seen from the front it shows its edge.
    across = darkness(gl, lock, 3.4, around_mm=(0.0, -100.0, 0.0)).sum(axis=0)
    middle = across[SIZE_PX // 2 - 25 : SIZE_PX // 2 - 5]  # at its end a lock thins out
    assert middle.min() > 0.6 * np.median(middle) > 0.3


def test_ribbons_have_two_vertices_a_point_and_name_their_side() -> None:
    points: npt.NDArray[np.float64] = np.array([[[0.0, 0, 0], [0, 1, 0], [0, 2, 0]]])
    strands = Strands(points, np.array([0.1]), np.ones((1, 3)), np.array([0.4]))
    rows, triangles = ribbons(strands, rng())
    assert rows.shape == (6, 14)
    assert sorted(rows[:, 6]) == [-1, -1, -1, 1, 1, 1]
    np.testing.assert_allclose(rows[:, 7], 0.05)
    np.testing.assert_allclose(rows[:, 13], 0.4)
    assert triangles.shape == (4, 3)
    assert triangles.max() == 5
