"""How long a frame takes: wall time on software GL, the GPU's own clock on a GPU.

Software GL draws on worker threads after a timer query has ended (1.5 ms were told for a draw of
61 ms), so only the time until the picture is there counts. A GPU's pictures stay on the GPU, as a
game's do: its clock counts drawing alone, neither Python nor reading back.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, Protocol

import moderngl

from renderer.frame.frame import Frame
from renderer.gl.context import is_software

WALL, QUERY = "wall time", "timer queries"
WARM_UP: Final = 1  # the first frame builds the eyes and compiles their shaders
# Over the orbit, from the side to the front and back: costs follow what is seen.
AZIMUTHS_DEG: Final = (-50.0, 35.0, -20.0, 5.0, 50.0, -35.0, 20.0, -5.0, 0.0)
NUDGE_DEG: Final = 0.01  # between the frames of a round: nothing kept for a camera is there yet
FPS: Final = 30


class Timed(Protocol):
    """What draws frames: of a clip, or of a group of people."""

    def render(self, azimuth_deg: float, *, time_s: float) -> Frame:
        """Draw a frame and read it back."""
        ...

    def show(self, azimuth_deg: float, *, time_s: float) -> None:
        """Draw a frame and leave it where it is."""
        ...


Timer = Callable[[Timed, float, float], float]


def clock_of(gl_renderer: str) -> str:
    """Return which clock tells the truth on a GL renderer: WALL or QUERY."""
    return WALL if is_software(gl_renderer) else QUERY


def timer_of(gl: moderngl.Context, clock: str) -> Timer:
    """Return a function of renderer, azimuth (degrees) and scene time (s): a frame's ms."""

    def wall(frames: Timed, azimuth_deg: float, time_s: float) -> float:
        gl.finish()
        started = time.perf_counter()
        frames.render(azimuth_deg, time_s=time_s)
        return (time.perf_counter() - started) * 1e3

    def query(frames: Timed, azimuth_deg: float, time_s: float) -> float:
        gl.finish()
        spent = gl.query(time=True)
        with spent:
            frames.show(azimuth_deg, time_s=time_s)
        return int(spent.elapsed) / 1e6

    return {WALL: wall, QUERY: query}[clock]


def interleaved(variants: Sequence[Timed], *, rounds: int, timer: Timer) -> list[list[float]]:
    """Time variants in turn, A B, B A, A B: what slows the machine for a while slows them all.

    Returns a list of ``rounds`` milliseconds per variant. Within a round all have the same camera
    but for NUDGE_DEG; time runs on from frame to frame, because people who stand still would cost
    nothing. Every other round runs backwards, so that nobody is always first.
    """
    times: list[list[float]] = [[] for _ in variants]
    step = 0
    for number in range(-WARM_UP, rounds):
        azimuth_deg = AZIMUTHS_DEG[number % len(AZIMUTHS_DEG)]
        order = list(enumerate(variants))
        for turn, (place, frames) in enumerate(order if number % 2 == 0 else order[::-1]):
            ms = timer(frames, azimuth_deg + NUDGE_DEG * turn, step / FPS)
            step += 1
            if number >= 0:
                times[place].append(ms)
    return times


@dataclass(frozen=True)
class Spread:
    """Median and median absolute deviation of ``n`` milliseconds."""

    median: float
    mad: float
    n: int


def spread_of(values: Sequence[float]) -> Spread:
    """Return the median of some milliseconds and how far they lie from it."""
    median = statistics.median(values)
    deviation = statistics.median(abs(value - median) for value in values)
    return Spread(round(median, 3), round(deviation, 3), len(values))


def difference(with_it: Sequence[float], without: Sequence[float]) -> Spread:
    """Return the spread of the rounds' differences: with minus without."""
    return spread_of([a - b for a, b in zip(with_it, without, strict=True)])
