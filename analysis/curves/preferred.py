"""Who finds the best LoD more realistic than a lesser one beside it, along the iris's size.

    P(-1) = Phi(-delta - lambda - D),  P(0) = Phi(delta - lambda - D) - P(-1),  D = +-d(x)

where the sign is that of the side on which the best LoD stands. "No difference" is an answer like
others.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import ndtr

from analysis.curves.compared import against_best, at_sizes
from analysis.curves.curve import ONE_JOD, PREFERRED, SizeCurve, with_interval
from analysis.curves.law import SizeLaw, count_rows, fit_law, law_predictor
from analysis.curves.made import Level, make_curve
from analysis.curves.observed import share_points
from analysis.curves.shapes import BENT_PRIORS, bent_over
from analysis.curves.sizes import Measure, along
from analysis.decision.margins import Margins
from analysis.estimates.preference import JOD
from analysis.models.combined import Scaled
from analysis.models.ordinal import LENIENCY, OrdinalModel

Floats = NDArray[np.float64]


def preferred_law(
    rows: pd.DataFrame,
    measure: Measure,
    rng: np.random.Generator,
    *,
    best: str,
    weights: Mapping[str, float] | None = None,
) -> SizeLaw | None:
    """Fit the law to rows of ``against_best``; None where no LoD was shown at two sizes."""
    kept, sizes = at_sizes(rows, best)
    if not sizes:
        return None
    counted = count_rows(kept, ["lod", "size", "is_right"], kept["comparison"] + 1, 3)
    shapes = {lod: bent_over(own) for lod, own in sizes.items()}
    law = law_predictor(counted.table, "lod", shapes)
    sign = np.where(counted.table["is_right"].to_numpy(dtype=bool), 1.0, -1.0)
    model = OrdinalModel(Scaled(law, sign), 3, (LENIENCY,))
    return fit_law(
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


def preferred_curves(
    comparisons: pd.DataFrame,
    measure: Measure,
    rng: np.random.Generator,
    *,
    best: str,
    margins: Margins,
    weights: Mapping[str, float] | None = None,
) -> tuple[SizeCurve, ...]:
    """Return the curve of every LoD that was compared with the best at two sizes or more."""
    rows = against_best(comparisons[comparisons["comparison"].notna()], measure, best)
    law = preferred_law(rows, measure, rng, best=best, weights=weights)
    return tuple(_curve(law, rows, lod, margins) for lod in law.lods) if law else ()


def _curve(law: SizeLaw, rows: pd.DataFrame, lod: str, margins: Margins) -> SizeCurve:
    x = along(law.sizes[lod])
    d, d_draws = law.difference(lod, x)
    one, all_draws = law.both()
    value, values = _wins(law, one, d[None])[0], _wins(law, all_draws, d_draws)
    none = np.zeros((1, 1))
    base = float(_wins(law, one, none)[0, 0])
    bases = _wins(law, all_draws, np.zeros((len(all_draws), 1)))[:, 0]
    own = rows[rows["lod"] == lod]
    sign = np.where(own["is_right"].to_numpy(dtype=bool), 1.0, -1.0)
    return make_curve(
        PREFERRED,
        law,
        lod,
        rows=own,
        value=value,
        draws=values,
        base=with_interval(base, bases),
        points=share_points(own["size"], pd.Series(own["comparison"].astype(float) * sign > 0)),
        levels=(Level(ONE_JOD, 1.0, JOD * d, JOD * d_draws, 1.0),),
        confidence=margins.confidence,
    )


def _wins(law: SizeLaw, parameters: Floats, d: Floats) -> Floats:
    """Return the population's share that prefers the best LoD, averaged over both sides."""
    tau, noise = law.answer_criteria(parameters)
    right = ndtr((d - tau[:, 1:]) / noise[:, None])
    left = ndtr((d + tau[:, :1]) / noise[:, None])
    return np.asarray((right + left) / 2)
