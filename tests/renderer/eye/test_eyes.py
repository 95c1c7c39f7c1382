"""The eye on the GPU: physics first, on flat maps whose answers are known."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from renderer.detail import Detail
from renderer.eye.anatomy import CORNEA_IOR
from renderer.eye.lids import LidRims
from renderer.eye.model import APPARENT_GAIN, gaze_rotation
from renderer.eye.optics import fresnel
from renderer.eye.silhouette import opening_box, opening_points

ALBEDO = np.array([0.3, 0.2, 0.1], np.float32)
OFF = Detail.uniform("off")
HALF_MM = 7.0  # half the picture's height at the eye


def pupil_mm(pixels: np.ndarray) -> float:
    """Return the apparent pupil's diameter from the dark area of the picture."""
    mm_per_px = 2 * HALF_MM / pixels.shape[0]
    rows, columns = np.indices(pixels.shape[:2])
    centre_y, centre_x = (pixels.shape[0] - 1) / 2, (pixels.shape[1] - 1) / 2
    radius = np.hypot(rows - centre_y, columns - centre_x) * mm_per_px
    iris = np.median(pixels[(radius > 2.8) & (radius < 3.4), 0])
    dark = np.clip(1 - pixels[..., 0] / iris, 0, 1)[radius < 2.7].sum()
    return 2 * math.sqrt(float(dark) * mm_per_px**2 / math.pi)


def test_refraction_magnifies_the_pupil(bench: Any) -> None:
    """4.00 mm looks 4.44 mm wide: 4.48 near the axis (reference 1.3), less off it, by Snell's law.

    The ray along the axis from r = 2.22 mm: slope 16.4 degrees, bent by 4.2, meets 2.00 mm.
    """
    refracting = OFF.with_levels(refraction="high", tessellation="ultra")
    assert pupil_mm(bench.picture(bench.eyes(OFF), size=(200, 200))) == pytest.approx(4.0, abs=0.03)
    magnified = bench.picture(bench.eyes(refracting), size=(200, 200))
    assert pupil_mm(magnified) == pytest.approx(4.44, abs=0.02)


def test_the_pupils_diameter_is_the_clips(bench: Any) -> None:
    wide = bench.picture(bench.eyes(OFF, pupil_mm=5.0), size=(120, 120))
    assert pupil_mm(wide) == pytest.approx(5.0, abs=0.06)


def test_furnace_the_iris_leaves_its_albedo_and_fresnels_share(bench: Any) -> None:
    """Under radiance 1 from everywhere a flat interface lets in all but Fresnel's diffuse share.

    So the iris shows gain x albedo x that x (1 - F), and F on top, but for what the limbus hides.
    """
    row = Detail.uniform("ultra").with_levels(texture="off", subsurface="off")
    pixels = bench.picture(bench.eyes(row), size=(96, 96))
    at = 48 + round(2.6 / (2 * HALF_MM / 96))
    f0 = ((CORNEA_IOR - 1) / (CORNEA_IOR + 1)) ** 2
    cosines = (np.arange(2000) + 0.5) / 2000
    let_in = 1.0 - np.mean(2 * cosines * fresnel(cosines))
    assert let_in == pytest.approx(0.933, abs=0.002)
    expected = APPARENT_GAIN * ALBEDO * let_in * (1 - f0) + f0
    np.testing.assert_allclose(pixels[48, at], expected, rtol=0.03)


def test_without_cornea_the_iris_is_lambertian(bench: Any) -> None:
    pixels = bench.picture(bench.eyes(OFF))
    np.testing.assert_allclose(pixels[32, 32 + 14], ALBEDO, rtol=0.01)


@pytest.mark.parametrize(
    ("effect", "level"),
    [
        ("refraction", "medium"),
        ("reflection", "low"),
        ("subsurface", "medium"),
        ("caustics", "medium"),
    ],
)
def test_levels_that_the_table_leaves_out_equal_off(bench: Any, effect: str, level: str) -> None:
    base = Detail.uniform("high")
    row, off = base.with_levels(**{effect: level}), base.with_levels(**{effect: "off"})
    draw = [bench.picture(bench.eyes(d, sun=2.0), azimuth_deg=20) for d in (row, off)]
    np.testing.assert_array_equal(draw[0], draw[1])


def test_levels_that_are_off_leave_no_uniform_behind(bench: Any) -> None:
    eyes = bench.eyes(OFF, Detail.uniform("ultra"))
    names = ("u_caustic_map", "u_thickness", "u_static_cube", "u_crowd_cube", "u_sclera_normal")
    assert [eyes.is_active(0, name) for name in names] == [False] * 5
    assert [eyes.is_active(1, name) for name in names] == [True] * 5


def test_only_reflection_brings_a_glint_to_the_cornea(bench: Any) -> None:
    peaks = {}
    for level in ("off", "medium", "high"):
        row = Detail.uniform("low").with_levels(reflection=level, tessellation="ultra")
        pixels = bench.picture(bench.eyes(row, sun=2.0), size=(160, 160))
        cornea = np.hypot(*(np.indices((160, 160)) - 79.5)) * 2 * HALF_MM / 160 < 4.0
        peaks[level] = float(pixels[cornea].max())
    assert peaks["off"] < 0.7
    assert peaks["medium"] > peaks["off"] + 0.2
    assert peaks["high"] > 10 * peaks["medium"]


