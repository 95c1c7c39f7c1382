"""Who notices a LoD beside the best one, along the iris's size.

    P(at most k) = Phi(c_k - d(x) - u_i),   d(x) = A Phi((x - m) / w),   d = 0 for equal LoDs

The guess rate is not assumed: it is what people say of equal pairs. People differ in their
criterion, and the curve is the population's: P(yes) = Phi((d(x) - c) / sqrt(1 + sd_u^2)).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import ndtr

from analysis.curves.compared import EQUAL, against_best, at_sizes
from analysis.curves.curve import D_PRIME_1, HALFWAY, MARGIN, NOTICED, SizeCurve, with_interval
from analysis.curves.law import SizeLaw, count_rows, fit_law, law_predictor
from analysis.curves.made import Level, make_curve
from analysis.curves.observed import share_points
from analysis.curves.shapes import Shape
from analysis.curves.sizes import Measure, along
from analysis.decision.margins import Margins
from analysis.models.ordinal import LENIENCY, OrdinalModel
from analysis.tables.columns import NOTICED as GRADES

Floats = NDArray[np.float64]


def noticed_law(
    rows: pd.DataFrame,
    measure: Measure,
    rng: np.random.Generator,
    *,
    best: str,
    weights: Mapping[str, float] | None = None,
) -> SizeLaw | None:
    """Fit the law to rows of ``against_best``; None without equal pairs or with one size only."""
    kept, sizes = at_sizes(rows, best)
    if not sizes or not (kept["lod"] == EQUAL).any():
        return None
    grade = kept["noticed"].map({word: i for i, word in enumerate(reversed(GRADES))})
    counted = count_rows(kept, ["lod", "size"], grade, len(GRADES))
    shapes = dict.fromkeys(sizes, Shape())
    predictor = law_predictor(counted.table, "lod", shapes)
    model = OrdinalModel(predictor, len(GRADES), (LENIENCY,))
    return fit_law(
        model, counted, measure, rng, best=best, sizes=sizes, shapes=shapes, weights=weights
    )


def noticed_curves(
    comparisons: pd.DataFrame,
    measure: Measure,
    rng: np.random.Generator,
    *,
    best: str,
    margins: Margins,
    weights: Mapping[str, float] | None = None,
) -> tuple[SizeCurve, ...]:
    """Return the curve of every LoD that was shown beside the best at two sizes or more."""
    rows = against_best(comparisons[comparisons["noticed"].notna()], measure, best)
    law = noticed_law(rows, measure, rng, best=best, weights=weights)
    return tuple(_curve(law, rows, lod, margins) for lod in law.lods) if law else ()


def _curve(law: SizeLaw, rows: pd.DataFrame, lod: str, margins: Margins) -> SizeCurve:
    x = along(law.sizes[lod])
    d, d_draws = law.difference(lod, x)
    (criterion, noise), (criteria, noises) = (_criterion(law, own) for own in law.both())
    yes = ndtr((d - criterion[0]) / noise[0])
    yes_draws = ndtr((d_draws - criteria[:, None]) / noises[:, None])
    alarm, alarms = float(ndtr(-criterion[0] / noise[0])), ndtr(-criteria / noises)
    own = rows[rows["lod"] == lod]
    margin = margins.noticed_share
    levels = (
        Level(D_PRIME_1, 1.0, d, d_draws, 1.0),
        Level(HALFWAY, (1 + alarm) / 2, yes, yes_draws, (1 + alarms) / 2),
        Level(MARGIN, alarm + margin, yes, yes_draws, alarms + margin),
    )
    return make_curve(
        NOTICED,
        law,
        lod,
        rows=own,
        value=yes,
        draws=yes_draws,
        base=with_interval(alarm, alarms),
        points=share_points(own["size"], own["noticed"] == "yes"),
        levels=levels,
        confidence=margins.confidence,
    )


def _criterion(law: SizeLaw, parameters: Floats) -> tuple[Floats, Floats]:
    """Return the criterion of a yes and the noise of a drawn person."""
    tau, noise = law.answer_criteria(parameters)
    return tau[:, -1], noise
