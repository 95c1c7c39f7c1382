"""The last pass: exact tone curve and sRGB, first row on top."""

from __future__ import annotations

import moderngl
import numpy as np

from renderer.frame.picture import EXPOSURE, Picture


def reference(radiance: np.ndarray) -> np.ndarray:
    u = radiance * EXPOSURE
    c = np.clip((u * (2.51 * u + 0.1163)) / (u * (2.4458 * u + 0.6162) + 0.1938), 0, 1)
    return np.where(c < 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055) * 255


def test_flat_radiance_becomes_srgb_within_the_dither(gl: moderngl.Context) -> None:
    picture = Picture(gl, (64, 64))
    for value in (0.0, 0.003, 0.0065, 0.02, 0.05, 0.18, 0.7, 2.0, 8.0, 11.0, 40.0, 60000.0):
        picture.begin()
        picture.target.clear(value, value / 2, value / 4, 1.0)
        frame = picture.finish().astype(float)
        for channel, share in enumerate((1, 0.5, 0.25)):
            wanted = reference(np.array(value * share))
            assert np.abs(frame[..., channel] - wanted).max() <= 1.02
            assert abs(frame[..., channel].mean() - wanted) < 0.08, (value, channel)


def test_the_first_row_is_the_top_and_equal_frames_are_equal_bytes(gl: moderngl.Context) -> None:
    picture = Picture(gl, (64, 32))
    frames = []
    for _ in range(2):
        picture.begin()
        picture.use_rectangle((0, 16, 64, 16))  # the upper half in GL's order
        picture.target.clear(1.0, 1.0, 1.0, 1.0, viewport=(0, 16, 64, 16))
        frames.append(picture.finish())
    assert frames[0].shape == (32, 64, 3)
    assert frames[0][:16].min() > 190
    assert frames[0][17:].max() <= 44  # its bloom
    assert frames[0][-1].max() < frames[0][16].min()
    assert frames[0].tobytes() == frames[1].tobytes()


def test_radiance_is_what_was_drawn_first_row_on_top(gl: moderngl.Context) -> None:
    picture = Picture(gl, (64, 32))
    picture.begin()
    picture.target.clear(0.25, 900.0, 3.0, 1.0, viewport=(0, 16, 64, 16))
    radiance = picture.radiance()
    assert radiance.shape == (32, 64, 3)
    assert radiance.dtype == np.float32
    np.testing.assert_array_equal(radiance[:16], np.broadcast_to([0.25, 900.0, 3.0], (16, 64, 3)))
    assert not radiance[16:].any()
