"""The stand that a benchmark runs on: one GL context, one scene, one clock, rows from times."""

from __future__ import annotations

import os
import platform
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from renderer.benchmark.clock import QUERY, Shot, Timed, clock_of, interleaved, timer_of
from renderer.benchmark.processor import watched
from renderer.benchmark.result import About, Bench, Cost
from renderer.benchmark.spread import Spread, asked_of, spread_of
from renderer.camera import iris_px
from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.frame.frame import FrameRenderer
from renderer.sources import code_version
from renderer.studio import Studio

BOTH, ONE = (0, 1), (0,)  # one eye is the viewer's left


@dataclass(frozen=True)
class Step:
    """A piece of a benchmark: ``weight`` guesses its share of the time, in ultra frames."""

    part: str
    title: str
    weight: float
    measure: Callable[[Stand, Bench], None]


class Stand:
    """Make renderers of one size and time them."""

    def __init__(self, studio: Studio, size: tuple[int, int], *, rounds: int) -> None:
        self.load_before = load()
        self.studio = studio
        self.size = size
        self.rounds = rounds
        self.clock = clock_of(self.studio.gl_renderer)
        self._kept: FrameRenderer | None = None

    def spec(
        self,
        detail: Detail,
        distance: str = "macroscopic",
        *,
        eyes: tuple[int, ...] = ONE,
        **changes: Any,
    ) -> ClipSpec:
        """Return a clip at this stand's size of two equal eyes, or of one and one that is off."""
        width, height = self.size
        left, right = (detail if eye in eyes else Detail() for eye in BOTH)
        return ClipSpec(
            left=left, right=right, distance=distance, width=width, height=height, **changes
        )

    def frames(self, spec: ClipSpec, *, eyes: tuple[int, ...] = ONE) -> FrameRenderer:
        """Return a renderer of a clip's frames, in the scene of the last one where it fits."""
        return self.studio.renderer(spec, eyes=eyes)

    def kept_frames(self, spec: ClipSpec) -> FrameRenderer:
        """Return the same for a clip that many steps compare with; the last one asked for stays."""
        if self._kept is None or self._kept.spec != spec:
            self._kept = self.frames(spec)
        return self._kept

    def time(self, variants: Sequence[Timed], *, are_whole: bool = False) -> list[list[Shot]]:
        """Return a shot per variant and round, taken in turn; whole frames have their rows, too."""
        with watched() as watch:
            timer = timer_of(self.studio.gl, self.clock, watch=watch, has_rows=are_whole)
            return interleaved(variants, rounds=self.rounds, timer=timer)

    def frame_row(self, part: str, spec: ClipSpec, shots: Sequence[Shot], **says: Any) -> Cost:
        """Return a row of whole frames: their time and what they asked of the processor."""
        return self.row(part, spec, spread_of(shots), **asked_of(shots), **says)

    def row(self, part: str, spec: ClipSpec, spread: Spread, **says: Any) -> Cost:
        """Return one row of ``bench.json``: of a clip of one eye, unless it ``says`` otherwise."""
        seen: dict[str, Any] = {
            "distance": spec.distance,
            "iris_px": round(iris_px(spec, 0.0)[0], 2),
            "eyes": len(ONE),
        }
        return Cost(
            part=part,
            renderer=self.studio.gl_renderer,
            size=f"{spec.width}x{spec.height}",
            ms_median=spread.median,
            ms_mad=spread.mad,
            n=spread.n,
            load=load(),
            gaps=spread.gaps if self.clock == QUERY else None,
            **{**seen, **says},
        )

    def about(self, *, is_quick: bool, seconds: float) -> About:
        """Return the conditions of the measurement."""
        return About(
            renderer=self.studio.gl_renderer,
            gl_version=self.studio.gl_version,
            clock=self.clock,
            size="{}x{}".format(*self.size),
            code_version=code_version(),
            processor=processor(Path("/proc/cpuinfo")),
            cores=os.cpu_count() or 1,
            load_before=self.load_before,
            is_quick=is_quick,
            seconds=round(seconds, 1),
        )


def total_weight(steps: Iterable[Step]) -> float:
    """Return the sum of the steps' weights."""
    return sum(step.weight for step in steps)


def load() -> float:
    """Return the machine's load average over the last minute."""
    return round(os.getloadavg()[0], 2)


def processor(told: Path) -> str:
    """Return the processor's name as Linux tells it in ``/proc/cpuinfo``, else the platform's."""
    try:
        lines = told.read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()
