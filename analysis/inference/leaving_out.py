"""Does a verdict hang on one person? Every verdict without each person, whoever it is.

Few people are each left out and the models fitted anew; of many, one Newton step away from the
person's own gradient tells what they move. Intervals move with the estimate and keep their width.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.decision.verdicts import EQUIVALENT, Decision, Test, Verdict, excess_of
from analysis.diagnostics.left_out import is_refitted
from analysis.estimates.noticing import Noticing
from analysis.estimates.realism import Realism
from analysis.estimates.stimuli import Cell
from analysis.models.counts import Counts
from analysis.models.fitting import OrdinalFit, Problem
from analysis.models.optimum import climb
from analysis.models.scores import person_scores

Floats = NDArray[np.float64]
FEWEST: Final = 3  # people of whom one can be left out
MOST: Final = 400  # beyond, no single person moves a verdict worth the wait
_BLOCK: Final = 50
_NEAR: Final = 0.03  # standard errors from each optimum: far less than leaving out moves it
COLUMNS: Final = ("people", "distance", "lod", "verdict", "usual", "is_moved")


def verdicts_without_each(
    decisions: Sequence[Decision],
    realism: Realism | None,
    noticing: Noticing | None,
    *,
    comparisons: pd.DataFrame,
) -> pd.DataFrame:
    """Return every verdict without each person; columns are COLUMNS, ``people`` who is left out.

    ``comparisons`` are those that ``noticing`` was fitted to. Empty for fewer than 3 or more than
    400 people.
    """
    each = without_each(realism, noticing, comparisons=comparisons) if decisions else None
    if realism is None or each is None:
        return pd.DataFrame(columns=list(COLUMNS))
    rows: list[tuple[object, ...]] = []
    for decision in decisions:
        pairs = {v.lod: each.excess(v.distance, v.lod, v.best) for v in decision.verdicts}
        gaps = {v.lod: each.loss(v.distance, v.lod, v.best) for v in decision.verdicts}
        for person, who in enumerate(each.people):
            is_reached = True
            for verdict in decision.verdicts:
                found = _without(
                    verdict, float(gaps[verdict.lod][person]), pairs[verdict.lod], person
                )
                found = replace(found, is_reached=is_reached)
                is_reached = is_reached and found.outcome == EQUIVALENT
                rows.append((who, decision.distance, verdict.lod, found.outcome, verdict.outcome,
                             found.outcome != verdict.outcome))  # fmt: skip
    return pd.DataFrame(rows, columns=list(COLUMNS))


@dataclass(frozen=True)
class WithoutEach:
    """Estimates without each person; ``ratings`` (n_people, n_cells) are the mean ratings.

    ``noticing`` is the fit whose draws are the estimates without each person, one after another.
    """

    people: tuple[str, ...]
    cells: tuple[Cell, ...]
    ratings: Floats
    noticing: Noticing | None

    def loss(self, distance: str, lod: str, best: str) -> Floats:
        """Return how much lower than the best a LoD is rated, without each person (n_people,)."""
        top, own = (self.cells.index((distance, name)) for name in (best, lod))
        loss: Floats = self.ratings[:, top] - self.ratings[:, own]
        return loss

    def excess(self, distance: str, lod: str, best: str) -> Floats | None:
        """Return the excess of yes over false alarms (n_people,), where the pair was shown."""
        found = excess_of(self.noticing, (distance, lod, best))
        return None if found is None else found[1]


def without_each(
    realism: Realism | None, noticing: Noticing | None, *, comparisons: pd.DataFrame
) -> WithoutEach | None:
    """Return what ratings and noticing say without each person, whoever it is.

    None without a model, and for fewer than 3 or more than 400 people.
    """
    if realism is None:
        return None
    raters = realism.stimuli.people
    noticers = _noticers(comparisons) if noticing is not None else ()
    everyone = tuple(dict.fromkeys([*raters, *noticers]))
    if not FEWEST <= len(everyone) <= MOST:
        return None
    ratings = replace(realism, draws=_moved(realism.fit, raters, everyone)).expected()[1]
    seen = noticing and replace(noticing, draws=_moved(noticing.fit, noticers, everyone))
    return WithoutEach(everyone, realism.cells, ratings, seen)


def _without(
    verdict: Verdict,
    gap: float,
    excess: Floats | None,
    person: int,
) -> Verdict:
    noticed = verdict.noticed
    if noticed is not None and excess is not None:
        noticed = _around(noticed, float(excess[person]))
    return replace(verdict, realism=_around(verdict.realism, gap), noticed=noticed)


def _around(test: Test, value: float) -> Test:
    """Return a test with its interval moved to another estimate."""
    low, high = (value + end - test.value for end in (test.low, test.high))
    return replace(test, value=value, low=low, high=high)


def _moved(fit: OrdinalFit, own: Sequence[str], everyone: Sequence[str]) -> Floats:
    """Return the parameters without each of ``everyone`` (n, n_parameters)."""
    often = np.ones(len(own)) if fit.weights is None else fit.weights
    moved = _refitted(fit, often) if is_refitted(fit) else _stepped(fit, often)
    place = {who: i for i, who in enumerate(own)}
    return np.array([moved[place[who]] if who in place else fit.parameters for who in everyone])


def _refitted(fit: OrdinalFit, often: Floats) -> Floats:
    found = []
    for person in range(fit.counts.people):
        others = often.copy()
        others[person] = 0.0
        target = Problem(fit.model, fit.counts, fit.priors, others).target(fit.grid)
        found.append(climb(target, fit.parameters, inverse=fit.covariance, near=_NEAR)[0])
    return np.array(found)


def _stepped(fit: OrdinalFit, often: Floats) -> Floats:
    """Take one Newton step; the rest's curvature is the whole's but for one person's share."""
    parts = [
        person_scores(fit.model, fit.parameters, Counts(fit.counts.table[i : i + _BLOCK]), fit.grid)
        for i in range(0, fit.counts.people, _BLOCK)
    ]
    scores = often[:, None] * np.concatenate([part[0] for part in parts])
    share = len(often) / max(len(often) - 1, 1)
    return np.asarray(fit.parameters - share * (scores @ fit.covariance))


def _noticers(comparisons: pd.DataFrame) -> tuple[str, ...]:
    rows = comparisons[comparisons["noticed"].notna() & ~comparisons["is_practice"]]
    return tuple(str(who) for who in rows["participant"].drop_duplicates())
