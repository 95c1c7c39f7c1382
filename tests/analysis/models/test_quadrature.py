"""Grids: weights of a probability, integrals of closed form."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ndtr

from analysis.models.quadrature import normal_grid


@pytest.mark.parametrize("counts", [(), (1,), (21,), (21, 9), (21, 9, 5)])
def test_weights_sum_to_one(counts: tuple[int, ...]) -> None:
    grid = normal_grid(counts)
    assert np.exp(grid.log_weights).sum() == pytest.approx(1.0)
    assert grid.nodes.shape == (len(counts), max(1, int(np.prod(counts))))


def test_moments_and_a_probit_average_are_exact() -> None:
    grid = normal_grid([41])
    weights, z = np.exp(grid.log_weights), grid.nodes[0]
    assert weights @ z**2 == pytest.approx(1.0, abs=1e-5)  # what lies beyond 5.5 sd
    assert weights @ z**4 == pytest.approx(3.0, abs=3e-4)
    # E Phi(a + s z) = Phi(a / sqrt(1 + s^2))
    assert weights @ ndtr(0.7 + 1.3 * z) == pytest.approx(ndtr(0.7 / np.hypot(1, 1.3)), abs=1e-7)


def test_directions_are_independent() -> None:
    grid = normal_grid([31, 21])
    weights = np.exp(grid.log_weights)
    assert weights @ (grid.nodes[0] * grid.nodes[1]) == pytest.approx(0.0, abs=1e-12)
    assert weights @ (grid.nodes[0] * grid.nodes[1]) ** 2 == pytest.approx(1.0, abs=1e-4)


def test_no_node_is_refused() -> None:
    with pytest.raises(ValueError, match="at least one node in each direction; found 0"):
        normal_grid([5, 0])


def test_nodes_between_make_a_sum_over_nodes_half_as_far_apart() -> None:
    coarse, fine = normal_grid([15]), normal_grid([29])
    between = coarse.between(0)
    halves = [np.exp(g.log_weights) @ ndtr(0.7 + 1.3 * g.nodes[0]) for g in (coarse, between)]
    assert np.mean(halves) == pytest.approx(
        np.exp(fine.log_weights) @ ndtr(0.7 + 1.3 * fine.nodes[0]), abs=1e-7
    )
    first = normal_grid([9, 5]).between(1)
    assert first.nodes[0] == pytest.approx(normal_grid([9, 5]).nodes[0])
