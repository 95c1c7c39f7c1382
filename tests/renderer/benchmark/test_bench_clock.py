"""Which clock is used, how variants take turns, what a median of differences says."""

from __future__ import annotations

import time
from typing import Any

import moderngl
import numpy as np
import pytest

from renderer.benchmark import clock as clocks
from renderer.benchmark.clock import (
    FPS,
    NUDGE_DEG,
    QUERY,
    REHEARSALS,
    ROW,
    ROW_DEG,
    TRY_S,
    WALL,
    WARM_UP,
    Row,
    Shot,
    clock_of,
    interleaved,
    timer_of,
)
from renderer.benchmark.gpu_time import GpuTime
from renderer.benchmark.processor import Asked, Watch
from renderer.benchmark.spread import Spread, asked_of, difference, spread_of


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

    def show(self, azimuth_deg: float, *, time_s: float) -> None:
        self.called.append(f"show {azimuth_deg:g} {time_s:g}")


def shot(ms: float, **says: Any) -> Shot:
    return Shot(ms, Asked(2 * ms, 100, 1, 0.0), **says)


def test_variants_take_turns_with_one_camera_while_time_runs_on() -> None:
    order: list[tuple[str, float, float]] = []

    def timer(frames: Any, azimuth_deg: float, time_s: float) -> Shot:
        order.append((frames, azimuth_deg, time_s))
        return shot(float(len(order)))

    variants: Any = ["a", "b"]
    shots = interleaved(variants, rounds=3, timer=timer)
    assert WARM_UP == 1
    assert [name for name, _, _ in order] == ["b", "a", "a", "b", "b", "a", "a", "b"]
    times = [[one.ms for one in own] for own in shots]
    assert times == [[3.0, 6.0, 7.0], [4.0, 5.0, 8.0]]  # the warm-up's frames do not count
    azimuths = [azimuth for _, azimuth, _ in order]
    assert np.subtract(azimuths[1::2], azimuths[::2]) == pytest.approx(NUDGE_DEG)
    assert np.abs(np.diff(azimuths[2::2])).min() > 5.0
    moments = [moment for _, _, moment in order]
    assert moments == sorted(set(moments))


def test_the_wall_clock_times_a_frame_that_was_read_back(gl: moderngl.Context) -> None:
    frames: Any = Frames(busy_s=0.02)
    spent = timer_of(gl, WALL, watch=Watch(), has_rows=True)(frames, 5.0, 0.5)
    assert spent.ms >= 20.0
    assert spent.asked.processor_ms < 10.0  # a rehearsal's, which was not busy
    assert spent.row is None  # in a row it takes as long
    rehearsed = [f"show 5 {0.5 + TRY_S * number:g}" for number in range(1, REHEARSALS + 1)]
    assert frames.called == ["render 5 0.5", *rehearsed]  # people move from one to the next


def test_a_gpus_frame_is_told_without_those_in_a_row(
    gl: moderngl.Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Gpu:
        """Runs what it is given twice, as when the first time had gaps."""

        def __init__(self, _gl: moderngl.Context) -> None: ...

        def time(self, submit: Any) -> GpuTime:
            submit(0)
            submit(1)
            return GpuTime(4.0, True)

    monkeypatch.setattr(clocks, "GpuTimer", Gpu)
    frames: Any = Frames()
    alone = timer_of(gl, QUERY, watch=Watch())(frames, 5.0, 0.5)
    assert (alone.ms, alone.has_gaps, alone.row) == (4.0, True, None)
    assert frames.called == ["show 5 0.5", "show 5 0.501"]  # never the same moment: people move
    frames.called.clear()
    spent = timer_of(gl, QUERY, watch=Watch(), has_rows=True)(frames, 5.0, 0.5)
    assert spent.row
    assert 0.0 < spent.row.ms < 50.0
    row = [tuple(map(float, call.split()[1:])) for call in frames.called[2:]]
    assert len(row) == ROW
    assert np.diff(np.asarray(row), axis=0) == pytest.approx(
        np.asarray([(ROW_DEG, 1 / FPS)] * (ROW - 1)), abs=1e-3
    )


def test_what_frames_ask_is_a_median_and_a_rows_only_where_there_are_rows() -> None:
    shots = [shot(ms) for ms in (1.0, 2.0, 9.0)]
    assert asked_of(shots) == {"processor_ms": 4.0, "draw_calls": 100, "reads": 1}
    in_rows = [shot(1.0, row=Row(ms, ms / 4)) for ms in (8.0, 12.0, 40.0)]
    assert asked_of(in_rows) | {"row_ms": 12.0, "wait_ms": 3.0} == asked_of(in_rows)


def test_a_cost_is_the_median_of_the_rounds_differences() -> None:
    # One round was disturbed, both frames of it: their difference was not.
    without = [100.0, 102.0, 180.0, 98.0, 101.0]
    with_it = [110.0, 111.0, 190.0, 109.0, 140.0]
    assert difference(list(map(shot, with_it)), list(map(shot, without))) == Spread(10.0, 1.0, 5)
    assert spread_of([shot(3.0)]) == Spread(3.0, 0.0, 1)


def test_a_difference_has_gaps_where_either_frame_has() -> None:
    whole, gappy = shot(3.0), shot(2.0, has_gaps=True)
    assert difference([whole, gappy, whole], [whole, whole, gappy]).gaps == 2
    assert spread_of([whole, gappy]).gaps == 1
