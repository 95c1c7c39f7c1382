"""How often each verdict falls and the right LoD is named, with the simulation's own error."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd

from analysis.decision.verdicts import DIFFERENT, EQUIVALENT, NOT_SHOWN
from analysis.power.assumed import best_lods
from analysis.power.concluding import Reason, ranks_of, reasons
from analysis.power.replicates import Scene, Studied
from analysis.shares import wilson

OUTCOMES: Final = {EQUIVALENT: "equivalent", DIFFERENT: "different", NOT_SHOWN: "not_shown"}
RIGHT, TOO_CHEAP, TOO_DEAR = "right", "too_cheap", "too_dear"


@dataclass(frozen=True)
class Outcome:
    """The tables of a simulation.

    ``verdicts`` has a row for each distance, LoD and number of people: what is assumed, the right
    verdict and the share of studies in which each verdict falls; shares are empty where nothing can
    be concluded, and ``cannot_conclude`` says why. ``cheapest`` has a row for each distance and
    number of people: how often the LoD that is named as the cheapest that is enough is the right
    one, a cheaper one or a dearer one. Bounds (``_low``, ``_high``) are Wilson's at 95 %: what the
    number of replicates leaves open.
    """

    verdicts: pd.DataFrame
    cheapest: pd.DataFrame
    replicates: int


def outcome_of(
    scene: Scene, studies: Sequence[Studied], *, distances: Sequence[str], lods: Sequence[str]
) -> Outcome:
    """Count what the studies came to, over every distance and LoD that the study is about."""
    fallen = Counter(verdict for study in studies for verdict in study.verdicts)
    named = Counter(choice for study in studies for choice in study.chosen)
    why = reasons(scene, distances=distances, lods=lods)
    verdicts = [
        row
        for (distance, lod), reason in why.items()
        for row in _verdict_rows(scene, fallen, distance, lod, reason=reason, total=len(studies))
    ]
    cheapest = [
        row
        for distance in distances
        for row in _cheapest_rows(scene, named, distance, total=len(studies))
    ]
    return Outcome(pd.DataFrame(verdicts), pd.DataFrame(cheapest), len(studies))


def _verdict_rows(
    scene: Scene,
    fallen: Counter[tuple[int, str, str, str]],
    distance: str,
    lod: str,
    *,
    reason: Reason,
    total: int,
) -> Iterator[dict[str, object]]:
    best = best_lods(scene.plans[0].stimuli, scene.margins).get(distance, "")
    truth = scene.truth
    is_shown = (distance, lod) in truth.realism and lod != best
    is_paired = (distance, lod, best) in truth.sensitivity
    about: dict[str, object] = {
        "distance": distance,
        "lod": lod,
        "best": best,
        "true_loss": truth.loss(distance, lod, best=best) if is_shown else np.nan,
        "true_noticed": truth.excess(distance, lod, best=best) if is_paired else np.nan,
        "right_verdict": (
            truth.verdict(distance, lod, best=best, margins=scene.margins) if is_paired else ""
        ),
    }
    for people in scene.people:
        row = {**about, "participants": people, "replicates": total}
        for outcome, name in OUTCOMES.items():
            count = fallen[people, distance, lod, outcome]
            cannot = reason.is_whole or (outcome == EQUIVALENT and bool(reason.text))
            row |= _share(name, count, 0 if cannot else total)
        yield row | {"cannot_conclude": reason.text}


def _cheapest_rows(
    scene: Scene, named: Counter[tuple[int, str, str]], distance: str, *, total: int
) -> Iterator[dict[str, object]]:
    right = right_lod(scene, distance)
    order = sequence_of(scene, distance)
    for people in scene.people:
        counts: Counter[str] = Counter()
        for lod in order if right else ():
            kind = np.sign(order.index(lod) - order.index(right))
            counts[(RIGHT, TOO_CHEAP, TOO_DEAR)[int(kind)]] += named[people, distance, lod]
        row: dict[str, object] = {"distance": distance, "participants": people}
        row |= {"replicates": total, "right_lod": right}
        for kind_name in (RIGHT, TOO_CHEAP, TOO_DEAR):
            row |= _share(kind_name, counts[kind_name], total if right else 0)
        yield row


def right_lod(scene: Scene, distance: str) -> str:
    """Return the LoD that ought to be named: the last before the first that is not enough.

    Empty where no decision can be made at the distance.
    """
    order = sequence_of(scene, distance)
    if len(order) < 2:
        return ""
    best, *lower = order
    for i, lod in enumerate(lower):
        if (distance, lod, best) not in scene.truth.sensitivity:
            return order[i]  # never beside the best: nothing can be shown for it
        if scene.truth.verdict(distance, lod, best=best, margins=scene.margins) != EQUIVALENT:
            return order[i]
    return lower[-1]


def sequence_of(scene: Scene, distance: str) -> list[str]:
    """Return the LoDs shown at a distance in the order of testing, the best first."""
    ranks = ranks_of(scene)
    own = {
        lod for where, lod in scene.truth.realism if where == distance and ranks.get(lod, -1) >= 0
    }
    return sorted(own, key=lambda lod: -ranks[lod])


def _share(name: str, count: int, total: int) -> dict[str, object]:
    low, high = wilson(count, total)
    share = count / total if total else np.nan
    return {name: share, f"{name}_low": low, f"{name}_high": high}
