"""How often each verdict falls and the right LoD is named, with the simulation's own error."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd

from analysis.decision.verdicts import DIFFERENT, EQUIVALENT, NOT_SHOWN
from analysis.descriptive.shares import wilson
from analysis.power.assumed import Cell, best_lods
from analysis.power.concluding import Reason, reasons, sequence_of
from analysis.power.replicates import Scene, Studied

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
    number of replicates leaves open. ``ranked`` are the LoDs that are tested in sequence.
    """

    verdicts: pd.DataFrame
    cheapest: pd.DataFrame
    replicates: int
    ranked: frozenset[str]


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
        for row in _cheapest_rows(scene, named, distance, why=why, total=len(studies))
    ]
    ranked = frozenset(lod for distance in distances for lod in sequence_of(scene, distance))
    return Outcome(pd.DataFrame(verdicts), pd.DataFrame(cheapest), len(studies), ranked)


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
    is_shown = (distance, lod) in truth.realism
    is_paired = (distance, lod, best) in truth.sensitivity
    about: dict[str, object] = {
        "distance": distance,
        "lod": lod,
        "best": best,
        "true_loss": truth.loss(distance, lod, best=best) if is_shown else np.nan,
        "true_noticed": truth.excess(distance, lod, best=best) if is_paired else np.nan,
        "right_verdict": (
            truth.verdict(distance, lod, best=best, margins=scene.margins) if is_shown else ""
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
    scene: Scene,
    named: Counter[tuple[int, str, str]],
    distance: str,
    *,
    why: Mapping[Cell, Reason],
    total: int,
) -> Iterator[dict[str, object]]:
    order = sequence_of(scene, distance)
    right, reason = right_lod(scene, distance, why)
    for people in scene.people:
        counts: Counter[str] = Counter()
        for place, lod in enumerate(order):
            kind = np.sign(place - order.index(right)) if right else 0
            counts[(RIGHT, TOO_CHEAP, TOO_DEAR)[int(kind)]] += named[people, distance, lod]
        row: dict[str, object] = {"distance": distance, "participants": people}
        row |= {"replicates": total, "best": order[0] if len(order) > 1 else "", "right_lod": right}
        for name in (RIGHT, TOO_CHEAP, TOO_DEAR):
            row |= _share(name, counts[name], 0 if reason else total)
        yield row | {"cannot_conclude": reason}


def right_lod(scene: Scene, distance: str, why: Mapping[Cell, Reason]) -> tuple[str, str]:
    """Return the LoD that ought to be named, and what of the design stands in the way of it.

    It is the last one before the first that is not enough; empty where there are no two LoDs.
    """
    order = sequence_of(scene, distance)
    if len(order) < 2:
        return "", "fewer than two LoDs with a place in the order of testing are shown"
    best, *lower = order
    right, reason = best, ""
    for lod in lower:
        verdict = scene.truth.verdict(distance, lod, best=best, margins=scene.margins)
        own = why[distance, lod].text
        if verdict == DIFFERENT or (verdict != EQUIVALENT and not own):
            break
        right, reason = (lod, reason or own)
    return ("" if reason else right), reason


def _share(name: str, count: int, total: int) -> dict[str, object]:
    low, high = wilson(count, total)
    share = count / total if total else np.nan
    return {name: share, f"{name}_low": low, f"{name}_high": high}
