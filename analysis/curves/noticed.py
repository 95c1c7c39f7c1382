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

from analysis.curves.curve import (
    D_PRIME_1,
    HALFWAY,
    MARGIN,
    NOTICED,
    SizeCurve,
    band,
    make_threshold,
    with_interval,
)
from analysis.curves.law import SizeLaw, count_rows, fit_law, law_predictor, sizes_by_lod
from analysis.curves.observed import share_points
from analysis.curves.sizes import Measure, along, with_size
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
    is_equal = rows["lod"] == ""
    sizes = sizes_by_lod(rows["lod"][~is_equal], rows["size"][~is_equal], best=best)
    if not sizes or not is_equal.any():
        return None
    kept = rows[is_equal | rows["lod"].isin(sizes)].copy()
    kept["size"] = kept["size"].where(kept["lod"] != "", 0.0)  # equal pairs: one stimulus
    grade = kept["noticed"].map({word: i for i, word in enumerate(reversed(GRADES))})
    counted = count_rows(kept, ["lod", "size"], grade, len(GRADES))
    predictor = law_predictor(counted.table, "lod", tuple(sizes))
    model = OrdinalModel(predictor, len(GRADES), (LENIENCY,))
    return fit_law(model, counted, measure, rng, best=best, sizes=sizes, weights=weights)


def against_best(comparisons: pd.DataFrame, measure: Measure, best: str) -> pd.DataFrame:
    """Return the trials of a LoD beside the best, and of equal LoDs, that count and have a size.

    ``lod`` is the lesser one, "" for equal pairs; ``is_right`` says whether the best stood right.
    """
    rows = with_size(comparisons[~comparisons["is_practice"]], measure)
    left, right = rows["left_lod"], rows["right_lod"]
    lesser = left.where(right == best, right).where(left != right, "")
    is_wanted = (left == right) | (left == best) | (right == best)
    return rows.assign(lod=lesser, is_right=right == best)[is_wanted]


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
    low, high = band(yes_draws)
    own = rows[rows["lod"] == lod]
    levels = (
        (D_PRIME_1, 1.0, d, d_draws, np.ones(len(d_draws))),
        (HALFWAY, (1 + alarm) / 2, yes, yes_draws, (1 + alarms) / 2),
        (MARGIN, alarm + margins.noticed_share, yes, yes_draws, alarms + margins.noticed_share),
    )
    return SizeCurve(
        kind=NOTICED,
        measure=law.measure,
        lod=lod,
        best=law.best,
        sizes=2.0**x,
        value=yes,
        low=low,
        high=high,
        base=with_interval(alarm, alarms),
        points=share_points(own["size"], own["noticed"] == "yes"),
        thresholds=tuple(
            make_threshold(
                name,
                level,
                x,
                value=value,
                draws=draws,
                levels=each,
                confidence=margins.confidence,
            )
            for name, level, value, draws, each in levels
        ),
        people=own["participant"].nunique(),
        answers=len(own),
    )


def _criterion(law: SizeLaw, parameters: Floats) -> tuple[Floats, Floats]:
    """Return the criterion of a yes and the noise of a drawn person."""
    tau, noise = law.answer_criteria(parameters)
    return tau[:, -1], noise
