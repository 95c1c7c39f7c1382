"""A GPU is kept busy while it is handed a frame, for as long as that takes and no longer."""

from __future__ import annotations

import time

import moderngl
import pytest

from renderer.benchmark import gpu_time
from renderer.benchmark.gpu_time import TRIES, GpuTimer


@pytest.fixture
def timer(gl: moderngl.Context, monkeypatch: pytest.MonkeyPatch) -> GpuTimer:
    monkeypatch.setattr(gpu_time, "LAYERS", 8)
    return GpuTimer(gl, side=256)


@pytest.fixture
def target(gl: moderngl.Context) -> moderngl.Framebuffer:
    return gl.framebuffer([gl.texture((8, 8), 4)])


def test_a_frame_that_waits_for_the_gpu_has_gaps(
    timer: GpuTimer, target: moderngl.Framebuffer
) -> None:
    tries: list[int] = []

    def submit(number: int) -> None:
        tries.append(number)
        target.clear()
        timer.gl.finish()  # the load is over before the frame has been handed over

    found = timer.time(submit)
    assert found.has_gaps
    assert found.ms >= 0.0
    assert tries == list(range(TRIES))


def test_a_frame_handed_over_while_the_gpu_is_busy_has_none(
    timer: GpuTimer, target: moderngl.Framebuffer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(timer, "_layers", lambda: 2_000)  # seconds of them, if they were waited for
    tries: list[int] = []

    def submit(number: int) -> None:
        tries.append(number)
        target.clear()

    monkeypatch.setattr(gpu_time, "_elapsed_ms", lambda _query: 2.5)
    assert timer.time(submit) == gpu_time.GpuTime(2.5, False)
    assert tries == [0]


def test_the_load_lasts_as_long_as_handing_over_took(
    timer: GpuTimer, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[int] = []
    busy = timer._busy

    def noted(layers: int) -> moderngl.Query:
        drawn.append(layers)
        return busy(1)

    monkeypatch.setattr(timer, "_busy", noted)
    monkeypatch.setattr(gpu_time, "_elapsed_ms", lambda _query: 0.1 * drawn[-1])  # a layer: 0.1 ms

    def submit(_number: int) -> None:
        until = time.perf_counter() + 0.02
        while time.perf_counter() < until:
            pass
        timer.gl.finish()

    timer.time(submit)
    assert drawn[0] == 8
    assert all(layers >= 2 * 20 / 0.1 for layers in drawn[1:])
    assert max(drawn) <= gpu_time.LONGEST_MS / 0.1
    drawn.clear()
    timer.time(submit)
    assert drawn[0] == 8  # whoever waits is never ahead: small again
