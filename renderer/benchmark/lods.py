"""Frames of each LoD at each distance, with two eyes and with one: Table 5.1's last row.

One eye is the viewer's left, alone: at macroscopic one view of the whole picture, as the thesis
showed it ("one eye at very close range"), with the same iris in pixels as the two half frames have;
elsewhere the same view without the other eye.
"""

from __future__ import annotations

from functools import partial
from typing import Final

from renderer.benchmark.clock import WARM_UP
from renderer.benchmark.result import Bench
from renderer.benchmark.stand import BOTH, ONE, Stand, Step
from renderer.clip_values import DISTANCES
from renderer.detail import STANDARD_LODS, Detail

PART: Final = "lods"
WEIGHT: Final = 3.8  # of a round with two eyes; the set-up takes as long as eight rounds


def lod_steps(rounds: int, *, is_quick: bool) -> list[Step]:
    """Return a step per distance and number of eyes; in a hurry only at macroscopic."""
    return [
        Step(
            PART,
            f"{distance}, {'two eyes' if eyes == BOTH else 'one eye'}",
            len(eyes) * WEIGHT * (rounds + WARM_UP + 8) / 2,
            partial(_measure, distance=distance, eyes=eyes),
        )
        for distance in DISTANCES[: 1 if is_quick else None]
        for eyes in (BOTH, ONE)
    ]


def _measure(stand: Stand, bench: Bench, *, distance: str, eyes: tuple[int, ...]) -> None:
    specs = [stand.spec(Detail.uniform(lod), distance, eyes=eyes) for lod in STANDARD_LODS]
    shots = stand.time([stand.frames(spec, eyes=eyes) for spec in specs], are_whole=True)
    bench.rows.extend(
        stand.frame_row(PART, spec, own, lod=lod, eyes=len(eyes))
        for lod, spec, own in zip(STANDARD_LODS, specs, shots, strict=True)
    )
