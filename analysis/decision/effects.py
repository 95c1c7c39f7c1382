"""May one effect be left out? A verdict for every LoD without a rank, at every distance.

A study that ablates effects shows the best LoD beside itself with one effect at a lower level. Such
LoDs have no order, so no sequence protects them: for each LoD the distances' p values are adjusted
after Holm, and the chance that any of its verdicts is wrong stays below the level. The tests are
those of the designer's answer: realism not lower by the margin, and not noticed beyond it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import pandas as pd

from analysis.costs.cost import Costs
from analysis.costs.savings import Saving, effect_saving, lod_saving
from analysis.decision.margins import Margins
from analysis.decision.verdicts import (
    DIFFERENT,
    EQUIVALENT,
    NOT_SHOWN,
    Test,
    against,
    excess_of,
)
from analysis.estimates.multiplicity import holm
from analysis.estimates.noticing import Noticing
from analysis.estimates.realism import Realism
from analysis.tables.columns import EFFECTS

Levels = Mapping[str, Mapping[str, str]]


@dataclass(frozen=True)
class Change:
    """An effect that a LoD lowers, and its levels in the best LoD and in this one."""

    effect: str
    kept: str
    left: str

    def __str__(self) -> str:
        """Write "without caustics", or "subsurface at low"."""
        if self.left == "off":
            return f"without {self.effect}"
        return f"{self.effect} at {self.left}"


@dataclass(frozen=True)
class EffectVerdict:
    """One LoD without a rank against the best at one distance.

    ``changes`` are what tells it from the best, empty where the levels are not known. ``noticed``
    is None where the data cannot tell. The p values are adjusted over the LoD's distances.
    """

    distance: str
    lod: str
    best: str
    changes: tuple[Change, ...]
    realism: Test
    noticed: Test | None
    p_equivalent: float
    p_different: float
    level: float

    @property
    def is_reached(self) -> bool:
        """Always: no sequence stops before a LoD without a rank."""
        return True

    @property
    def outcome(self) -> str:
        """One of the three verdicts."""
        if self.p_different <= self.level:
            return DIFFERENT
        return EQUIVALENT if self.p_equivalent <= self.level else NOT_SHOWN

    @property
    def name(self) -> str:
        """What the LoD is: "without caustics", or its name."""
        return " and ".join(map(str, self.changes)) or self.lod


def decide_effects(
    realism: Realism,
    noticing: Noticing | None,
    ranks: Mapping[str, float],
    *,
    levels: Levels,
    margins: Margins,
) -> list[EffectVerdict]:
    """Decide on every LoD without a rank at every distance where the best was rated too.

    ``levels`` are each LoD's level of every effect, as far as known.
    """
    ranks = margins.order(ranks)
    rating, draws = realism.expected()
    places = {cell: i for i, cell in enumerate(realism.cells)}
    made: dict[str, list[EffectVerdict]] = {}
    for (distance, lod), own in places.items():
        best = _best(realism, distance, ranks)
        if best is None or ranks.get(lod, -1.0) >= 0:
            continue
        top = places[distance, best]
        verdict = _verdict(
            (distance, lod, best),
            against(
                rating[top] - rating[own],
                draws[:, top] - draws[:, own],
                margins.realism_points,
                confidence=margins.confidence,
            ),
            noticing,
            levels=levels,
            margins=margins,
        )
        made.setdefault(lod, []).append(verdict)
    return [verdict for own in made.values() for verdict in decided(own)]


def _best(realism: Realism, distance: str, ranks: Mapping[str, float]) -> str | None:
    here = [lod for where, lod in realism.cells if where == distance and ranks.get(lod, -1.0) >= 0]
    return max(here, key=lambda lod: ranks[lod]) if here else None


def _verdict(
    place: tuple[str, str, str],
    realism: Test,
    noticing: Noticing | None,
    *,
    levels: Levels,
    margins: Margins,
) -> EffectVerdict:
    distance, lod, best = place
    seen = excess_of(noticing, place)
    noticed = seen and against(*seen, margins.noticed_share, confidence=margins.confidence)
    return EffectVerdict(
        distance=distance,
        lod=lod,
        best=best,
        changes=_changes(levels.get(lod, {}), levels.get(best, {})),
        realism=realism,
        noticed=noticed,
        p_equivalent=1.0,
        p_different=1.0,
        level=1.0 - margins.confidence,
    )


def decided(verdicts: Sequence[EffectVerdict]) -> list[EffectVerdict]:
    """Return one LoD's verdicts with the p values of their tests, adjusted over its distances."""
    equivalent, different = (
        holm(own) for own in zip(*(_p_values(own) for own in verdicts), strict=True)
    )
    return [
        replace(own, p_equivalent=float(enough), p_different=float(lesser))
        for own, enough, lesser in zip(verdicts, equivalent, different, strict=True)
    ]


def _p_values(own: EffectVerdict) -> tuple[float, float]:
    """Return one verdict's own p values, of equivalent (which takes both tests) and different."""
    tests = [test for test in (own.realism, own.noticed) if test]
    beyond = max(own.realism.p_beyond, own.noticed.p_beyond if own.noticed else 1.0)
    within = min(test.p_within for test in tests)
    return beyond, min(1.0, len(tests) * within)  # either of the two may show it


def _changes(own: Mapping[str, str], best: Mapping[str, str]) -> tuple[Change, ...]:
    return tuple(
        Change(effect, best[effect], own[effect])
        for effect in EFFECTS
        if effect in own and effect in best and own[effect] != best[effect]
    )


def levels_of(ratings: pd.DataFrame) -> dict[str, dict[str, str]]:
    """Return each LoD's level of every effect, as far as the table tells."""
    known = [effect for effect in EFFECTS if effect in ratings]
    rows = ratings.drop_duplicates("lod").set_index("lod")[known]
    return {
        str(lod): {str(effect): str(level) for effect, level in row.dropna().items()}
        for lod, row in rows.iterrows()
    }


def saving_of(verdict: EffectVerdict, costs: Costs | None) -> Saving | None:
    """Return what the LoD saves: as it was timed itself, or as its one effect was."""
    if costs is None:
        return None
    timed = lod_saving(costs, verdict.distance, verdict.lod, best=verdict.best)
    if timed or len(verdict.changes) != 1:
        return timed
    change = verdict.changes[0]
    return effect_saving(
        costs, change.effect, kept=change.kept, left=change.left, distance=verdict.distance
    )
