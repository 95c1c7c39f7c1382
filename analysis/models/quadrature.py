"""Grids over people's effects: fixed nodes, the same for all people, weighted by the normal law.

Equally spaced nodes (the trapezoidal rule) converge faster than any power of the spacing for a
smooth, decaying integrand (Trefethen and Weideman 2014, SIAM Review 56(3)), and unlike
Gauss-Hermite nodes they do not thin out where one person's many answers put the mass.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
REACH: Final = 5.5  # standard deviations to either side; outside lie 4e-8 of a normal law


@dataclass(frozen=True)
class Grid:
    """Nodes (n_effects, Q) in units of each effect's standard deviation, and log weights (Q,)."""

    nodes: Floats
    log_weights: Floats
    counts: tuple[int, ...]

    def only(self, kept: NDArray[np.bool_]) -> Grid:
        """Return the grid without the nodes where ``kept`` (Q,) is False; weights stay."""
        return Grid(self.nodes[:, kept], self.log_weights[kept], self.counts)


def normal_grid(counts: Sequence[int], *, reach: Sequence[float] | None = None) -> Grid:
    """Return the product grid with ``counts[i]`` nodes for effect i; one node stands at zero.

    ``reach[i]`` is how far the nodes of effect i go, in standard deviations.
    """
    if not counts:  # no person effect: all people alike
        return Grid(np.zeros((0, 1)), np.zeros(1), ())
    ends = [REACH] * len(counts) if reach is None else reach
    axes = [_axis(count, end) for count, end in zip(counts, ends, strict=True)]
    nodes = np.meshgrid(*(axis[0] for axis in axes), indexing="ij")
    logs: Floats = reduce(np.add.outer, (axis[1] for axis in axes), np.zeros(()))
    return Grid(np.array([node.ravel() for node in nodes]), logs.ravel(), tuple(counts))


def _axis(count: int, reach: float) -> tuple[Floats, Floats]:
    if count < 1:
        raise ValueError(f"a grid has at least one node in each direction; found {count}")
    if count == 1:
        return np.zeros(1), np.zeros(1)
    nodes = np.linspace(-reach, reach, count)
    logs = -0.5 * nodes**2
    weights = np.exp(logs - logs.max())
    return nodes, np.asarray(logs - logs.max() - np.log(weights.sum()))
