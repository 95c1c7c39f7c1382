"""What the preference scale expects of a comparison: the shares that stand beside those given."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.special import ndtr

from analysis.estimates.preference import JOD, Cell, Preference
from analysis.models.quadrature import normal_grid

_NODES: Final = 15
Shares = tuple[float, float, float]


def choice_shares(preference: Preference, left: Cell, right: Cell) -> Shares | None:
    """Return the population's shares (left better, no difference, right better) of one pair.

    Averages over people: their pull to a side in closed form, their band of "no difference" on a
    grid. None where an eye has no place on the scale, or the two have no scale in common.
    """
    where = {cell: i for i, cell in enumerate(preference.cells)}
    if left not in where or right not in where:
        return None
    a, b = where[left], where[right]
    if preference.references[a] != preference.references[b]:
        return None
    place = preference.jod()[0] / JOD
    model, parameters = preference.fit.model, preference.fit.parameters
    tau, (side, _, stretch) = model.thresholds(parameters), model.spreads(parameters)
    grid = normal_grid([_NODES])
    wide = np.exp(stretch * grid.nodes[0])[:, None] * (tau - tau.mean())
    bounds = (tau.mean() + wide - (place[b] - place[a])) / np.hypot(1.0, side)
    below, under = np.exp(grid.log_weights) @ ndtr(bounds)
    return float(below), float(under - below), float(1.0 - under)


def pair_shares(preference: Preference, lesser: Cell, greater: Cell) -> Shares | None:
    """Return the shares (lesser better, no difference, greater better), both sides averaged."""
    one, other = (
        choice_shares(preference, lesser, greater),
        choice_shares(preference, greater, lesser),
    )
    if one is None or other is None:
        return None
    return (one[0] + other[2]) / 2, (one[1] + other[1]) / 2, (one[2] + other[0]) / 2
