"""A frame with more and more people in it: the thesis's 30 characters, 60 eyes.

The main character's eyes are ultra and mirror everybody; the camera stands where most of the crowd
is in the picture.
"""

from __future__ import annotations

from functools import partial
from typing import Final

from renderer.benchmark.clock import WARM_UP, spread_of
from renderer.benchmark.result import Bench
from renderer.benchmark.stand import BOTH, Stand, Step
from renderer.clip import CROWDS
from renderer.detail import Detail

PART: Final = "crowd"
DISTANCE: Final = "far"
LOD: Final = "ultra"


def crowd_steps(rounds: int, *, is_quick: bool) -> list[Step]:
    """Return the one step, whose frames must be taken in turn; in a hurry of the least and most."""
    crowds = (CROWDS[0], CROWDS[-1]) if is_quick else CROWDS
    title = ", ".join(map(str, crowds)) + " people"
    weight = len(crowds) * (1.5 * (rounds + WARM_UP) + 25)
    return [Step(PART, title, weight, partial(_measure, crowds=crowds))]


def _measure(stand: Stand, bench: Bench, *, crowds: tuple[int, ...]) -> None:
    detail = Detail.uniform(LOD)
    specs = [stand.spec(detail, DISTANCE, eyes=BOTH, crowd=crowd) for crowd in crowds]
    times = stand.time([stand.frames(spec, eyes=BOTH) for spec in specs])
    bench.rows.extend(
        stand.row(PART, spec, spread_of(ms), lod=LOD, eyes=len(BOTH), crowd=spec.crowd)
        for spec, ms in zip(specs, times, strict=True)
    )
