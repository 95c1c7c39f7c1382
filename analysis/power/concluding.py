"""What a design cannot conclude, whoever takes part: cells nobody sees, pairs never shown.

A probability of 0 would read as if more people could help; these need another design.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from analysis.power.assumed import Cell, best_lods
from analysis.power.replicates import Scene
from analysis.table import STANDARD_LODS


@dataclass(frozen=True)
class Reason:
    """Why nothing can be concluded (``is_whole``), or no equivalence; empty text where all can."""

    text: str = ""
    is_whole: bool = False


def reasons(scene: Scene, *, distances: Sequence[str], lods: Sequence[str]) -> dict[Cell, Reason]:
    """Return for every distance and LoD but the best one there what stands in the way."""
    best = best_lods(scene.plans[0].stimuli, scene.margins)
    return {
        (distance, lod): _reason(scene, distance, lod, best=best.get(distance))
        for distance in distances
        for lod in lods
        if lod != best.get(distance)
    }


def _reason(scene: Scene, distance: str, lod: str, *, best: str | None) -> Reason:
    if best is None:
        return Reason(f"nobody sees anything at {distance}", is_whole=True)
    if (distance, lod) not in scene.truth.realism:
        return Reason(f"nobody sees {lod} at {distance}", is_whole=True)
    if ranks_of(scene).get(lod, -1.0) < 0:
        return Reason(
            f"{lod} has no place in the order of testing; name one in [decision] sequence",
            is_whole=True,
        )
    if not any(clip.left_lod == clip.right_lod for clip in scene.plans[0].stimuli):
        return Reason("no equal pairs are shown, so false alarms are unknown")
    if (distance, lod, best) not in scene.truth.sensitivity:
        return Reason(f"{lod} never stands beside {best} at {distance}")
    return Reason()


def ranks_of(scene: Scene) -> Mapping[str, float]:
    """Return what orders the LoDs, the best highest, as the verdicts take it."""
    standard = {lod: float(rank) for rank, lod in enumerate(STANDARD_LODS, start=1)}
    return scene.margins.order(standard)
