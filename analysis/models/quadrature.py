"""Grids over people's effects: fixed nodes, the same for all people, weighted by the normal law.

Equally spaced nodes (the trapezoidal rule) converge faster than any power of the spacing for a
smooth, decaying integrand (Trefethen and Weideman 2014, SIAM Review 56(3)), and unlike
Gauss-Hermite nodes they do not thin out where one person's many answers put the mass.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
REACH: Final = 5.5  # standard deviations to either side; outside lie 4e-8 of a normal law


@dataclass(frozen=True)
class Grid:
    """Nodes (n_effects, Q) in units of each effect's standard deviation, and log weights (Q,).

    ``counts`` are the nodes in each direction and ``reaches`` how far they go.
    """

    nodes: Floats
    log_weights: Floats
    counts: tuple[int, ...]
    reaches: tuple[float, ...] = ()

    def only(self, kept: NDArray[np.bool_]) -> Grid:
        """Return the grid without the nodes where ``kept`` (Q,) is False; weights stay."""
        return replace(self, nodes=self.nodes[:, kept], log_weights=self.log_weights[kept])

    def between(self, direction: int) -> Grid:
        """Return the nodes half a spacing further in one direction: the mean of a sum over these
        and of one over the grid's own is a sum over nodes half as far apart.
        """
        count, reach = self.counts[direction], self.reaches[direction]
        half = reach / (count - 1) if count > 1 else 0.5
        nodes = self.nodes.copy()
        nodes[direction] += half
        logs = (self.nodes[direction] ** 2 - nodes[direction] ** 2) / 2
        return replace(self, nodes=nodes, log_weights=self.log_weights + logs)


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
    return Grid(
        np.array([node.ravel() for node in nodes]), logs.ravel(), tuple(counts), tuple(ends)
    )


def _axis(count: int, reach: float) -> tuple[Floats, Floats]:
    if count < 1:
        raise ValueError(f"a grid has at least one node in each direction; found {count}")
    if count == 1:
        return np.zeros(1), np.zeros(1)
    nodes = np.linspace(-reach, reach, count)
    logs = -0.5 * nodes**2
    weights = np.exp(logs - logs.max())
    return nodes, np.asarray(logs - logs.max() - np.log(weights.sum()))
