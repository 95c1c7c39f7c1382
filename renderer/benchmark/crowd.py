"""A frame with more and more people in it: the thesis's 30 characters, 60 eyes.

The main character's eyes are ultra and mirror everybody; the camera stands where most of the crowd
is in the picture.
"""

from __future__ import annotations

from typing import Final

from renderer.benchmark.clock import spread_of
from renderer.benchmark.result import Bench
from renderer.benchmark.stand import BOTH, Stand, Step
from renderer.clip import CROWDS
from renderer.detail import Detail

PART: Final = "crowd"
DISTANCE: Final = "far"
LOD: Final = "ultra"


def crowd_steps(rounds: int) -> list[Step]:
    """Return the one step, whose frames must be taken in turn."""
    return [Step(PART, "crowds of " + ", ".join(map(str, CROWDS)), 6.0 * (rounds + 2) + 60, _crowd)]


def _crowd(stand: Stand, bench: Bench) -> None:
    detail = Detail.uniform(LOD)
    specs = [stand.spec(detail, DISTANCE, eyes=BOTH, crowd=crowd) for crowd in CROWDS]
    times = stand.time([stand.frames(spec, eyes=BOTH) for spec in specs])
    bench.rows.extend(
        stand.row(PART, spec, spread_of(ms), lod=LOD, eyes=len(BOTH), crowd=spec.crowd)
        for spec, ms in zip(specs, times, strict=True)
    )
