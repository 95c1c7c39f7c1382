"""What a design cannot conclude, whoever takes part: cells nobody sees, pairs never shown.

A probability of 0 would read as if more people could help; these need another design.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from analysis.power.assumed import Cell, best_lods, order_of
from analysis.power.replicates import Scene


@dataclass(frozen=True)
class Reason:
    """Why nothing can be concluded (``is_whole``), or no equivalence; empty text where all can."""

    text: str = ""
    is_whole: bool = False


def reasons(scene: Scene, *, distances: Sequence[str], lods: Sequence[str]) -> dict[Cell, Reason]:
    """Return for every distance and LoD but the best one there what stands in the way."""
    best = best_lods(scene.plans[0].stimuli, scene.margins)
    found = {
        (distance, lod): _reason(scene, distance, lod, best=best.get(distance))
        for distance in distances
        for lod in lods
        if lod != best.get(distance)
    }
    for distance in distances:
        _hold_up(found, distance, sequence_of(scene, distance)[1:])
    return found


def _hold_up(found: dict[Cell, Reason], distance: str, sequence: Sequence[str]) -> None:
    """No LoD is reached after one that cannot be shown to be enough."""
    held_up = ""
    for lod in sequence:
        own = found.get((distance, lod), Reason())
        if held_up and not own.text:
            found[distance, lod] = Reason(f"{held_up}, which is tested before it, cannot be shown")
        held_up = held_up or (lod if own.text else "")


def _reason(scene: Scene, distance: str, lod: str, *, best: str | None) -> Reason:
    if best is None:
        return Reason(f"nobody sees anything at {distance}", is_whole=True)
    if (distance, lod) not in scene.truth.realism:
        return Reason(f"nobody sees {lod} at {distance}", is_whole=True)
    if order_of(scene.margins).get(best, -1.0) < 0:
        return Reason(f"no LoD at {distance} has a place in the order of testing", is_whole=True)
    if not any(clip.left_lod == clip.right_lod for clip in scene.plans[0].stimuli):
        return Reason("no equal pairs are shown, so false alarms are unknown")
    if (distance, lod, best) not in scene.truth.sensitivity:
        return Reason(f"{lod} never stands beside {best} at {distance}")
    return Reason()


def sequence_of(scene: Scene, distance: str) -> list[str]:
    """Return the ranked LoDs shown at a distance in the order of testing, the best first."""
    order = order_of(scene.margins)
    shown = {lod for where, lod in scene.truth.realism if where == distance}
    return sorted((lod for lod in shown if order.get(lod, -1.0) >= 0), key=lambda lod: -order[lod])
