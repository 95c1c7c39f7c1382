"""How fine an integration grid must be: chosen from the answers, checked at the optimum.

The trapezoidal rule on a bell-shaped integrand errs by exp(-2 pi^2 s^2 / h^2), with s the bell's
width and h the spacing: what a person's answers leave open about the person gives s.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.models.counts import Counts
from analysis.models.likelihood import person_log_likelihoods, visited
from analysis.models.ordinal import INCONSISTENCY, LENIENCY, STYLE, OrdinalModel
from analysis.models.quadrature import Grid, normal_grid

Floats = NDArray[np.float64]
# Spacing in units of what the busiest person's answers leave open; alone, and beside others. An
# answer says less about scatter and style than about leniency, so their spacing may be wider.
_SPACING: Final[Mapping[str, tuple[float, float]]] = {
    LENIENCY: (1.0, 1.35),
    INCONSISTENCY: (1.2, 1.7),
    STYLE: (1.2, 1.7),
}
_REACH: Final[Mapping[str, float]] = {LENIENCY: 5.5, INCONSISTENCY: 4.0, STYLE: 4.0}
_FEWEST: Final[Mapping[str, int]] = {LENIENCY: 21, INCONSISTENCY: 7, STYLE: 7}
_COARSE: Final[Mapping[str, int]] = {LENIENCY: 31, INCONSISTENCY: 7, STYLE: 7}
_TOLERANCE: Final = (1e-4, 0.05)  # in log-likelihood of 200 people: with one effect, with more
_PEOPLE: Final = 200.0  # of many more people the curvature grows as their errors do
_FINER: Final = 1.5  # the error falls faster than any power of the spacing
_UNVISITED: Final = 1e-7  # a node where nobody is more likely than this is left out
_MOST_NODES, _MOST_CELLS = 1281, 40_000  # in one direction, and in all


def coarse_grid(model: OrdinalModel) -> Grid:
    """Return a grid that is good enough to come near the optimum."""
    return _grid(model, [_COARSE[effect] for effect in model.effects])


def first_grid(model: OrdinalModel, counts: Counts, parameters: Floats) -> Grid:
    """Choose nodes no further apart than what a person's answers leave open about the person."""
    is_alone = len(model.effects) < 2
    spreads = dict(zip(model.effects, np.exp(parameters[model.slices["spread"]]), strict=True))
    sizes = []
    for effect, sd in spreads.items():
        known = np.sqrt(1.0 + counts.most_per_person * (sd / model.link.sd) ** 2)
        spacing = _SPACING[effect][0 if is_alone else 1] / known
        size = max(int(np.ceil(2 * _REACH[effect] / spacing)), _FEWEST[effect])
        sizes.append(min(size + 1 - size % 2, _MOST_NODES))
    return _grid(model, sizes)


def thinned(model: OrdinalModel, parameters: Floats, counts: Counts, grid: Grid) -> Grid:
    """Return the grid without the nodes that nobody is likely to be at."""
    if len(grid.counts) < 2:
        return grid  # nothing to gain
    return grid.only(visited(model, parameters, counts, grid) > _UNVISITED)


def refined_grid(
    model: OrdinalModel,
    parameters: Floats,
    counts: Counts,
    grid: Grid,
    *,
    weights: Floats | None = None,
) -> Grid | None:
    """Return a whole finer grid where halving a spacing would change the log-likelihood, else None.

    To know that, the nodes half-way are enough: the others are known.
    """
    own = person_log_likelihoods(model, parameters, counts, grid)
    often = np.ones(len(own)) if weights is None else weights
    tolerance = _TOLERANCE[min(len(grid.counts) - 1, 1)] * max(1.0, counts.people / _PEOPLE)
    finer = list(grid.counts)
    for place, count in enumerate(grid.counts):
        middle = person_log_likelihoods(model, parameters, counts, grid.between(place))
        change = float(often @ (np.logaddexp(own, middle) - np.log(2.0) - own))
        if abs(change) > tolerance:
            finer[place] = 2 * int(np.ceil(_FINER * (count - 1) / 2)) + 1
    return _grid(model, finer) if finer != list(grid.counts) else None


def is_too_large(grid: Grid) -> bool:
    """Say whether a grid is beyond what is worth the time."""
    return max(grid.counts) > _MOST_NODES or grid.log_weights.size > _MOST_CELLS


def _grid(model: OrdinalModel, sizes: list[int]) -> Grid:
    return normal_grid(sizes, reach=[_REACH[effect] for effect in model.effects])
