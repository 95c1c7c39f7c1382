"""Skin in the picture: its relief shows where pixels can carry it, and moves without shimmer."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Final

import moderngl
import numpy as np
import pytest
from scipy import ndimage

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.head.head import Head
from renderer.head.sun_shadow import build_light
from renderer.light import Light, Sky
from renderer.view import look_at, perspective

SIZE: Final = (288, 192)
CHEEK: Final = (33.0, -25.0, 12.0)
SHARE: Final = np.array([0.2126, 0.7152, 0.0722])


@pytest.fixture(scope="module")
def scene(gl: moderngl.Context) -> Iterator[tuple[Head, Light]]:
    low = Detail.uniform("low")
    head = Head(gl, ClipSpec(left=low, right=low))
    towards = np.array([-0.3, 0.65, 0.7])
    harmonics = np.zeros((9, 3))
    harmonics[0] = 0.4 / 0.282095
    harmonics[1] = 0.15
    sky = Sky(towards / np.linalg.norm(towards), np.full(3, 2.4), harmonics)
    light = build_light(gl, sky, head)
    yield head, light
    light.shadow_map.release()


def skin(
    gl: moderngl.Context, scene: tuple[Head, Light], *, px_per_mm: float, azimuth_deg: float = 0.0
) -> np.ndarray:
    """Return the luminance (h, w) of the cheek at a density on the picture."""
    distance = 170.0 if px_per_mm > 6 else 1500.0
    turn = math.radians(azimuth_deg)
    target = np.array(CHEEK)
    place = target + distance * np.array([math.sin(turn), 0.0, math.cos(turn)])
    fov_deg = 2 * math.degrees(math.atan(SIZE[1] / px_per_mm / 2 / distance))
    texture = gl.texture(SIZE, 4, dtype="f4")
    frame = gl.framebuffer([texture], gl.depth_renderbuffer(SIZE))
    frame.use()
    frame.clear()
    lens = perspective(fov_deg, SIZE[0] / SIZE[1], distance / 2, distance * 2)
    head, light = scene
    head.draw(view_matrix=look_at(place, target), projection=lens, camera_mm=place, light=light)
    data = np.frombuffer(texture.read(), dtype=np.float32)
    frame.release()
    picture = data.reshape(SIZE[1], SIZE[0], 4)[..., :3]
    assert np.isfinite(picture).all()
    return np.asarray(picture @ SHARE)


def contrast(picture: np.ndarray, middle: int, *, blur_px: float) -> float:
    """Return the spread of what a blur takes away, as a share of the mean, in a middle square."""
    row, column = (SIZE[1] - middle) // 2, (SIZE[0] - middle) // 2
    square = np.s_[row : row + middle, column : column + middle]
    fine = picture - ndimage.gaussian_filter(picture, blur_px)
    return float(fine[square].std() / picture[square].mean())


def test_relief_shows_in_a_macro_view_and_is_gone_from_far(
    gl: moderngl.Context, scene: tuple[Head, Light]
) -> None:
    macro, far = (skin(gl, scene, px_per_mm=density) for density in (30.0, 1.03))
    shown = contrast(macro, 160, blur_px=4.0)
    assert shown > 0.03
    assert contrast(far, 14, blur_px=1.0) < 0.4 * shown  # the cheek without lids and nose
    assert macro.mean() == pytest.approx(far[90:102, 138:150].mean(), rel=0.12)


def test_relief_breaks_the_sheen_into_glints(
    gl: moderngl.Context, scene: tuple[Head, Light]
) -> None:
    macro = skin(gl, scene, px_per_mm=30.0, azimuth_deg=30.0)
    fine = macro - ndimage.gaussian_filter(macro, 4.0)
    assert float(((fine / fine.std()) ** 3).mean()) > 0.1  # bright points, not dark ones, stand out


@pytest.mark.parametrize("px_per_mm", [30.0, 13.7, 3.4, 1.03])
def test_skin_does_not_shimmer_on_the_orbit(
    gl: moderngl.Context, scene: tuple[Head, Light], px_per_mm: float
) -> None:
    """Equal small turns change the picture equally, and no pixel flares up."""
    frames = [
        skin(gl, scene, px_per_mm=px_per_mm, azimuth_deg=35.0 + 0.05 * step) for step in range(4)
    ]
    steps = [np.abs(b - a) for a, b in pairwise(frames)]
    means = [float(step.mean()) for step in steps]
    assert max(means) < 1.6 * min(means)
    assert max(means) < 0.02 * frames[0].mean()
    flares = [float(np.percentile(step, 99.9)) for step in steps]
    assert max(flares) < 0.5 * frames[0].mean()


def test_the_same_view_gives_the_same_skin(gl: moderngl.Context, scene: tuple[Head, Light]) -> None:
    first, again = (skin(gl, scene, px_per_mm=30.0, azimuth_deg=-20.0) for _ in range(2))
    np.testing.assert_array_equal(first, again)