def test_the_glint_lies_towards_the_sun(bench: Any) -> None:
    row = Detail.uniform("low").with_levels(reflection="high", tessellation="ultra")
    pixels = bench.picture(bench.eyes(row, sun=2.0), size=(160, 160))
    y, x = np.unravel_index(int(np.argmax(pixels[..., 0])), (160, 160))
    assert x < 70
    assert y > 90


def test_the_caustic_gathers_light_opposite_the_sun(bench: Any) -> None:
    row = OFF.with_levels(refraction="high", caustics="high", tessellation="ultra")
    low_sun = (-math.sin(math.radians(65)), 0.0, math.cos(math.radians(65)))
    eyes = bench.eyes(row, sun=2.0, sky=0.0, toward_sun=low_sun)
    pixels = bench.picture(eyes, size=(96, 96))
    assert pixels[48, 48 + 24, 0] > 1.5 * pixels[48, 48 - 24, 0] > 0


def test_gaze_turns_the_eye(bench: Any) -> None:
    ahead = bench.picture(bench.eyes(OFF))
    right = bench.picture(bench.eyes(OFF, gaze_yaw_deg=15.0, gaze_pitch_deg=10.0))

    def darkest(pixels: np.ndarray) -> np.ndarray:
        return np.argwhere(pixels[..., 2] < 0.02).mean(axis=0)

    disc = np.hypot(*(np.indices((64, 64)) - 31.5)) < 24
    shift = darkest(np.where(disc[..., None], right, 1)) - darkest(
        np.where(disc[..., None], ahead, 1)
    )
    plane_px = 9.3826 / (2 * HALF_MM / 64)
    expected = gaze_rotation(15.0, 10.0)[:, 2] * plane_px
    np.testing.assert_allclose(shift, [expected[1], expected[0]], atol=1.0)


def test_the_right_eyes_maps_are_the_lefts_mirrored(bench: Any) -> None:
    row = OFF.with_levels(texture="low", tessellation="low")
    eyes = bench.eyes(row, row)
    left, right = bench.picture(eyes, 0), bench.picture(eyes, 1)
    assert left[32, 48, 0] > 1.2 * left[32, 15, 0]
    np.testing.assert_allclose(left[24:40, 8:56], right[24:40, 8:56][:, ::-1], atol=0.02)


def test_the_upper_lid_shades_the_globe(bench: Any, average_rims: tuple[LidRims, LidRims]) -> None:
    shaded = bench.picture(bench.eyes(OFF, sun=2.0, rims=average_rims))
    free = bench.picture(bench.eyes(OFF, sun=2.0))
    middle, top = 32 + 12, 32 + 17  # 2.6 and 3.7 mm above the axis
    ratio = shaded[..., 0] / np.maximum(free[..., 0], 1e-6)
    assert ratio[top, 32] < 0.6 * ratio[middle - 20, 44]
    assert ratio[middle - 20, 44] > 0.6


def test_our_integrator_and_the_thesiss_sum_agree_up_to_its_bias(bench: Any) -> None:
    row = Detail.uniform("ultra").with_levels(texture="off", reflection="off", sclera="low")
    ours = bench.picture(bench.eyes(row, sun=2.0))[32, 48]
    many = bench.picture(bench.eyes(row, sun=2.0, subsurface_samples=200))[32, 48]
    few = bench.picture(bench.eyes(row, sun=2.0, subsurface_samples=10))[32, 48]
    np.testing.assert_allclose(ours, many, rtol=0.01)
    assert (few > 1.02 * ours).all()


def test_the_same_eye_has_the_same_bytes(bench: Any) -> None:
    first, second = (
        bench.picture(bench.eyes(Detail.uniform("ultra"), sun=2.0), azimuth_deg=-35)
        for _ in range(2)
    )
    assert first.tobytes() == second.tobytes()


def test_ultra_reflection_asks_for_the_crowd(bench: Any) -> None:
    with pytest.raises(ValueError, match="reflection=ultra mirrors moving people"):
        bench.picture(bench.eyes(Detail.uniform("ultra"), has_crowd=False))


def test_meshes_are_seen_when_facets_are_flat(bench: Any) -> None:
    """Off has the lowest mesh's facets: fewer shades of the white than vertex normals give."""

    def shades(level: str) -> int:
        row = OFF.with_levels(tessellation=level)
        pixels = bench.picture(bench.eyes(row, sun=2.0, sky=0.0))
        radius = np.hypot(*(np.indices((64, 64)) - 31.5)) * 2 * HALF_MM / 64
        return len(np.unique(np.round(pixels[radius > 7.2, 0], 4)))

    assert shades("off") < 0.5 * shades("low")


def test_the_opening_box_holds_the_lids_and_the_cornea(
    average_rims: tuple[LidRims, LidRims],
) -> None:
    rims = average_rims[0]
    orthographic = np.diag([1 / 20, 1 / 10, 1 / 20, 1.0])  # 40 x 20 mm on 400 x 200 px
    x, y, width, height = opening_box(opening_points(rims), orthographic, (400, 200))
    assert x <= 200 + 10 * rims.upper_mm[0, 0] <= x + width
    assert y + height == pytest.approx(100 + 10 * (rims.upper_mm[:, 1].max() + 1.5), abs=3)
    assert y == pytest.approx(100 + 10 * (rims.lower_mm[:, 1].min() - 1.5), abs=3)
