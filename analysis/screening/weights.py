"""How much each person counts: fully, unless much less consistent than others, or flagged."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from analysis.screening.evidence import LEAST, weights_of
from analysis.screening.flags import FALSE_ALARMS, flags_of

_ORDINARY: Final = 1.5  # times the median inconsistency, from which weight is lost


def observer_weights(signals: pd.DataFrame) -> dict[str, float]:
    """Return the weights below 1, by participant; whoever is not named counts fully.

    Inconsistency beyond 1.5 times the median v costs weight as its square, (1.5 v / v_i)^2. Answers
    that are k times likelier from somebody who did not look, or who turned the scale, count 1 / k,
    so that nobody has to be named to lose weight. A flag leaves 0.1; false alarms alone do not,
    because they say nothing about ratings.
    """
    scatter = signals["inconsistency"].to_numpy(dtype=float)
    ordinary = _ORDINARY * float(np.nanmedian(scatter)) if np.isfinite(scatter).any() else np.nan
    with np.errstate(invalid="ignore"):
        own = np.minimum(1.0, np.nan_to_num((ordinary / scatter) ** 2, nan=1.0))
    own = np.maximum(
        own * weights_of(signals[["looking", "upright"]].min(axis=1).to_numpy()), LEAST
    )
    weights = dict(zip(signals["participant"].astype(str), own.tolist(), strict=True))
    for who, flags in flags_of(signals).items():
        if set(flags) - {FALSE_ALARMS}:
            weights[who] = min(weights[who], LEAST)
    return {who: weight for who, weight in weights.items() if weight < 1.0}
