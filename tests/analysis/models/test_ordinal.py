"""The ordinal model: its gradient, its probabilities, its names."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ndtr

from analysis.models.counts import count_answers
from analysis.models.likelihood import cells, log_likelihood
from analysis.models.links import LOGIT, PROBIT, Link
from analysis.models.ordinal import PERSON_EFFECTS, OrdinalModel
from analysis.models.predictors import Contrasted, Linear
from analysis.models.quadrature import normal_grid


def random_model(
    rng: np.random.Generator, link: Link, categories: int, *, has_nominal: bool = False
) -> OrdinalModel:
    own = {"nominal": rng.normal(size=(6, 2)), "nominal_terms": ("x", "y")} if has_nominal else {}
    return OrdinalModel(
        Contrasted(rng.normal(size=(6, 3)), rng.normal(size=(6, 3)), ("a", "b", "c")),
        categories,
        PERSON_EFFECTS,
        link,
        scale=rng.normal(size=(6, 1)),
        scale_terms=("group",),
        **own,
    )


@pytest.mark.parametrize("link", [PROBIT, LOGIT])
@pytest.mark.parametrize("categories", [3, 4, 5])
@pytest.mark.parametrize("has_nominal", [False, True])
def test_the_gradient_is_that_of_finite_differences(
    link: Link, categories: int, has_nominal: bool
) -> None:
    rng = np.random.default_rng(7)
    model = random_model(rng, link, categories, has_nominal=has_nominal)
    counts = count_answers(
        rng.integers(7, size=200),
        rng.integers(6, size=200),
        rng.integers(categories, size=200),
        shape=(7, 6, categories),
    )
    grid, weights = normal_grid([9, 7, 5]), rng.uniform(0, 2, size=7)
    at = 0.4 * rng.normal(size=len(model.names))

    def value(parameters: np.ndarray) -> float:
        return log_likelihood(model, parameters, counts, grid, weights=weights)[0]

    steps = np.eye(len(at)) * 1e-5
    numeric = np.array([(value(at + e) - value(at - e)) / 2e-5 for e in steps])
    gradient = log_likelihood(model, at, counts, grid, weights=weights)[1]
    assert gradient == pytest.approx(numeric, abs=1e-6 * np.abs(numeric).max())


def test_probabilities_are_those_of_the_written_formula() -> None:
    rng = np.random.default_rng(3)
    model = random_model(rng, PROBIT, 5)
    at = 0.3 * rng.normal(size=len(model.names))
    grid = normal_grid([5, 3, 3])
    names = dict(zip(model.names, at, strict=True))
    means = np.array([names[term] for term in "abc"])
    assert isinstance(model.predictor, Contrasted)
    own, other = model.predictor.design @ means, model.predictor.beside @ means
    eta = own + names["contrast"] * (own - other)
    tau = names["threshold_1"] + np.cumsum(
        [0.0, *(np.exp(names[f"log_step_{k}"]) for k in (2, 3, 4))]
    )
    b, v, u = (
        np.exp(names[f"log_sd:{effect}"]) * row
        for effect, row in zip(PERSON_EFFECTS, grid.nodes, strict=True)
    )
    middle = (tau[1] + tau[2]) / 2
    for s in range(6):
        for q in (0, 17, 44):
            cut = middle + np.exp(u[q]) * (tau - middle)
            noise = np.exp(model.scale[s, 0] * names["scale:group"] + v[q])
            below = np.array([0.0, *ndtr((cut - eta[s] - b[q]) / noise), 1.0])
            found = np.exp(cells(model, at, grid).log_p[s, :, q])
            assert found == pytest.approx(np.diff(below), abs=1e-12)


def test_many_people_are_added_up_in_blocks() -> None:
    rng = np.random.default_rng(5)
    model = OrdinalModel(Linear(np.array([[0.0], [1.0]]), ("high",)))
    n = 30_000
    counts = count_answers(
        np.arange(n), rng.integers(2, size=n), rng.integers(5, size=n), shape=(n, 2, 5)
    )
    at = np.array([-1.0, 0.0, 0.1, -0.2, 0.5, -0.7])
    value, gradient = log_likelihood(model, at, counts, normal_grid([81]))
    # One answer each: people who gave the same answer to the same stimulus are alike.
    kinds = counts.table.sum(axis=0)
    alike = count_answers(np.arange(10), np.repeat([0, 1], 5), [*range(5)] * 2, shape=(10, 2, 5))
    weights = kinds.ravel()
    again = log_likelihood(model, at, alike, normal_grid([81]), weights=weights)
    assert value == pytest.approx(again[0], rel=1e-12)
    assert gradient == pytest.approx(again[1], rel=1e-9)


def test_faulty_models_are_refused() -> None:
    with pytest.raises(ValueError, match=r"effects: unknown \['mood'\]; choose of"):
        OrdinalModel(Linear(np.zeros((3, 1)), ("a",)), effects=("mood",))
    with pytest.raises(ValueError, match="categories: at least 2, found 1"):
        OrdinalModel(Linear(np.zeros((3, 1)), ("a",)), 1)
