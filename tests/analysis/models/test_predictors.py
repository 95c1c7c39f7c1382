"""Predictors: their Jacobians and their refusals."""

from __future__ import annotations

import numpy as np
import pytest

from analysis.models.predictors import Contrasted, Linear, Predictor

RNG = np.random.default_rng(1)
CASES: dict[str, Predictor] = {
    "linear": Linear(RNG.normal(size=(5, 2)), ("a", "b")),
    "contrasted": Contrasted(RNG.normal(size=(5, 2)), RNG.normal(size=(5, 2)), ("a", "b")),
}


@pytest.mark.parametrize("name", list(CASES))
def test_the_jacobian_is_that_of_finite_differences(name: str) -> None:
    predictor = CASES[name]
    at = np.random.default_rng(2).normal(size=len(predictor.names))
    assert len(predictor.kinds) == len(predictor.names)
    steps = np.eye(len(at)) * 1e-6
    numeric = [(predictor.eta(at + e) - predictor.eta(at - e)) / 2e-6 for e in steps]
    assert predictor.jacobian(at) == pytest.approx(np.array(numeric).T, abs=1e-8)
    assert predictor.eta(at).shape == (predictor.stimuli,)


def test_equal_lods_gain_nothing_by_contrast() -> None:
    design = np.eye(3)
    own = Contrasted(design, design, ("a", "b", "c"))
    means = np.array([0.3, 0.8, -0.2])
    assert own.eta(np.append(means, 0.7)) == pytest.approx(means)


def test_a_design_without_a_column_for_a_term_is_refused() -> None:
    with pytest.raises(ValueError, match=r"a column for each of .*'b'.*; found \(3, 1\)"):
        Linear(np.zeros((3, 1)), ("a", "b"))
