"""Which clock is used, how variants take turns, what a median of differences says."""

from __future__ import annotations

import time
from typing import Any

import moderngl
import numpy as np
import pytest

from renderer.benchmark.clock import (
    NUDGE_DEG,
    QUERY,
    WALL,
    WARM_UP,
    Spread,
    clock_of,
    difference,
    interleaved,
    spread_of,
    timer_of,
)


@pytest.mark.parametrize(
    ("renderer", "clock"),
    [
        ("llvmpipe (LLVM 15.0.6, 256 bits)", WALL),
        ("softpipe", WALL),
        ("Google SwiftShader", WALL),
        ("Apple Software Renderer", WALL),
        ("NVIDIA H100 80GB HBM3/PCIe/SSE2", QUERY),
        ("Mesa Intel(R) UHD Graphics 620 (KBL GT2)", QUERY),
        ("AMD Radeon RX 6800 (radeonsi, navi21, LLVM 15.0.6)", QUERY),
    ],
)
def test_software_gl_is_timed_by_the_wall_and_a_gpu_by_itself(renderer: str, clock: str) -> None:
    assert clock_of(renderer) == clock


class Frames:
    """A renderer that notes how it was called; ``busy_s`` per frame."""

    def __init__(self, busy_s: float = 0.0) -> None:
        self.called: list[str] = []
        self._busy_s = busy_s

    def render(self, azimuth_deg: float, *, time_s: float) -> None:
        self.called.append(f"render {azimuth_deg:g} {time_s:g}")
        until = time.perf_counter() + self._busy_s
        while time.perf_counter() < until:
            pass


def test_variants_take_turns_with_one_camera_while_time_runs_on() -> None:
    order: list[tuple[str, float, float]] = []

    def timer(frames: Any, azimuth_deg: float, time_s: float) -> float:
        order.append((frames, azimuth_deg, time_s))
        return float(len(order))

    variants: Any = ["a", "b"]
    times = interleaved(variants, rounds=3, timer=timer)
    assert WARM_UP == 1
    assert [name for name, _, _ in order] == ["b", "a", "a", "b", "b", "a", "a", "b"]
    assert times == [[3.0, 6.0, 7.0], [4.0, 5.0, 8.0]]  # the warm-up's frames do not count
    azimuths = [azimuth for _, azimuth, _ in order]
    assert np.subtract(azimuths[1::2], azimuths[::2]) == pytest.approx(NUDGE_DEG)
    assert np.abs(np.diff(azimuths[2::2])).min() > 5.0
    moments = [moment for _, _, moment in order]
    assert moments == sorted(set(moments))


def test_the_wall_clock_times_a_frame_that_was_read_back(gl: moderngl.Context) -> None:
    frames: Any = Frames(busy_s=0.02)
    assert timer_of(gl, WALL)(frames, 5.0, 0.5) >= 20.0
    assert frames.called == ["render 5 0.5"]


def test_a_cost_is_the_median_of_the_rounds_differences() -> None:
    # One round was disturbed, both frames of it: their difference was not.
    without = [100.0, 102.0, 180.0, 98.0, 101.0]
    with_it = [110.0, 111.0, 190.0, 109.0, 140.0]
    assert difference(with_it, without) == Spread(10.0, 1.0, 5)
    assert spread_of([3.0]) == Spread(3.0, 0.0, 1)
