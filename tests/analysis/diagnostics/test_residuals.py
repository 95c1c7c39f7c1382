"""Residuals and predicted shares: normal where the model is right, loud where it is wrong."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from scipy.stats import binom, kstest, norm

from analysis.diagnostics.predicted import HIGHEST, LOWEST, predicted_ends, predicted_shares
from analysis.diagnostics.residuals import COLUMNS, quantile_residuals
from analysis.estimates.realism import Realism, realism_of
from analysis.tables.reading import tables_from

TAU = np.array([-1.35, -0.25, 0.85, 1.85])


def study(
    rng: np.random.Generator,
    *,
    people: int = 30,
    each: int = 24,
    sds: tuple[float, float, float] = (0.5, 0.0, 0.0),
) -> pd.DataFrame:
    """Draw ratings of three LoDs by the model itself: leniency, scatter and style."""
    who = np.repeat(np.arange(people), each)
    lod = np.tile(["low", "high", "ultra"], people * each // 3)
    at = pd.Series(lod).map({"low": -0.8, "high": 0.2, "ultra": 0.6}).to_numpy()
    lenient, scatter, style = (sd * rng.standard_normal(people) for sd in sds)
    percept = at + lenient[who] + np.exp(scatter[who]) * rng.standard_normal(who.size)
    cut = 0.3 + np.exp(style[who])[:, None] * (TAU - 0.3)
    rating = 1 + (percept[:, None] > cut).sum(axis=1)
    return pd.DataFrame({"participant": [f"p{i}" for i in who], "lod": lod, "rating": rating})


def fitted(ratings: pd.DataFrame) -> Realism:
    rows = tables_from({"ratings": ratings}).ratings
    return realism_of(rows, np.random.default_rng(3), scale=(1, 5))


def test_residuals_are_normal_where_the_model_is_right(rng: np.random.Generator) -> None:
    ratings = study(rng)
    found = quantile_residuals(fitted(ratings), np.random.default_rng(1))
    assert tuple(found.columns) == COLUMNS
    assert len(found) == len(ratings)
    assert kstest(found["residual"], norm.cdf).pvalue > 0.05
    by_person = found.groupby("participant")["residual"]
    assert by_person.mean().std() == pytest.approx(1 / np.sqrt(24), rel=0.35)
    assert by_person.std().std() == pytest.approx(1 / np.sqrt(2 * 24), rel=0.35)
    means = found.groupby("lod")[["rating", "expected"]].mean()
    assert means["rating"].to_numpy() == pytest.approx(means["expected"].to_numpy(), abs=0.06)


def test_the_same_seed_gives_the_same_residuals(rng: np.random.Generator) -> None:
    realism = fitted(study(rng, people=5))
    again, same, other = (quantile_residuals(realism, np.random.default_rng(s)) for s in (1, 1, 2))
    assert again["residual"].equals(same["residual"])
    assert not same["residual"].equals(other["residual"])


def test_a_residual_lies_between_the_ends_of_its_answer() -> None:
    ratings = pd.DataFrame({"participant": "p", "lod": "low", "rating": [1, 2, 2, 3, 3, 3, 4, 5]})
    realism = fitted(ratings)
    found = quantile_residuals(realism, np.random.default_rng(5))
    cut = realism.fit.model.thresholds(realism.fit.parameters)
    sd = realism.fit.sd("leniency")
    ends = np.concatenate([[-np.inf], cut, [np.inf]])
    for rating, residual in zip(found["rating"], found["residual"], strict=True):
        # Whatever the person's leniency drawn, within 5.5 of its standard deviations.
        assert ends[rating - 1] - 5.5 * sd <= residual <= ends[rating] + 5.5 * sd


def test_without_differences_between_people_the_shares_are_binomial(
    rng: np.random.Generator,
) -> None:
    ratings = study(rng, people=60, sds=(0.0, 0.0, 0.0))
    realism = fitted(ratings)
    found = predicted_shares(realism, np.random.default_rng(2))
    own = found[(found["of"] == "cell") & (found["end"] == HIGHEST)].set_index("lod")
    for lod, place in (("low", -0.8), ("ultra", 0.6)):
        truth = norm.sf(TAU[3] - place)
        count = own.loc[lod, "ratings"]
        low, high = binom.ppf([0.025, 0.975], count, truth) / count
        assert own.loc[lod, "predicted"] == pytest.approx(truth, abs=0.03)
        assert own.loc[lod, "high"] - own.loc[lod, "low"] == pytest.approx(high - low, rel=0.6)
    told = (ratings["rating"] == 5).groupby(ratings["lod"]).mean()
    assert own["share"].to_dict() == pytest.approx(told.to_dict())


def test_people_who_avoid_the_ends_are_not_what_leniency_alone_expects() -> None:
    def p_values(sds: tuple[float, float, float]) -> dict[tuple[str, str], float]:
        ratings = study(np.random.default_rng(8), people=40, each=27, sds=sds)
        ends = predicted_ends(fitted(ratings), np.random.default_rng(2))
        return {(own.of, own.end): own.p_value() for own in ends}

    right, wrong = p_values((0.5, 0.0, 0.0)), p_values((0.5, 0.0, 0.6))
    assert min(right.values()) > 0.05
    assert wrong["person", LOWEST] < 0.01
    assert wrong["person", HIGHEST] < 0.01


def test_one_rating_has_a_residual_and_its_ends() -> None:
    realism = fitted(pd.DataFrame({"participant": ["p"], "lod": ["low"], "rating": [3]}))
    found = quantile_residuals(realism, np.random.default_rng(1))
    assert np.isfinite(found["residual"]).all()
    shares = predicted_shares(realism, np.random.default_rng(1))
    assert len(shares) == 4  # one cell and one person, at both ends
    assert shares["is_within"].all()
