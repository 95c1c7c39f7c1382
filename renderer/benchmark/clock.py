"""How long a frame takes: wall time on software GL, the GPU's own clock on a GPU.

Software GL draws on worker threads after a timer query has ended (1.5 ms were told for a draw of
61 ms), so only the time until the picture is there counts. A GPU's pictures stay on the GPU, as a
game's do: its clock tells how long it works on a frame that has been handed over (``gpu_time``).
What a game sees is neither, but frames that follow one another: a ``Row``.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final, Protocol

import moderngl

from renderer.benchmark.gpu_time import GpuTimer
from renderer.benchmark.processor import Asked, Watch
from renderer.frame.frame import Frame
from renderer.gl.context import is_software

WALL, QUERY = "wall time", "timer queries"
WARM_UP: Final = 1  # the first frame builds the eyes and compiles their shaders
# Over the orbit, from the side to the front and back: costs follow what is seen.
AZIMUTHS_DEG: Final = (-50.0, 35.0, -20.0, 5.0, 50.0, -35.0, 20.0, -5.0, 0.0)
NUDGE_DEG: Final = 0.01  # between the frames of a round: nothing kept for a camera is there yet
FPS: Final = 30
ROW: Final = 30  # frames one after the other: a second of a clip
ROW_DEG: Final = 0.8  # between them: an orbit of 120 degrees in 5 s
REHEARSALS: Final = 4  # the last one finds the caches as frames that follow one another do
TRY_S: Final = 1e-3  # between tries of one frame: people who stood still would cost nothing


class Timed(Protocol):
    """What draws frames: of a clip, or of a group of people."""

    def render(self, azimuth_deg: float, *, time_s: float) -> Frame:
        """Draw a frame and read it back."""
        ...

    def show(self, azimuth_deg: float, *, time_s: float) -> None:
        """Draw a frame and leave it where it is."""
        ...


@dataclass(frozen=True)
class Row:
    """ROW frames submitted one after the other: ms of wall time each, and of it in reading back."""

    ms: float
    wait_ms: float


@dataclass(frozen=True)
class Shot:
    """One frame: ``ms`` by the clock, and what it asked of the processor.

    ``has_gaps``: a GPU's time that counts waiting for commands. ``row``: frames like it in a row.
    """

    ms: float
    asked: Asked
    has_gaps: bool = False
    row: Row | None = None


Timer = Callable[[Timed, float, float], Shot]


def clock_of(gl_renderer: str) -> str:
    """Return which clock tells the truth on a GL renderer: WALL or QUERY."""
    return WALL if is_software(gl_renderer) else QUERY


def timer_of(gl: moderngl.Context, clock: str, *, watch: Watch, has_rows: bool = False) -> Timer:
    """Return a function of renderer, azimuth (degrees) and scene time (s).

    With ``has_rows`` a GPU draws frames in a row, too; software GL takes as long for each of them.
    """

    def wall(frames: Timed, azimuth_deg: float, time_s: float) -> Shot:
        gl.finish()
        watch.begin()
        started = time.perf_counter()
        frames.render(azimuth_deg, time_s=time_s)
        ms = (time.perf_counter() - started) * 1e3
        return Shot(ms, replace(watch.asked(), processor_ms=rehearsed(frames, azimuth_deg, time_s)))

    def rehearsed(frames: Timed, azimuth_deg: float, time_s: float) -> float:
        with watch.rehearsing():
            for number in range(REHEARSALS):
                watch.begin()
                frames.show(azimuth_deg, time_s=time_s + TRY_S * (number + 1))
        return watch.asked().processor_ms

    if clock == WALL:
        return wall
    timer = GpuTimer(gl)

    def query(frames: Timed, azimuth_deg: float, time_s: float) -> Shot:
        asked: list[Asked] = []

        def submit(number: int) -> None:
            watch.begin()
            frames.show(azimuth_deg, time_s=time_s + TRY_S * number)
            asked.append(watch.asked())

        spent = timer.time(submit)
        row = _in_a_row(gl, watch, frames, azimuth_deg, time_s) if has_rows else None
        return Shot(spent.ms, asked[-1], spent.has_gaps, row)

    return query


def _in_a_row(
    gl: moderngl.Context, watch: Watch, frames: Timed, azimuth_deg: float, time_s: float
) -> Row:
    """Submit ROW frames one after the other, as a game does, and wait for the last one only.

    The first one's submission and the last one's drawing have nothing beside them, which makes a
    row at most 1 / ROW longer than endless ones.
    """
    gl.finish()
    watch.begin()
    started = time.perf_counter()
    for number in range(ROW):
        turned_deg = ROW_DEG * (number - ROW / 2)
        frames.show(azimuth_deg + turned_deg, time_s=time_s + (number + 1) / FPS)
    gl.finish()
    ms = (time.perf_counter() - started) * 1e3
    return Row(ms / ROW, watch.asked().wait_ms / ROW)


def interleaved(variants: Sequence[Timed], *, rounds: int, timer: Timer) -> list[list[Shot]]:
    """Time variants in turn, A B, B A, A B: what slows the machine for a while slows them all.

    Returns a list of ``rounds`` shots per variant. Within a round all have the same camera but for
    NUDGE_DEG; time runs on from frame to frame, because people who stand still would cost nothing.
    Every other round runs backwards, so that nobody is always first.
    """
    shots: list[list[Shot]] = [[] for _ in variants]
    step = 0
    for number in range(-WARM_UP, rounds):
        azimuth_deg = AZIMUTHS_DEG[number % len(AZIMUTHS_DEG)]
        order = list(enumerate(variants))
        for turn, (place, frames) in enumerate(order if number % 2 == 0 else order[::-1]):
            shot = timer(frames, azimuth_deg + NUDGE_DEG * turn, step / FPS)
            step += 1
            if number >= 0:
                shots[place].append(shot)
    return shots
