"""Each person's leniency, scatter and style by the ratings' model, drawn towards the population.

What few ratings say of a person is weighed against how people differ at all (empirical Bayes), so
nobody stands apart only because they answered little.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from analysis.estimates.realism import Realism
from analysis.models.likelihood import cells, posteriors
from analysis.models.ordinal import LENIENCY, PERSON_EFFECTS

COLUMNS: Final = ("participant", *(f"{own}{end}" for own in PERSON_EFFECTS
                                   for end in ("", "_low", "_high")))  # fmt: skip
_BLOCK: Final = 256  # people at a time
_TWO_SIDED: Final = 1.959964


def each_person(realism: Realism) -> pd.DataFrame:
    """Return every person's effects with 95 % intervals; columns are COLUMNS.

    Leniency is in the scatter of one person's ratings, above 0 lenient; inconsistency and style are
    factors of the population's scatter and of the thresholds' distances from the scale's middle:
    above 1 scatters more, and avoids the ends. Effects that the model lacks are empty.
    """
    found, names = realism.fit, realism.stimuli.people
    table: dict[str, object] = {"participant": [str(who) for who in names]}
    mean, sd = _moments(realism)
    for place, effect in enumerate(PERSON_EFFECTS):
        ends = (mean[:, place] + k * _TWO_SIDED * sd[:, place] for k in (0, -1, 1))
        for end, values in zip(("", "_low", "_high"), ends, strict=True):
            own = values if effect == LENIENCY else np.exp(values)
            table[f"{effect}{end}"] = own if effect in found.model.effects else np.nan
    return pd.DataFrame(table, columns=list(COLUMNS))


def _moments(realism: Realism) -> tuple[np.ndarray, np.ndarray]:
    """Return means and standard deviations (n_people, 3) of what ratings leave open of people."""
    found = realism.fit
    at = cells(found.model, found.parameters, found.grid)
    effect = (found.model.spreads(found.parameters)[:, None] * at.nodes).T  # (Q, 3)
    flat = at.log_p.reshape(-1, at.log_p.shape[2])
    own = found.counts.table.reshape(found.counts.people, -1)
    both = np.concatenate([effect, effect**2], axis=1)
    sums = np.concatenate(
        [
            posteriors(own[start : start + _BLOCK], flat, found.grid)[0] @ both
            for start in range(0, len(own), _BLOCK)
        ]
    )
    mean, square = np.split(sums, 2, axis=1)
    return mean, np.sqrt(np.maximum(square - mean**2, 0.0))
