"""How fine an integration grid must be: guessed from the answers, checked at the optimum."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.models.counts import Counts
from analysis.models.likelihood import log_likelihood
from analysis.models.ordinal import INCONSISTENCY, LENIENCY, STYLE, OrdinalModel
from analysis.models.quadrature import Grid, normal_grid

Floats = NDArray[np.float64]
_TOLERANCE: Final = 1e-3  # in log-likelihood, between a grid and one twice as fine


def first_grid(model: OrdinalModel, counts: Counts) -> Grid:
    """Choose nodes no further apart than what a person's answers leave open about the person."""
    known = np.sqrt(1.0 + counts.most_per_person / model.link.sd**2)
    sizes = {
        LENIENCY: 12.0 * known * 0.7,
        INCONSISTENCY: 3.0 * known * 0.3,
        STYLE: 3.0 * known * 0.3,
    }
    least = {LENIENCY: 21, INCONSISTENCY: 9, STYLE: 9}
    most = {LENIENCY: 161, INCONSISTENCY: 21, STYLE: 21}
    return normal_grid([_odd(np.clip(sizes[e], least[e], most[e])) for e in model.effects])


def _odd(count: float) -> int:
    return 2 * int(np.ceil(count / 2)) + 1


def refined_grid(
    model: OrdinalModel,
    parameters: Floats,
    counts: Counts,
    grid: Grid,
    *,
    weights: Floats | None,
    value: float,
) -> Grid | None:
    """Return a finer grid where halving a direction's spacing changes the log-likelihood."""
    finer = list(grid.counts)
    for place, count in enumerate(grid.counts):
        trial: Sequence[int] = [
            2 * count - 1 if other == place else own for other, own in enumerate(grid.counts)
        ]
        again = log_likelihood(model, parameters, counts, normal_grid(trial), weights=weights)[0]
        if abs(again - value) > _TOLERANCE * (1.0 if len(grid.counts) == 1 else 20.0):
            finer[place] = 2 * count - 1
    return normal_grid(finer) if finer != list(grid.counts) else None
