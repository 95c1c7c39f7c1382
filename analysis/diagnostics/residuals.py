"""Randomised quantile residuals of the ratings: standard normal where the model fits.

An answer y with probabilities P(< y) and P(<= y) becomes Phi^-1(u), u uniform between the two (Dunn
and Smyth 1996, J. Comput. Graph. Stat. 5). The person is drawn first (``answers``).
"""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from scipy.special import ndtri

from analysis.diagnostics.answers import answers_of, probabilities
from analysis.estimates.realism import Realism

COLUMNS: Final = ("participant", "distance", "lod", "rating", "expected", "residual")
_END: Final = 1e-12  # nearer to 0 or 1 the quantile says nothing but that it is far out


def quantile_residuals(realism: Realism, rng: np.random.Generator) -> pd.DataFrame:
    """Return one row for each rating that counts; columns are COLUMNS.

    ``expected`` is the person's mean rating of such an eye by the model, in points; ``residual`` is
    standard normal and independent of all others where the model is right. The same ``rng`` gives
    the same residuals.
    """
    fit, stimuli = realism.fit, realism.stimuli
    answers = answers_of(fit.counts)
    (share,) = probabilities(
        fit.model, fit.parameters, fit.counts, fit.grid, answers=answers, rng=rng
    )
    up_to = np.cumsum(share, axis=1)
    row = np.arange(len(share))
    own = share[row, answers.category]
    level = up_to[row, answers.category] - own * rng.random(len(share))
    low = stimuli.scale[0]
    seen = stimuli.table.iloc[answers.stimulus]
    return pd.DataFrame(
        {
            "participant": np.array(stimuli.people, dtype=object)[answers.person],
            "distance": seen["distance"].to_numpy(),
            "lod": seen["lod"].to_numpy(),
            "rating": low + answers.category,
            "expected": low + share @ np.arange(share.shape[1]),
            "residual": ndtri(np.clip(level, _END, 1.0 - _END)),
        }
    )
