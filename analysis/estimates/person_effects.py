"""How much people differ: standard deviations of leniency, scatter and end-avoidance.

Their intervals are those of the profile likelihood where people are few: a spread near zero has
one arm much longer than the other, which an estimate and its standard error do not show.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from analysis.estimates.realism import Realism
from analysis.models.profile import profile_interval

COLUMNS: Final = ("effect", "spread", "spread_low", "spread_high", "interval")
_MANY: Final = 200  # people from which both kinds of interval are the same
_TWO_SIDED: Final = 1.959964


def person_effects(realism: Realism) -> pd.DataFrame:
    """Return the spreads of the ratings' model with 95 % intervals; columns are COLUMNS.

    Leniency in the scatter of one person's ratings; scatter and style as logarithms.
    """
    found, rows = realism.fit, []
    is_profiled = len(realism.stimuli.people) < _MANY
    for effect in found.model.effects:
        name = f"log_sd:{effect}"
        half = _TWO_SIDED * found.standard_error(name)
        ends = (found.value(name) - half, found.value(name) + half)
        if is_profiled:
            ends = profile_interval(found, name)
        kind = "profile likelihood" if is_profiled else "standard error"
        rows.append((effect, found.sd(effect), *np.exp(ends), kind))
    return pd.DataFrame(rows, columns=list(COLUMNS))
