"""People's own gradients: their sum is the whole one, each is that of finite differences."""

from __future__ import annotations

import numpy as np
import pytest

from analysis.models.counts import Counts, count_answers
from analysis.models.likelihood import log_likelihood, person_log_likelihoods
from analysis.models.ordinal import LENIENCY, PERSON_EFFECTS, OrdinalModel
from analysis.models.predictors import Contrasted
from analysis.models.quadrature import Grid, normal_grid
from analysis.models.scores import person_scores


@pytest.fixture(params=[(), (LENIENCY,), PERSON_EFFECTS], ids=len)
def problem(request: pytest.FixtureRequest) -> tuple[OrdinalModel, Counts, Grid, np.ndarray]:
    rng = np.random.default_rng(9)
    model = OrdinalModel(
        Contrasted(rng.normal(size=(5, 2)), rng.normal(size=(5, 2)), ("a", "b")),
        effects=request.param,
        scale=rng.normal(size=(5, 1)),
        scale_terms=("group",),
    )
    answers = (rng.integers(size, size=150) for size in (6, 5, 5))
    counts = count_answers(*answers, shape=(6, 5, 5))
    grid = normal_grid([9, 5, 5][: len(request.param)])
    return model, counts, grid, 0.4 * rng.normal(size=len(model.names))


def test_a_person_s_gradient_is_that_of_finite_differences(
    problem: tuple[OrdinalModel, Counts, Grid, np.ndarray],
) -> None:
    model, counts, grid, at = problem
    scores, logs = person_scores(model, at, counts, grid)
    assert logs == pytest.approx(person_log_likelihoods(model, at, counts, grid))
    for place, step in enumerate(np.eye(len(at)) * 1e-5):
        above, below = (
            person_log_likelihoods(model, at + sign * step, counts, grid) for sign in (1, -1)
        )
        assert scores[:, place] == pytest.approx((above - below) / 2e-5, rel=1e-5, abs=1e-5)
    assert scores.sum(axis=0) == pytest.approx(log_likelihood(model, at, counts, grid)[1])


def test_nominal_terms_are_refused() -> None:
    rng = np.random.default_rng(9)
    model = OrdinalModel(
        Contrasted(rng.normal(size=(5, 2)), rng.normal(size=(5, 2)), ("a", "b")),
        nominal=rng.normal(size=(5, 1)),
        nominal_terms=("x",),
    )
    counts = count_answers([0], [0], [0], shape=(1, 5, 5))
    with pytest.raises(ValueError, match="scores: nominal terms are accepted by log_likelihood"):
        person_scores(model, np.zeros(len(model.names)), counts, normal_grid([5]))
