"""The law of sizes: a difference shows as A Phi((x - m) / w), x the log2 of the iris's size.

Every LoD has its own greatest difference A, size m at which half of it shows, and octaves w over
which it comes; where a handful of sizes says little of them, the priors do: w is about one octave
for what is noticed, and about two, but less certain, for what looks less real. What a person
answers given that difference is an ordinal model, with the person's own criterion.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import ndtr

from analysis.curves.sizes import Measure
from analysis.models.combined import Renamed, Together
from analysis.models.counts import Counts, count_answers
from analysis.models.draws import draw
from analysis.models.fitting import OrdinalFit, fit
from analysis.models.ordinal import OrdinalModel
from analysis.models.predictors import Predictor, Saturating
from analysis.models.priors import PRIORS

Floats = NDArray[np.float64]
SLOW: Final = (float(np.log(2.0)), 0.8)  # prior of log w where realism is lost with size
_HEIGHT: Final = 50.0  # greater differences than any answer could tell


@dataclass(frozen=True)
class SizeLaw:
    """The fitted law of several LoDs against the best.

    ``sizes`` are the log2 sizes at which each LoD was shown.
    """

    measure: Measure
    best: str
    sizes: Mapping[str, Floats]
    fit: OrdinalFit
    draws: Floats
    people: int

    @property
    def lods(self) -> tuple[str, ...]:
        """The LoDs that have a curve."""
        return tuple(self.sizes)

    def difference(self, lod: str, x: Floats) -> tuple[Floats, Floats]:
        """Return A Phi((x - m) / w) at log2 sizes (n_x,), and draws of it (n_draws, n_x)."""
        return self._difference(self.fit.parameters[None], lod, x)[0], self._difference(
            self.draws, lod, x
        )

    def _difference(self, parameters: Floats, lod: str, x: Floats) -> Floats:
        height, middle, width = (parameters[:, self.at(name)] for name in own_names(lod))
        z = (x - middle[:, None]) / np.exp(width)[:, None]
        return np.asarray(np.minimum(np.exp(height), _HEIGHT)[:, None] * ndtr(z))

    def at(self, name: str) -> int:
        """Return where a parameter stands; raises ValueError."""
        return self.fit.model.names.index(name)

    def both(self) -> tuple[Floats, Floats]:
        """Return the best parameters as one row, and the draws."""
        return self.fit.parameters[None], self.draws

    def answer_criteria(self, parameters: Floats) -> tuple[Floats, Floats]:
        """Return the thresholds (n, n_categories - 1) and the noise of a drawn person (n,)."""
        model = self.fit.model
        return model.thresholds(parameters), np.hypot(1.0, model.spreads(parameters)[:, 0])


def own_names(lod: str) -> tuple[str, str, str]:
    """Return the names of a LoD's own parameters."""
    return f"log_height:{lod}", f"middle:{lod}", f"log_width:{lod}"


def sizes_by_lod(lods: pd.Series, sizes: pd.Series, *, best: str) -> dict[str, Floats]:
    """Return the log2 sizes at which each LoD was shown, of those shown at two or more."""
    found = {
        str(lod): np.unique(own.to_numpy(dtype=float))
        for lod, own in sizes.groupby(lods, sort=True)
        if lod != best
    }
    return {lod: own for lod, own in found.items() if len(own) > 1}


def count_rows(rows: pd.DataFrame, keys: list[str], answer: pd.Series, categories: int) -> Counted:
    """Count answers (from 0) by person and by stimulus: a combination of ``keys``."""
    place = rows.groupby(keys, sort=True, observed=True).ngroup().to_numpy()
    table = rows.assign(stimulus=place).drop_duplicates("stimulus").sort_values("stimulus")
    who, people = pd.factorize(rows["participant"])
    counts = count_answers(
        who, place, answer.astype(int), shape=(len(people), len(table), categories)
    )
    return Counted(table[keys].reset_index(drop=True), counts, tuple(str(p) for p in people))


def law_predictor(table: pd.DataFrame, lod: str, lods: tuple[str, ...]) -> Predictor:
    """Return the law's predictor: sizes from ``size``, LoDs from the column ``lod``."""
    sizes, shown = table["size"].to_numpy(dtype=float), table[lod].to_numpy(dtype=object)

    def of(name: str) -> Predictor:
        group = np.where(shown == name, 0, -1).astype(np.intp)
        return Renamed(Saturating(sizes, group, (name,)), own_names(name))

    return reduce(Together, map(of, lods))


@dataclass(frozen=True)
class Counted:
    """Counts of answers, the stimuli they were given to, and by whom."""

    table: pd.DataFrame
    counts: Counts
    people: tuple[str, ...]


def fit_law(
    model: OrdinalModel,
    counted: Counted,
    measure: Measure,
    rng: np.random.Generator,
    *,
    best: str,
    sizes: Mapping[str, Floats],
    weights: Mapping[str, float] | None,
    log_width: tuple[float, float] = PRIORS["log_width"],
) -> SizeLaw:
    """Fit the law; ``weights`` let a participant count for less than one.

    ``log_width`` is the prior of log w: mean and standard deviation.
    """
    given = weights or {}
    often = np.array([given.get(who, 1.0) for who in counted.people])
    found = fit(
        model,
        counted.counts,
        priors={**PRIORS, "middle": measure.middle, "log_width": log_width},
        weights=often if weights else None,
        start=_start(model, counted.counts, measure),
    )
    draws = draw(found, rng, people=counted.counts.people)
    return SizeLaw(measure, best, sizes, found, draws, counted.counts.people)


def _start(model: OrdinalModel, counts: Counts, measure: Measure) -> Floats:
    share = counts.table.sum(axis=(0, 1)) + 0.5
    cut = model.link.quantile(np.cumsum(share)[:-1] / share.sum())
    own = {"log_height": PRIORS["log_height"][0], "middle": measure.middle[0]}
    spreads = {kind: PRIORS[kind][0] for kind in model.kinds if kind.startswith("log_sd")}
    start = np.array([{**own, **spreads}.get(kind, 0.0) for kind in model.kinds])
    start[0] = cut[0]
    start[1 : model.categories - 1] = np.log(np.maximum(np.diff(cut), 1e-3))
    return start
