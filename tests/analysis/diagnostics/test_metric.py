"""The metric model beside statsmodels' MixedLM, and what its density becomes as a probability."""

from __future__ import annotations

import warnings

import numpy as np
import pandas as pd
import pytest
from scipy.stats import multivariate_normal, norm
from statsmodels.regression.mixed_linear_model import MixedLM

from analysis.diagnostics.metric import as_ordinal, fit_metric, sums_of
from analysis.models.counts import Counts, count_answers
from analysis.models.likelihood import log_likelihood
from analysis.models.ordinal import LENIENCY, OrdinalModel
from analysis.models.predictors import Linear
from analysis.models.quadrature import normal_grid


def rated(seed: int, *, people: int = 15, sd: float = 0.6) -> tuple[pd.DataFrame, Counts]:
    rng = np.random.default_rng(seed)
    rows = pd.DataFrame(
        {"who": np.repeat(np.arange(people), 12), "what": np.tile(np.arange(3), 4 * people)}
    )
    percept = 2.4 + 0.7 * rows["what"] + sd * rng.standard_normal(people)[rows["who"]]
    percept = percept + 0.8 * rng.standard_normal(len(rows))
    rows["rating"] = percept.round().clip(1, 5).astype(int)
    rows = rows[rng.random(len(rows)) < 0.9]  # not everybody rated everything
    shape = (people, 3, 5)
    return rows, count_answers(rows["who"], rows["what"], rows["rating"] - 1, shape=shape)


DESIGN = np.column_stack([np.ones(3), np.eye(3)[:, 1:]])


@pytest.mark.parametrize("sd", [0.6, 0.0])
def test_it_is_statsmodels_mixed_model(sd: float) -> None:
    rows, counts = rated(3, sd=sd)
    found = fit_metric(sums_of(counts, DESIGN))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # MixedLM warns of a spread of 0
        peer = MixedLM(rows["rating"], DESIGN[rows["what"]], groups=rows["who"]).fit(reml=False)
    assert -1e-4 < found.log_likelihood - peer.llf < 2e-3  # near 0 MixedLM stops a little early
    assert found.means == pytest.approx(np.asarray(peer.fe_params), abs=1e-3)
    assert found.sd**2 == pytest.approx(peer.scale, rel=2e-3)
    assert found.sd_people**2 == pytest.approx(float(peer.cov_re.iloc[0, 0]), abs=2e-3)
    assert found.parameters == 5


def test_weights_count_people_several_times() -> None:
    _, counts = rated(4, people=6)
    twice = Counts(np.concatenate([counts.table, counts.table[:2]]))
    weights = np.array([2.0, 2.0, 1.0, 1.0, 1.0, 1.0])
    weighted = fit_metric(sums_of(counts, DESIGN, weights=weights))
    assert weighted.log_likelihood == pytest.approx(
        fit_metric(sums_of(twice, DESIGN)).log_likelihood
    )
    without = fit_metric(sums_of(counts, DESIGN).without(np.array([0, 1])))
    assert without.means == pytest.approx(
        fit_metric(sums_of(Counts(counts.table[2:]), DESIGN)).means
    )


def test_a_rating_stands_for_all_that_is_rounded_to_it() -> None:
    _, counts = rated(5, people=1)
    found = fit_metric(sums_of(counts, DESIGN))
    model = OrdinalModel(Linear(DESIGN[:, 1:], ("b", "c")), effects=(LENIENCY,))
    value = log_likelihood(model, as_ordinal(found, model), counts, normal_grid([81]))[0]
    means, total = DESIGN @ found.means, np.hypot(found.sd, found.sd_people)
    if found.sd_people > 1e-6:  # one person's ratings hang together: then not as simple
        pytest.fail("the example should have no spread of people")
    ends = np.concatenate([[-np.inf], np.arange(1.5, 5), [np.inf]])
    mass = np.diff(norm.cdf((ends - means[:, None]) / total), axis=1)
    assert value == pytest.approx(float((counts.table[0] * np.log(mass)).sum()))


def test_two_ratings_of_one_person_hang_together_as_a_normal_law_says() -> None:
    _, counts = rated(6)
    found = fit_metric(sums_of(counts, DESIGN))
    pair = count_answers([0, 0], [0, 2], [2, 3], shape=(1, 3, 5))
    model = OrdinalModel(Linear(DESIGN[:, 1:], ("b", "c")), effects=(LENIENCY,))
    value = log_likelihood(model, as_ordinal(found, model), pair, normal_grid([161]))[0]
    both = found.sd_people**2
    law = multivariate_normal(
        (DESIGN @ found.means)[[0, 2]],
        np.array([[both, both], [both, both]]) + np.eye(2) * found.sd**2,
    )
    mass = law.cdf([3.5, 4.5], lower_limit=[2.5, 3.5])
    assert np.exp(value) == pytest.approx(mass, abs=1e-4)


def test_constant_ratings_have_a_likelihood_all_the_same() -> None:
    counts = count_answers([0, 1, 2], [0, 1, 2], [2, 2, 2], shape=(3, 3, 5))
    found = fit_metric(sums_of(counts, DESIGN))
    assert np.isfinite(found.log_likelihood)
    assert found.means[0] == pytest.approx(3.0)
