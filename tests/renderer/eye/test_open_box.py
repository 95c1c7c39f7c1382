"""Eyes are drawn where the lids leave them open: nothing that is seen is lost by it."""

from __future__ import annotations

import moderngl
import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye import eyes as eyes_module
from renderer.eye.eyes import Eyes
from renderer.eye.models import EyeModels
from renderer.eye.silhouette import Box, common_box
from renderer.frame.frame import FrameRenderer
from renderer.scene import Scene
from renderer.view import look_at, perspective

LOW, HIGH = Detail.uniform("low"), Detail.uniform("high")
AZIMUTHS_DEG = (-50.0, 0.0, 35.0)


@pytest.fixture
def boxes(monkeypatch: pytest.MonkeyPatch) -> list[Box]:
    """Note the boxes that eyes are drawn in."""
    noted: list[Box] = []

    def noting(first: Box, second: Box) -> Box:
        noted.append(common_box(first, second))
        return noted[-1]

    monkeypatch.setattr(eyes_module, "common_box", noting)
    return noted


def test_the_box_loses_nothing_and_spares_most_of_the_picture(
    gl: moderngl.Context,
    standard_scene: Scene,
    boxes: list[Box],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    spec = ClipSpec(left=LOW, right=HIGH, width=320, height=180)
    renderer = FrameRenderer(gl, spec, scene=standard_scene)
    confined = [renderer.render(azimuth) for azimuth in AZIMUTHS_DEG]
    half = 160 * 180
    assert len(boxes) == 12  # three frames of two eyes, each drawn and outlined
    assert all(0 < width * height < 0.6 * half for _, _, width, height in boxes)
    monkeypatch.setattr(eyes_module, "common_box", lambda first, _second: first)
    for azimuth, frame in zip(AZIMUTHS_DEG, confined, strict=True):
        whole = renderer.render(azimuth)
        np.testing.assert_array_equal(frame.pixels, whole.pixels)
        assert frame.visible_px == whole.visible_px


def test_a_targets_own_box_still_holds_and_comes_back(
    gl: moderngl.Context, standard_scene: Scene, boxes: list[Box]
) -> None:
    spec = ClipSpec(left=LOW, right=LOW, width=320, height=180)
    eyes = Eyes(
        gl,
        EyeModels(
            gl,
            spec,
            rims=standard_scene.head.rims,
            light=standard_scene.light,
            static_cube=standard_scene.surroundings.cube,
            crowd_cube=None,
        ),
    )
    target = gl.framebuffer([gl.texture((64, 64), 4)], gl.depth_texture((64, 64)))
    target.use()
    target.clear()
    target.scissor = (0, 0, 32, 40)
    camera = np.array([-31.0, 0.0, 200.0])
    view = look_at(camera, np.array([-31.0, 0.0, 0.0]))
    eyes.draw(0, view_matrix=view, projection=perspective(8.0, 1.0, 100, 300), camera_mm=camera)
    assert target.scissor == (0, 0, 32, 40)
    assert boxes[0][2] <= 32
    pixels = np.frombuffer(target.read(components=3, alignment=1), np.uint8).reshape(64, 64, 3)
    assert pixels[:, 32:].max() == 0
    assert pixels[:40, :32].max() > 0


def test_boxes_apart_share_nothing() -> None:
    assert common_box((0, 0, 10, 10), (4, 6, 10, 10)) == (4, 6, 6, 4)
    assert common_box((0, 0, 10, 10), (20, 2, 5, 5))[2:] == (0, 5)
