"""The aims' scenes: at their own size, drawn as on a GPU, in a scene that chooses no parts."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import moderngl
import numpy as np
import pytest

from renderer.benchmark import aims
from renderer.benchmark.aims import aim_steps, drawn_as_on_a_gpu
from renderer.benchmark.result import Bench
from renderer.benchmark.stand import Stand
from renderer.clip import ClipSpec
from renderer.frame.frame import Frame
from renderer.gl.context import chooses_parts


@dataclass
class Frames:
    """Stands for a renderer: notes whether what it was made of chooses parts."""

    gl: moderngl.Context
    spec: ClipSpec
    eyes_drawn: list[Any] = field(default_factory=lambda: [SimpleNamespace(iris_px=9.5)] * 60)

    def __post_init__(self) -> None:
        assert not chooses_parts(self.gl)
        assert (self.spec.width, self.spec.height) == (1920, 1080)

    def show(self, azimuth_deg: float, *, time_s: float) -> None:
        self.render(azimuth_deg, time_s=time_s)

    def render(self, azimuth_deg: float, *, time_s: float) -> Frame:
        assert not chooses_parts(self.gl)
        assert time_s >= 0.0
        assert self.spec.crowd != 30 or abs(azimuth_deg) < 1.5  # there all 60 eyes are seen
        return Frame(np.zeros((1, 1, 3), np.uint8), (0, 0))


def test_the_aims_are_measured_at_their_size_as_on_a_gpu(
    stand: Stand, known: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("FrameRenderer", "GroupRenderer"):
        monkeypatch.setattr(aims, name, Frames)
    known.rows.clear()
    for step in aim_steps(2, is_quick=True):
        step.measure(stand, known)
    eyes, group = known.rows
    assert (eyes.part, eyes.size, eyes.eyes, eyes.cube_px) == ("aims", "1920x1080", 2, 2048)
    assert (group.distance, group.crowd, group.eyes, group.iris_px) == ("group", 30, 60, 9.5)
    assert all(row.processor_ms is not None and row.draw_calls == 0 for row in known.rows)
    assert chooses_parts(stand.studio.gl)


def test_parts_are_chosen_again_after_a_failure(gl: moderngl.Context) -> None:
    with pytest.raises(ZeroDivisionError), drawn_as_on_a_gpu():
        _ = 1 // chooses_parts(gl)  # not there: by 0
    assert chooses_parts(gl)
