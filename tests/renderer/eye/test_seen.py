"""What hides an eye saves its shading, and changes nothing that is seen."""

from __future__ import annotations

from contextlib import nullcontext
from typing import Any

import moderngl
import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye.eyes import Eyes
from renderer.frame.frame import FrameRenderer
from renderer.scene import Scene

HIGH = Detail.uniform("high")
SPEC = ClipSpec(left=HIGH, right=HIGH, width=320, height=180)


def drawn(gl: moderngl.Context, scene: Scene) -> tuple[Any, int]:
    """Return a frame's pixels and how many the left eye's picture has shaded."""
    renderer = FrameRenderer(gl, SPEC, scene=scene)
    pixels = renderer.render(20.0).pixels.astype(int)
    picture = renderer.eye_models[0].shaded.uniforms("u_shaded")["u_shaded"]
    alpha = np.frombuffer(picture.read(), np.float16).reshape(-1, 4)[:, 3]
    return pixels, int((alpha > 0).sum())


def test_only_what_is_seen_of_an_eye_is_shaded(
    gl: moderngl.Context, standard_scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    pixels, count = drawn(gl, standard_scene)
    monkeypatch.setattr(Eyes, "_only_seen", lambda *_args, **_kwargs: nullcontext())
    every, whole = drawn(gl, standard_scene)
    assert np.abs(pixels - every).max() <= 2
    assert 0 < count < 0.75 * whole
