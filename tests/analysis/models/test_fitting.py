"""Fits beside other programs, closed forms and known truths."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.special import ndtri
from statsmodels.miscmodels.ordinal_model import OrderedModel

from analysis.models.counts import Counts, count_answers
from analysis.models.fitting import fit
from analysis.models.likelihood import log_likelihood
from analysis.models.links import LOGIT, PROBIT, Link
from analysis.models.ordinal import LENIENCY, PERSON_EFFECTS, OrdinalModel
from analysis.models.predictors import Linear
from analysis.models.priors import PRIORS
from analysis.models.quadrature import normal_grid

sys.path.append(str(Path(__file__).parent))
from peers import ask_r

TAU = np.array([-1.35, -0.25, 0.85, 1.85])


def rated(
    rng: np.random.Generator, *, people: int, each: int, sds: tuple[float, float, float]
) -> tuple[OrdinalModel, Counts, np.ndarray]:
    """Draw ratings of six cells seen on either side; the truth is the model itself."""
    cell = np.tile(np.eye(6), (2, 1))
    location = np.column_stack([cell[:, 1:], np.repeat([0.0, 1.0], 6)])
    truth = np.array([0.6, 1.0, 1.4, -0.5, 0.3, 0.1])
    who = np.repeat(np.arange(people), each)
    what = rng.integers(12, size=who.size)
    b, v, u = (sd * rng.standard_normal(people) for sd in sds)
    middle = (TAU[1] + TAU[2]) / 2
    percept = (location @ truth)[what] + b[who] + np.exp(v[who]) * rng.standard_normal(who.size)
    cut = middle + np.exp(u[who])[:, None] * (TAU - middle)
    answer = (percept[:, None] > cut).sum(axis=1)
    terms = ("c1", "c2", "c3", "c4", "c5", "right")
    counts = count_answers(who, what, answer, shape=(people, 12, 5))
    return OrdinalModel(Linear(location, terms)), counts, truth


@pytest.mark.peer
@pytest.mark.parametrize("link", [PROBIT, LOGIT])
def test_wine_is_fitted_as_r_fits_it(link: Link) -> None:
    wine = ask_r(
        "f <- clmm2(rating ~ temp + contact, random = judge, data = wine, Hess = TRUE,"
        f' nAGQ = 10, link = "{ {"probit": "probit", "logit": "logistic"}[link.name] }")\n'
        "se <- sqrt(diag(solve(f$Hessian)))\n"
        "wine$logLik <- logLik(f); wine$sd <- f$stDev; wine$beta <- f$beta[1]\n"
        "wine$se <- se[5]; wine$theta4 <- f$Theta[4]; write.csv(wine)"
    )
    kinds, what = np.unique(wine[["temp", "contact"]].agg(" ".join, axis=1), return_inverse=True)
    location = np.array([["warm" in kind, "yes" in kind] for kind in kinds], dtype=float)
    counts = count_answers(wine["judge"] - 1, what, wine["rating"] - 1, shape=(9, 4, 5))
    found = fit(OrdinalModel(Linear(location, ("temp", "contact")), link=link), counts)
    own = wine.iloc[0]
    assert found.log_likelihood == pytest.approx(own["logLik"], abs=1e-5)
    assert found.sd(LENIENCY) == pytest.approx(own["sd"], abs=1e-3)
    assert found.value("temp") == pytest.approx(own["beta"], abs=1e-3)
    assert found.standard_error("temp") == pytest.approx(own["se"], abs=1e-3)
    assert found.model.thresholds(found.parameters)[3] == pytest.approx(own["theta4"], abs=1e-3)


@pytest.mark.peer
def test_soup_is_fitted_as_r_fits_it() -> None:
    soup = ask_r(
        "s <- subset(soup, !is.na(SURENESS))\n"
        'f <- clm(SURENESS ~ PRODID, scale = ~ PROD, data = s, link = "probit")\n'
        "d <- data.frame(resp = as.integer(s$RESP), product = as.integer(s$PRODID),"
        " prod = as.integer(s$PROD), sure = as.integer(s$SURENESS), logLik = logLik(f),"
        " last = f$beta[5], scale = f$zeta[1])\nwrite.csv(d)"
    )
    kinds, what = np.unique(soup[["product", "prod"]], axis=0, return_inverse=True)
    location = (kinds[:, :1] == np.arange(2, 7)).astype(float)
    model = OrdinalModel(
        Linear(location, tuple(f"product {k}" for k in range(2, 7))),
        6,
        effects=(),
        scale=(kinds[:, 1:] == 2).astype(float),
        scale_terms=("test",),
    )
    counts = count_answers(
        soup["resp"] * 0, what.ravel(), soup["sure"] - 1, shape=(1, len(kinds), 6)
    )
    found = fit(model, counts)
    own = soup.iloc[0]
    assert found.log_likelihood == pytest.approx(own["logLik"], abs=1e-4)
    assert found.value("product 6") == pytest.approx(own["last"], abs=1e-3)
    assert found.value("scale:test") == pytest.approx(own["scale"], abs=1e-3)


@pytest.mark.parametrize("link", [PROBIT, LOGIT])
def test_without_person_effects_it_is_statsmodels_model(link: Link) -> None:
    rng = np.random.default_rng(11)
    model, counts, truth = rated(rng, people=1, each=600, sds=(0.0, 0.0, 0.0))
    plain = OrdinalModel(model.predictor, effects=(), link=link)
    found = fit(plain, counts)
    rows = np.argwhere(counts.table > 0)
    often = counts.table[tuple(rows.T)].astype(int)
    what, answer = np.repeat(rows[:, 1], often), np.repeat(rows[:, 2], often)
    peer = OrderedModel(answer, model.predictor.jacobian(truth)[what], distr=link.name).fit(
        method="bfgs", disp=False, gtol=1e-8, maxiter=500
    )
    assert found.log_likelihood == pytest.approx(peer.llf, abs=1e-6)
    own = [found.value(term) for term in model.predictor.names]
    assert own == pytest.approx(peer.params[:6], abs=2e-4)
    errors = [found.standard_error(term) for term in model.predictor.names]
    assert errors == pytest.approx(peer.bse[:6], rel=2e-3)


def test_two_categories_and_no_terms_give_the_share() -> None:
    counts = Counts(np.array([[[30.0, 70.0]]]))
    found = fit(OrdinalModel(Linear(np.zeros((1, 0)), ()), 2, effects=()), counts)
    assert found.value("threshold_1") == pytest.approx(ndtri(0.3))
    p, density = 0.3, np.exp(-(ndtri(0.3) ** 2) / 2) / np.sqrt(2 * np.pi)
    assert found.standard_error("threshold_1") == pytest.approx(
        np.sqrt(p * (1 - p) / 100) / density, rel=1e-5
    )


def test_the_grid_is_refined_until_it_no_longer_matters() -> None:
    rng = np.random.default_rng(2)
    model, counts, _ = rated(rng, people=12, each=300, sds=(0.9, 0.0, 0.0))
    found = fit(model, counts)
    again = fit(model, counts, grid=normal_grid([801]))
    assert found.log_likelihood == pytest.approx(again.log_likelihood, abs=2e-3)
    assert found.sd(LENIENCY) == pytest.approx(again.sd(LENIENCY), rel=1e-3)
    coarse = fit(model, counts, grid=normal_grid([9]))
    assert abs(coarse.log_likelihood - again.log_likelihood) > 0.1  # so it mattered
    assert found.warnings == ()


def test_known_parameters_come_back() -> None:
    rng = np.random.default_rng(6)
    model, counts, truth = rated(rng, people=150, each=60, sds=(0.45, 0.25, 0.2))
    full = OrdinalModel(model.predictor, effects=PERSON_EFFECTS)
    found = fit(full, counts, grid=normal_grid([41, 9, 9]))
    for name, true in zip(model.predictor.names, truth, strict=True):
        assert abs(found.value(name) - true) < 3.5 * found.standard_error(name)
    assert [found.sd(effect) for effect in PERSON_EFFECTS] == pytest.approx(
        [0.45, 0.25, 0.2], abs=0.07
    )


def test_priors_keep_a_separated_cell_finite() -> None:
    table = np.zeros((4, 2, 5))
    table[:, 0, 0] = table[:, 1, 4] = 3  # everyone: the one always 1, the other always 5
    found = fit(
        OrdinalModel(Linear(np.array([[0.0], [1.0]]), ("high",))), Counts(table), priors=PRIORS
    )
    assert 1.0 < found.value("high") < 8.0
    assert np.isfinite(found.standard_error("high"))


def test_what_the_data_cannot_say_is_told() -> None:
    table = np.zeros((4, 2, 2))
    table[:, 0, 0] = table[:, 1, 1] = 3
    model = OrdinalModel(Linear(np.array([[0.0], [1.0]]), ("high",)), 2, effects=())
    found = fit(model, Counts(table))
    assert found.warnings == ("the data leave some parameters without an upper or lower bound",)


def test_faulty_counts_are_refused() -> None:
    model = OrdinalModel(Linear(np.array([[0.0], [1.0]]), ("high",)))
    with pytest.raises(ValueError, match="2 stimuli and 5 categories; found 3 and 5"):
        fit(model, Counts(np.ones((1, 3, 5))))
    with pytest.raises(ValueError, match="no answer was given"):
        fit(model, Counts(np.zeros((3, 2, 5))))
    table = np.ones((3, 2, 5))
    table[:, :, 4] = 0
    with pytest.raises(ValueError, match="nobody used category 5; merge it"):
        fit(model, Counts(table))
    assert fit(model, Counts(table), priors=PRIORS).value("log_step_4") > -3


def test_an_unknown_parameter_is_named() -> None:
    found = fit(
        OrdinalModel(Linear(np.zeros((1, 0)), ()), 2, effects=()), Counts(np.ones((1, 1, 2)))
    )
    with pytest.raises(KeyError, match="no parameter high; there are threshold_1"):
        found.value("high")


def test_a_table_of_a_bootstrap_is_that_of_repeated_people() -> None:
    rng = np.random.default_rng(9)
    model, counts, _ = rated(rng, people=8, each=40, sds=(0.5, 0.0, 0.0))
    weights = np.array([2.0, 0, 1, 1, 3, 0, 1, 0])
    first = fit(model, counts, weights=weights, priors=PRIORS)
    repeated = Counts(np.repeat(counts.table, weights.astype(int), axis=0))
    second = fit(model, repeated, priors=PRIORS, grid=first.grid)
    assert first.parameters == pytest.approx(second.parameters, abs=1e-5)
    assert pd.Series(first.model.names).is_unique


def test_a_grid_in_three_directions_is_as_fine_as_it_must_be() -> None:
    rng = np.random.default_rng(21)
    model, counts, _ = rated(rng, people=15, each=60, sds=(0.6, 0.25, 0.3))
    full = OrdinalModel(model.predictor, effects=PERSON_EFFECTS)
    found = fit(full, counts, priors=PRIORS)
    finer = normal_grid([101, 41, 41], reach=[5.5, 4.0, 4.0])
    exact = log_likelihood(full, found.parameters, counts, finer)[0]
    assert found.log_likelihood == pytest.approx(exact, abs=0.05)
    assert found.grid.log_weights.size < 3000  # of the finer one's 169 781


def test_steps_from_a_fit_nearby_lead_to_the_same_place() -> None:
    rng = np.random.default_rng(22)
    model, counts, _ = rated(rng, people=12, each=40, sds=(0.5, 0.0, 0.0))
    whole = fit(model, counts, priors=PRIORS)
    without_first = np.array([0.0, *[1.0] * 11])
    near = fit(model, counts, priors=PRIORS, weights=without_first, near=whole)
    anew = fit(model, counts, priors=PRIORS, weights=without_first)
    assert near.parameters == pytest.approx(anew.parameters, abs=2e-4)
    assert np.diag(near.covariance) == pytest.approx(np.diag(anew.covariance), rel=2e-3)
    assert np.abs(near.parameters - whole.parameters).max() > 0.02  # so there was a way to go
    other = fit(OrdinalModel(model.predictor, effects=()), counts, near=whole)
    assert other.model.effects == ()  # of other parameters, hence no help and no harm
