"""What a GPU is given: everything whole, nothing read back amid a frame, the same picture."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import moderngl
import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.frame.frame import FrameRenderer
from renderer.gl.context import chooses_parts
from renderer.scene import Scene, build_scene

SPEC = ClipSpec(left=Detail.uniform("low"), right=Detail.uniform("ultra"), width=320, height=180)
AZIMUTHS_DEG = (-50.0, 10.0, 60.0)


@pytest.fixture(scope="module")
def whole_scene(gl: moderngl.Context) -> Scene:
    """A scene as a GPU has it. Software GL draws it here, so the test proves pictures, no speed."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("renderer.gl.context.SOFTWARE", ())
        return build_scene(gl, SPEC)


@pytest.fixture
def as_on_a_gpu(
    gl: moderngl.Context, whole_scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> Callable[[ClipSpec], FrameRenderer]:
    def made(spec: ClipSpec) -> FrameRenderer:
        with monkeypatch.context() as patch:
            patch.setattr("renderer.gl.context.SOFTWARE", ())
            return FrameRenderer(gl, spec, scene=whole_scene)

    return made


@pytest.mark.parametrize("distance", ["macroscopic", "medium"])
def test_the_picture_is_that_of_software_gl(
    gl: moderngl.Context,
    standard_scene: Scene,
    as_on_a_gpu: Callable[[ClipSpec], FrameRenderer],
    distance: str,
) -> None:
    spec = replace(SPEC, distance=distance)
    assert chooses_parts(gl)
    chosen, whole = FrameRenderer(gl, spec, scene=standard_scene), as_on_a_gpu(spec)
    for number, azimuth_deg in enumerate(AZIMUTHS_DEG):
        ours, theirs = (each.render(azimuth_deg, time_s=number) for each in (chosen, whole))
        difference = np.abs(ours.pixels.astype(int) - theirs.pixels).max(axis=2)
        # Where tiles saw no edge, a GPU finds one here and there: at most 31 pixels of 57 600.
        assert (difference > 2).mean() < 1e-3
        assert difference.mean() < 0.02
        assert ours.visible_px == theirs.visible_px


def test_nothing_is_read_back_amid_a_frame(
    as_on_a_gpu: Callable[[ClipSpec], FrameRenderer], monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = as_on_a_gpu(SPEC)
    whole.show(0.0)

    def refused(*_: object, **__: object) -> None:
        raise AssertionError("the processor waited for the GPU")

    for kind, name in (
        (moderngl.Framebuffer, "read"),
        (moderngl.Framebuffer, "read_into"),
        (moderngl.Texture, "read"),
        (moderngl.Buffer, "read"),
        (moderngl.Query, "samples"),
        (moderngl.Context, "finish"),
    ):
        monkeypatch.setattr(kind, name, property(refused) if name == "samples" else refused)
    whole.show(10.0, time_s=0.5)
    with pytest.raises(AssertionError, match="waited"):
        whole.render(10.0, time_s=0.5)
