"""Who finds the best LoD more realistic than a lesser one beside it, along the iris's size.

    P(-1) = Phi(-delta - lambda - D),  P(0) = Phi(delta - lambda - D) - P(-1),  D = +-A Phi(z)

where z = (x - m) / w and the sign is that of the side on which the best LoD stands. "No difference"
is an answer like others.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import ndtr

from analysis.curves.curve import ONE_JOD, PREFERRED, SizeCurve, band, make_threshold, with_interval
from analysis.curves.law import SLOW, SizeLaw, count_rows, fit_law, law_predictor, sizes_by_lod
from analysis.curves.noticed import against_best
from analysis.curves.observed import share_points
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
    is_equal = rows["lod"] == ""
    sizes = sizes_by_lod(rows["lod"][~is_equal], rows["size"][~is_equal], best=best)
    if not sizes:
        return None
    kept = rows[is_equal | rows["lod"].isin(sizes)].copy()
    kept["size"] = kept["size"].where(kept["lod"] != "", 0.0)
    counted = count_rows(kept, ["lod", "size", "is_right"], kept["comparison"] + 1, 3)
    law = law_predictor(counted.table, "lod", tuple(sizes))
    sign = np.where(counted.table["is_right"].to_numpy(dtype=bool), 1.0, -1.0)
    model = OrdinalModel(Scaled(law, sign), 3, (LENIENCY,))
    return fit_law(
        model, counted, measure, rng, best=best, sizes=sizes, weights=weights, log_width=SLOW
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
    low, high = band(values)
    own = rows[rows["lod"] == lod]
    sign = np.where(own["is_right"].to_numpy(dtype=bool), 1.0, -1.0)
    threshold = make_threshold(
        ONE_JOD,
        1.0,
        x,
        value=JOD * d,
        draws=JOD * d_draws,
        levels=1.0,
        confidence=margins.confidence,
    )
    return SizeCurve(
        kind=PREFERRED,
        measure=law.measure,
        lod=lod,
        best=law.best,
        sizes=2.0**x,
        value=value,
        low=low,
        high=high,
        base=with_interval(base, bases),
        points=share_points(own["size"], pd.Series(own["comparison"].astype(float) * sign > 0)),
        thresholds=(threshold,),
        people=own["participant"].nunique(),
        answers=len(own),
    )


def _wins(law: SizeLaw, parameters: Floats, d: Floats) -> Floats:
    """Return the population's share that prefers the best LoD, averaged over both sides."""
    tau, noise = law.answer_criteria(parameters)
    right = ndtr((d - tau[:, 1:]) / noise[:, None])
    left = ndtr((d + tau[:, :1]) / noise[:, None])
    return np.asarray((right + left) / 2)
