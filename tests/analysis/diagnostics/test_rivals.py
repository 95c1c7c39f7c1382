"""Models compared: R's log-likelihood and AIC, and people left out in earnest."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analysis.diagnostics.left_out import left_out
from analysis.diagnostics.rivals import (
    A0,
    ALIKE,
    COLUMNS,
    EXPANSION,
    LOGISTIC,
    METRIC,
    REFITS,
    A,
    rivals,
)
from analysis.estimates.realism import Realism, realism_of
from analysis.models.counts import Counts
from analysis.models.fitting import fit
from analysis.models.likelihood import log_likelihood
from analysis.models.priors import PRIORS
from analysis.models.quadrature import normal_grid
from analysis.tables.reading import Tables, tables_from

sys.path.append(str(Path(__file__).parents[1] / "models"))
from peers import ask_r


def fitted(ratings: pd.DataFrame) -> Realism:
    rows = tables_from({"ratings": ratings}).ratings
    return realism_of(rows, np.random.default_rng(3), scale=(1, 5))


@pytest.mark.peer
def test_wine_has_the_log_likelihood_and_aic_that_r_finds() -> None:
    wine = ask_r(
        "f <- clm(rating ~ temp * contact, data = wine, link = 'probit')\n"
        "g <- clmm2(rating ~ temp * contact, random = judge, data = wine, Hess = TRUE,"
        " nAGQ = 10, link = 'probit')\n"
        "h <- clmm2(rating ~ temp * contact, random = judge, data = wine, nAGQ = 10)\n"
        "wine$logit <- logLik(h); wine$alike <- logLik(f); wine$alike_aic <- AIC(f)\n"
        "wine$judges <- logLik(g); wine$judges_aic <- AIC(g); write.csv(wine)"
    )
    lods = wine[["temp", "contact"]].agg("-".join, axis=1)
    people = "judge " + wine["judge"].astype(str)
    ratings = pd.DataFrame({"participant": people, "lod": lods, "rating": wine["rating"]})
    found = rivals(fitted(ratings)).set_index("model")
    assert found.loc[ALIKE, "log_likelihood"] == pytest.approx(wine["alike"][0], abs=1e-3)
    assert found.loc[ALIKE, "aic"] == pytest.approx(wine["alike_aic"][0], abs=2e-3)
    assert found.loc[A0, "log_likelihood"] == pytest.approx(wine["judges"][0], abs=1e-3)
    assert found.loc[A0, "aic"] == pytest.approx(wine["judges_aic"][0], abs=2e-3)
    assert found.loc[LOGISTIC, "log_likelihood"] == pytest.approx(wine["logit"][0], abs=2e-3)
    assert np.isnan(found.loc[LOGISTIC, "left_out"])
    assert found.loc[A, "log_likelihood"] >= found.loc[A0, "log_likelihood"] - 0.02


def test_the_thesis_s_study_is_compared(thesis_tables: Tables) -> None:
    realism = realism_of(thesis_tables.ratings, np.random.default_rng(1), scale=(1, 5))
    table = rivals(realism)
    assert tuple(table.columns) == COLUMNS
    found = table.set_index("model")
    assert list(found.index) == [ALIKE, A0, A, LOGISTIC, METRIC]
    assert found["is_reported"].tolist() == [False, True, False, False, False]
    assert found.loc[A0, "left_out_difference"] == 0.0
    assert found["aic"].to_numpy() == pytest.approx(
        (2 * found["parameters"] - 2 * found["log_likelihood"]).to_numpy(dtype=float)
    )
    assert found["aic_difference"].min() == 0.0
    foretold = found.drop(index=LOGISTIC)
    assert (foretold["left_out"] < foretold["log_likelihood"]).all()
    assert (foretold["left_out_by"] == REFITS).all()
    assert np.isnan(found.loc[LOGISTIC, "left_out"])
    assert found.loc[LOGISTIC, "left_out_by"] == ""
    assert found.loc[LOGISTIC, "log_likelihood"] == pytest.approx(
        found.loc[A0, "log_likelihood"], abs=3.0
    )
    assert found.loc[A, "log_likelihood"] > found.loc[A0, "log_likelihood"] - 0.05
    assert found.loc[A0, "log_likelihood"] > found.loc[ALIKE, "log_likelihood"] - 1e-3


def test_whoever_is_left_out_is_foretold_by_the_others_alone(thesis_tables: Tables) -> None:
    realism = realism_of(thesis_tables.ratings, np.random.default_rng(1), scale=(1, 5))
    logs = left_out(realism.fit)
    table = realism.fit.counts.table
    for person in (0, 4):
        others = fit(realism.fit.model, Counts(np.delete(table, person, axis=0)), priors=PRIORS)
        own = Counts(table[person : person + 1])
        again = log_likelihood(others.model, others.parameters, own, normal_grid([101]))[0]
        assert logs[person] == pytest.approx(again, abs=5e-3)


def test_of_many_people_a_step_does_what_a_fit_does(
    rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch
) -> None:
    who = np.repeat(np.arange(36), 24)
    lod = np.tile(["low", "high", "ultra"], who.size // 3)
    place = pd.Series(lod).map({"low": 2.0, "high": 3.1, "ultra": 3.6}).to_numpy()
    percept = place + 0.6 * rng.standard_normal(36)[who] + rng.standard_normal(who.size)
    ratings = pd.DataFrame(
        {
            "participant": [f"p{i}" for i in who],
            "lod": lod,
            "rating": percept.round().clip(1, 5).astype(int),
        }
    )
    realism = fitted(ratings)
    exact = left_out(realism.fit)
    monkeypatch.setattr("analysis.diagnostics.left_out.MOST_REFITS", 10)
    near = left_out(realism.fit)
    assert near.sum() == pytest.approx(exact.sum(), abs=0.5)
    assert np.abs(near - exact).max() < 0.25
    monkeypatch.setattr("analysis.diagnostics.left_out._MOST_SCORED", 18)
    some = left_out(realism.fit)
    assert some[:18] == pytest.approx(near[:18])
    assert some.sum() == pytest.approx(near.sum(), abs=1.5)


def test_people_who_differ_are_told_from_people_alike(rng: np.random.Generator) -> None:
    who = np.repeat(np.arange(45), 12)
    lod = np.tile(["low", "ultra"], who.size // 2)
    percept = np.where(lod == "ultra", 3.6, 2.4) + 1.0 * rng.standard_normal(45)[who]
    percept = percept + 0.7 * rng.standard_normal(who.size)
    ratings = pd.DataFrame(
        {
            "participant": [f"p{i}" for i in who],
            "lod": lod,
            "rating": percept.round().clip(1, 5).astype(int),
        }
    )
    found = rivals(fitted(ratings)).set_index("model")
    assert found.loc[ALIKE, "aic_difference"] > 50
    assert found.loc[ALIKE, "left_out_difference"] < -2 * found.loc[ALIKE, "left_out_error"]
    assert found.loc[ALIKE, "left_out_by"] == EXPANSION
    # Rounded metres: the metric model is the truth here, and no worse than the ordinal one.
    assert abs(found.loc[METRIC, "left_out_difference"]) < 8


@pytest.mark.parametrize("people", [1, 2])
def test_too_few_people_are_not_left_out(people: int) -> None:
    rows = [(f"p{i}", lod, 3) for i in range(people) for lod in ("low", "ultra")]
    found = rivals(fitted(pd.DataFrame(rows, columns=["participant", "lod", "rating"])))
    assert found["left_out"].isna().all()
    assert np.isfinite(found["log_likelihood"].astype(float)).all()
