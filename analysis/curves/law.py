"""The law of sizes: each LoD's difference from the best grows with the iris's size, in some shape.

What a person answers given that difference is an ordinal model, with the person's own criterion.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from types import MappingProxyType
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.curves.shapes import Shape, Shaped
from analysis.curves.sizes import Measure
from analysis.models.combined import Together
from analysis.models.counts import Counts, count_answers
from analysis.models.draws import draw
from analysis.models.fitting import OrdinalFit, fit
from analysis.models.ordinal import OrdinalModel
from analysis.models.predictors import Predictor
from analysis.models.priors import PRIORS, Priors

Floats = NDArray[np.float64]
LogSizes = Mapping[str, Floats]  # of each LoD, those at which it was shown
_FREE: Final = ("threshold", "log_step", "location", "contrast", "scale")  # start at 0


@dataclass(frozen=True)
class SizeLaw:
    """The fitted law of several LoDs against the best.

    ``sizes`` are the log2 sizes at which each LoD was shown, ``shapes`` how its difference grows.
    """

    measure: Measure
    best: str
    sizes: LogSizes
    shapes: Mapping[str, Shape]
    fit: OrdinalFit
    draws: Floats
    people: int

    @property
    def lods(self) -> tuple[str, ...]:
        """The LoDs that have a curve."""
        return tuple(self.sizes)

    def difference(self, lod: str, x: Floats) -> tuple[Floats, Floats]:
        """Return the difference at log2 sizes (n_x,), and draws of it (n_draws, n_x)."""
        shape = self.shapes[lod]
        places = [self.at(name) for name in shape.named(lod)]
        value = shape.difference(self.fit.parameters[None, places], x)
        return value[0], shape.difference(self.draws[:, places], x)

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


def sizes_by_lod(lods: pd.Series, sizes: pd.Series, *, best: str) -> LogSizes:
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


def law_predictor(table: pd.DataFrame, lod: str, shapes: Mapping[str, Shape]) -> Predictor:
    """Return the law's predictor: sizes from ``size``, LoDs from the column ``lod``."""
    sizes, shown = table["size"].to_numpy(dtype=float), table[lod].to_numpy(dtype=object)
    parts: list[Predictor] = [
        Shaped(shape, sizes, shown == name, name) for name, shape in shapes.items()
    ]
    return reduce(Together, parts)


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
    shapes: Mapping[str, Shape],
    weights: Mapping[str, float] | None,
    shape_priors: Priors = MappingProxyType({}),
) -> SizeLaw:
    """Fit the law; ``weights`` let a participant count for less than one.

    ``shape_priors`` go before those that all models share.
    """
    given = weights or {}
    often = np.array([given.get(who, 1.0) for who in counted.people])
    priors = {**PRIORS, "middle": measure.middle, **shape_priors}
    found = fit(
        model,
        counted.counts,
        priors=priors,
        weights=often if weights else None,
        start=_start(model, counted.counts, priors),
    )
    draws = draw(found, rng, people=counted.counts.people)
    return SizeLaw(measure, best, sizes, shapes, found, draws, counted.counts.people)


def _start(model: OrdinalModel, counts: Counts, priors: Priors) -> Floats:
    """Return the priors' middles, and the cuts that the shares of all answers make."""
    share = counts.table.sum(axis=(0, 1)) + 0.5
    cut = model.link.quantile(np.cumsum(share)[:-1] / share.sum())
    start = np.array([0.0 if kind in _FREE else priors[kind][0] for kind in model.kinds])
    start[0] = cut[0]
    start[1 : model.categories - 1] = np.log(np.maximum(np.diff(cut), 1e-3))
    return start
