"""Who notices that two eyes differ: yes, not sure and no as grades of one detection.

    P(at most k) = Phi((c_k - d - u_i)),   d = 0 for pairs of equal LoDs

so d is the sensitivity d' of signal detection, and "not sure" is evidence instead of a missing
answer. Without pairs of equal LoDs a yes may be a guess: then there are shares, and no d'.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import ndtr

from analysis.models.counts import count_answers
from analysis.models.draws import draw
from analysis.models.fitting import OrdinalFit, fit
from analysis.models.ordinal import LENIENCY, OrdinalModel
from analysis.models.predictors import Linear
from analysis.models.priors import PRIORS
from analysis.tables.columns import NOTICED
from analysis.tables.ordering import distance_order, lod_ranks

Floats = NDArray[np.float64]
Pair = tuple[str, str, str]


@dataclass(frozen=True)
class Noticing:
    """The fitted detection model; ``pairs`` are (distance, lesser LoD, greater LoD), unequal ones.

    ``catch_answers`` is how many answers pairs of equal LoDs were given.
    """

    fit: OrdinalFit
    draws: Floats
    pairs: tuple[Pair, ...]
    catch_answers: int

    def sensitivity(self) -> tuple[Floats, Floats]:
        """Return d' of every pair (n_pairs,) and draws of it (n_draws, n_pairs)."""
        at = self.fit.model.slices["location"]
        return self.fit.parameters[at], self.draws[:, at]

    def shares(self) -> tuple[Floats, Floats]:
        """Return the population's share of yes for every pair, and draws of it."""
        return self._yes(self.fit.parameters[None])[0][1:], self._yes(self.draws)[:, 1:]

    def false_alarms(self) -> tuple[float, Floats]:
        """Return the share of yes for equal LoDs, and draws of it (n_draws,)."""
        return float(self._yes(self.fit.parameters[None])[0, 0]), self._yes(self.draws)[:, 0]

    def _yes(self, parameters: Floats) -> Floats:
        """Return P(yes) of equal LoDs, then of every pair."""
        model = self.fit.model
        criterion = model.thresholds(parameters)[:, -1]
        width = np.sqrt(1 + model.spreads(parameters)[:, 0] ** 2)
        d = np.column_stack([np.zeros(len(parameters)), parameters[:, model.slices["location"]]])
        return np.asarray(ndtr((d - criterion[:, None]) / width[:, None]))

    def table(self) -> pd.DataFrame:
        """Return d', the share of yes and its excess over false alarms, with 95 % intervals."""
        (d, d_draws), (yes, yes_draws) = self.sensitivity(), self.shares()
        alarm, alarm_draws = self.false_alarms()
        excess = yes_draws - alarm_draws[:, None]
        rows = []
        for i, (distance, lesser, greater) in enumerate(self.pairs):
            row = {"distance": distance, "lesser": lesser, "greater": greater}
            for name, value, draws in (
                ("d_prime", d[i], d_draws[:, i]),
                ("yes", yes[i], yes_draws[:, i]),
                ("excess", yes[i] - alarm, excess[:, i]),
            ):
                low, high = np.quantile(draws, (0.025, 0.975))
                row |= {name: value, f"{name}_low": low, f"{name}_high": high}
            rows.append(row)
        return pd.DataFrame(rows)


def noticing_of(
    comparisons: pd.DataFrame,
    ratings: pd.DataFrame,
    rng: np.random.Generator,
    *,
    weights: dict[str, float] | None = None,
    near: Noticing | None = None,
) -> Noticing | None:
    """Fit the model to the answers that count; None without answers to pairs of equal LoDs.

    ``weights`` let a participant count for less than one; ``near`` is a fit to nearly the same
    answers, from which this one is found sooner.
    """
    rows = comparisons[comparisons["noticed"].notna() & ~comparisons["is_practice"]]
    is_catch = (rows["left_lod"] == rows["right_lod"]).to_numpy()
    if not is_catch.any() or is_catch.all():
        return None
    ranks = lod_ranks(ratings)

    def by_rank(lod: str) -> tuple[float, str]:
        return ranks.get(lod, -1.0), lod

    named = [
        None if left == right else (distance, *sorted((left, right), key=by_rank))
        for distance, left, right in zip(
            rows["distance"], rows["left_lod"], rows["right_lod"], strict=True
        )
    ]
    order = {name: i for i, name in enumerate(distance_order(pd.concat([ratings, rows])))}
    pairs: list[Pair] = sorted(
        {pair for pair in named if pair is not None},
        key=lambda pair: (order[pair[0]], by_rank(pair[1]), by_rank(pair[2])),
    )
    place = {pair: i + 1 for i, pair in enumerate(pairs)}
    own = [0 if pair is None else place[pair] for pair in named]
    who, people = pd.factorize(rows["participant"])
    grade = rows["noticed"].map({word: i for i, word in enumerate(reversed(NOTICED))})
    counts = count_answers(who, own, grade.astype(int), shape=(len(people), len(pairs) + 1, 3))
    design = np.vstack([np.zeros(len(pairs)), np.eye(len(pairs))])
    model = OrdinalModel(Linear(design, tuple(" ".join(pair) for pair in pairs)), 3, (LENIENCY,))
    often = np.array([(weights or {}).get(str(who), 1.0) for who in people])
    found = fit(
        model,
        counts,
        priors=PRIORS,
        weights=often if weights else None,
        near=near.fit if near else None,
    )
    draws = draw(found, rng, people=len(people))
    return Noticing(found, draws, tuple(pairs), int(is_catch.sum()))
