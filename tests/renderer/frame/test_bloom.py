"""Bloom scatters a share of the light, loses none, and keeps to its view."""

from __future__ import annotations

import moderngl
import numpy as np
import pytest

from renderer.frame.bloom import Bloom


def glow(
    gl: moderngl.Context,
    size: tuple[int, int],
    light: tuple[int, int, int, int],
    *,
    views: int = 1,
) -> np.ndarray:
    """Blur a black picture with one lit rectangle (x, y, width, height); (rows, columns)."""
    radiance = gl.texture(size, 4, dtype="f2")
    target = gl.framebuffer([radiance])
    target.clear(0.0, 0.0, 0.0, 1.0)
    target.clear(100.0, 50.0, 0.0, 1.0, viewport=light)
    texture = Bloom(gl, size, views=views).blurred(radiance)
    values = np.frombuffer(texture.read(), np.float16).astype(float)
    picture = values.reshape(texture.size[1], texture.size[0], 4)
    np.testing.assert_allclose(picture[..., 1], picture[..., 0] / 2, rtol=0.01, atol=1e-4)
    return picture[..., 0]


@pytest.mark.parametrize("size", [(512, 512), (516, 500)])
def test_a_light_keeps_its_energy_and_falls_off_without_end(
    gl: moderngl.Context, size: tuple[int, int]
) -> None:
    picture = glow(gl, size, (248, 248, 12, 12))
    assert picture.sum() * 16 == pytest.approx(100.0 * 144, rel=0.03)
    row = picture[63, 64:]
    assert (np.diff(row[:30]) < 0).all()
    assert row[0] > 20 * row[8] > 0


def test_an_even_picture_stays_what_it_is(gl: moderngl.Context) -> None:
    picture = glow(gl, (192, 108), (0, 0, 192, 108), views=2)
    np.testing.assert_allclose(picture, 100.0, rtol=2e-3)


def test_one_view_gives_the_other_no_light(gl: moderngl.Context) -> None:
    picture = glow(gl, (200, 96), (88, 40, 12, 12), views=2)
    middle = picture.shape[1] // 2
    assert picture[:, :middle].max() > 1
    assert not picture[:, middle:].any()
    assert glow(gl, (200, 96), (88, 40, 12, 12))[:, 25:].max() > 1


def test_the_glow_moves_with_the_light(gl: moderngl.Context) -> None:
    """No grid shows: half a texel's step moves the centroid by half a texel."""
    columns = np.arange(128) * 4 + 2
    centroids = []
    for x in range(240, 245):
        picture = glow(gl, (512, 512), (x, 240, 8, 8))
        centroids.append(float((picture.sum(axis=0) * columns).sum() / picture.sum()))
    np.testing.assert_allclose(np.diff(centroids), 1.0, atol=0.12)
