"""How fine an integration grid must be: guessed from the answers, checked at the optimum."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.models.counts import Counts
from analysis.models.likelihood import log_likelihood, visited
from analysis.models.ordinal import INCONSISTENCY, LENIENCY, STYLE, OrdinalModel
from analysis.models.quadrature import Grid, normal_grid

Floats = NDArray[np.float64]
# Nodes per direction: (fewest, most at first, per square root of a person's answers).
_SIZES: Final[Mapping[str, tuple[int, int, float]]] = {
    LENIENCY: (21, 161, 8.0),
    INCONSISTENCY: (9, 17, 1.5),
    STYLE: (9, 13, 1.2),
}
_REACH: Final[Mapping[str, float]] = {LENIENCY: 5.5, INCONSISTENCY: 4.0, STYLE: 4.0}
_COARSE: Final[Mapping[str, int]] = {LENIENCY: 31, INCONSISTENCY: 7, STYLE: 7}
_TOLERANCE: Final = (1e-3, 0.05)  # in log-likelihood: with one effect, with more
_UNVISITED: Final = 1e-9  # a node where nobody is more likely than this is left out
_MOST_NODES, _MOST_CELLS = 1281, 40_000  # in one direction, and in all


def coarse_grid(model: OrdinalModel) -> Grid:
    """Return a grid that is good enough to come near the optimum."""
    return _grid(model, [_COARSE[effect] for effect in model.effects])


def first_grid(model: OrdinalModel, counts: Counts) -> Grid:
    """Choose nodes no further apart than what a person's answers leave open about the person."""
    known = np.sqrt(1.0 + counts.most_per_person / model.link.sd**2)
    sizes = [int(np.clip(_SIZES[e][2] * known, _SIZES[e][0], _SIZES[e][1])) for e in model.effects]
    return _grid(model, [size + 1 - size % 2 for size in sizes])


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
    """Return a finer grid where halving a direction's spacing changes the log-likelihood."""
    value = log_likelihood(model, parameters, counts, grid, weights=weights)[0]
    finer = list(grid.counts)
    for place, count in enumerate(grid.counts):
        trial = [2 * n - 1 if i == place else n for i, n in enumerate(grid.counts)]
        again = log_likelihood(model, parameters, counts, _grid(model, trial), weights=weights)[0]
        if abs(again - value) > _TOLERANCE[min(len(trial) - 1, 1)]:
            finer[place] = 2 * count - 1
    return _grid(model, finer) if finer != list(grid.counts) else None


def is_too_large(grid: Grid) -> bool:
    """Say whether a grid is beyond what is worth the time."""
    return max(grid.counts) > _MOST_NODES or grid.log_weights.size > _MOST_CELLS


def _grid(model: OrdinalModel, sizes: list[int]) -> Grid:
    return normal_grid(sizes, reach=[_REACH[effect] for effect in model.effects])
