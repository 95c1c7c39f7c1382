"""How far below the best LoD a lesser one is rated, along the iris's size.

    eta = mu(x) - d(x) + kappa (own - beside) + side, direction, expertise

mu is the best LoD's realism, free in every octave; the rest is as in the estimates by distance. The
loss in points is the difference of the population's mean ratings at that size.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import ndtr

from analysis.curves.curve import MARGIN, RATED, SizeCurve
from analysis.curves.law import (
    Counted,
    SizeLaw,
    count_rows,
    fit_law,
    law_predictor,
    sizes_by_lod,
)
from analysis.curves.made import Level, make_curve
from analysis.curves.observed import loss_points
from analysis.curves.shapes import BENT_PRIORS, Shape, bent_over
from analysis.curves.sizes import Measure, along, with_size
from analysis.decision.margins import Margins
from analysis.descriptive.means import answered
from analysis.estimates.stimuli import with_nuisances
from analysis.models.combined import Beside, Scaled, Together
from analysis.models.ordinal import LENIENCY, OrdinalModel
from analysis.models.predictors import Linear, Predictor

Floats = NDArray[np.float64]
_OCTAVE: Final = "octave"


@dataclass(frozen=True)
class RatedLaw:
    """The fitted law, and the octaves (log2) at which the best LoD's realism is free.

    ``middles`` are the mean log2 size shown in each octave, which its realism belongs to.
    """

    law: SizeLaw
    octaves: tuple[float, ...]
    middles: tuple[float, ...]


def rated_law(
    rows: pd.DataFrame,
    measure: Measure,
    rng: np.random.Generator,
    *,
    best: str,
    scale: tuple[int, int],
    experts: Mapping[str, bool],
    weights: Mapping[str, float] | None = None,
) -> RatedLaw | None:
    """Fit the law to rated rows with a size; None where no LoD was rated at two sizes."""
    sizes = sizes_by_lod(rows["lod"], rows["size"], best=best)
    if not sizes or not (rows["lod"] == best).any():
        return None
    kept = rows[(rows["lod"] == best) | rows["lod"].isin(sizes)]
    is_known = kept["other_lod"].isin([best, *sizes])
    kept = kept.assign(other_lod=kept["other_lod"].where(is_known, kept["lod"]))
    kept = kept.assign(octave=np.round(kept["size"]) + 0.0)  # never minus nought
    coded, nuisances = with_nuisances(kept, experts)
    low, high = scale
    keys = ["lod", "other_lod", "size", _OCTAVE, *nuisances]
    counted = count_rows(coded, keys, coded["rating"] - low, high - low + 1)
    shapes = {lod: bent_over(own) for lod, own in sizes.items()}
    predictor = _predictor(counted, shapes, nuisances)
    model = OrdinalModel(predictor, high - low + 1, (LENIENCY,))
    law = fit_law(
        model,
        counted,
        measure,
        rng,
        best=best,
        sizes=sizes,
        shapes=shapes,
        weights=weights,
        shape_priors=BENT_PRIORS,
    )
    shown = coded[coded["lod"] == best].groupby(_OCTAVE)["size"].mean()
    every = coded.groupby(_OCTAVE)["size"].mean()
    middles = shown.reindex(every.index).fillna(every)
    return RatedLaw(law, tuple(every.index.tolist()), tuple(middles.tolist()))


def _predictor(counted: Counted, shapes: Mapping[str, Shape], nuisances: list[str]) -> Predictor:
    table = counted.table
    octaves = sorted(table[_OCTAVE].unique())[1:]
    columns = [(table[_OCTAVE] == octave).astype(float) for octave in octaves]
    columns += [table[name].astype(float) for name in nuisances]
    design = np.column_stack([np.zeros((len(table), 0)), *columns])
    names = (*(f"{_OCTAVE}:{octave:g}" for octave in octaves), *nuisances)

    def side(column: str) -> Predictor:
        law = law_predictor(table, column, shapes)
        return Together(Linear(design, names), Scaled(law, np.full(len(table), -1.0)))

    partners = table.groupby([_OCTAVE, "lod"])["other_lod"].nunique()
    if not (partners > 1).any():
        return side("lod")
    return Beside(side("lod"), side("other_lod"))


def rated_curves(
    ratings: pd.DataFrame,
    measure: Measure,
    rng: np.random.Generator,
    *,
    best: str,
    scale: tuple[int, int],
    margins: Margins,
    experts: Mapping[str, bool],
    weights: Mapping[str, float] | None = None,
) -> tuple[SizeCurve, ...]:
    """Return the curve of every LoD that was rated at two sizes or more, where the best was too."""
    rows = with_size(answered(ratings), measure)
    rated = rated_law(rows, measure, rng, best=best, scale=scale, experts=experts, weights=weights)
    return tuple(_curve(rated, rows, lod, margins) for lod in rated.law.lods) if rated else ()


def _curve(rated: RatedLaw, rows: pd.DataFrame, lod: str, margins: Margins) -> SizeCurve:
    law = rated.law
    x = along(law.sizes[lod])
    d, d_draws = law.difference(lod, x)
    one, all_draws = law.both()
    loss, losses = _loss(rated, one, x, d[None])[0], _loss(rated, all_draws, x, d_draws)
    margin = margins.realism_points
    return make_curve(
        RATED,
        law,
        lod,
        rows=rows[rows["lod"] == lod],
        value=loss,
        draws=losses,
        base=(0.0, 0.0, 0.0),
        points=loss_points(rows, lod, law.best),
        levels=(Level(MARGIN, margin, loss, losses, margin),),
        confidence=margins.confidence,
    )


def _loss(rated: RatedLaw, parameters: Floats, x: Floats, d: Floats) -> Floats:
    """Return the points lost (n, n_x) by a difference d on the latent scale."""
    law = rated.law
    tau, noise = law.answer_criteria(parameters)
    best = _best_place(rated, parameters, x)
    total = np.zeros(np.broadcast_shapes(best.shape, d.shape))
    for k in range(tau.shape[1]):
        cut = tau[:, k : k + 1]
        total += ndtr((best - cut) / noise[:, None]) - ndtr((best - d - cut) / noise[:, None])
    return total


def _best_place(rated: RatedLaw, parameters: Floats, x: Floats) -> Floats:
    """Return the best LoD's realism (n, n_x), linear between the octaves' middles."""
    places = [rated.law.at(f"{_OCTAVE}:{octave:g}") for octave in rated.octaves[1:]]
    values = np.column_stack([np.zeros(len(parameters)), parameters[:, places]])
    weights = np.array([np.interp(x, rated.middles, unit) for unit in np.eye(len(rated.octaves))])
    return np.asarray(values @ weights)
