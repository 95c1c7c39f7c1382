"""Whether the model fits: silent where it is right, and the right name where it is not."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.stats import kstest, norm

from analysis.diagnostics.checks import (
    BY_PERSON,
    COLUMNS,
    end_counts,
    fit_checks,
    misfits,
    normal_law,
)
from analysis.diagnostics.predicted import predicted_ends
from analysis.diagnostics.residuals import quantile_residuals
from analysis.estimates.realism import realism_of
from analysis.tables.reading import tables_from

sys.path.append(str(Path(__file__).parents[1]))
from chance import most

TAU = np.array([-1.35, -0.25, 0.85, 1.85])


def checked(seed: int, *, scatter: float = 0.0, style: float = 0.0) -> pd.DataFrame:
    """Check the model with leniency alone on 25 people with 24 ratings each."""
    rng = np.random.default_rng(seed)
    who = np.repeat(np.arange(25), 24)
    lod = np.tile(["low", "high", "ultra"], who.size // 3)
    at = pd.Series(lod).map({"low": -0.8, "high": 0.2, "ultra": 0.6}).to_numpy()
    noise = np.exp(scatter * rng.standard_normal(25))[who] * rng.standard_normal(who.size)
    percept = at + 0.5 * rng.standard_normal(25)[who] + noise
    cut = 0.3 + np.exp(style * rng.standard_normal(25))[who][:, None] * (TAU - 0.3)
    rating = 1 + (percept[:, None] > cut).sum(axis=1)
    frame = pd.DataFrame({"participant": [f"p{i}" for i in who], "lod": lod, "rating": rating})
    rows = tables_from({"ratings": frame}).ratings
    realism = realism_of(rows, np.random.default_rng(3), scale=(1, 5))
    residuals = quantile_residuals(realism, np.random.default_rng(1))
    ends = predicted_ends(realism, np.random.default_rng(2))
    return fit_checks(residuals, ends, np.random.default_rng(4))


@pytest.mark.parametrize("studies", [8, pytest.param(150, marks=pytest.mark.long)])
def test_a_right_model_seldom_fails_a_check(studies: int) -> None:
    tables = [checked(seed) for seed in range(studies)]
    assert tuple(tables[0].columns) == COLUMNS
    failed = [not table["fits"].all() for table in tables]
    alone = pd.concat(tables).assign(low=lambda t: t["p"] < 0.05).groupby("check")["low"].mean()
    print(f"{sum(failed)} of {studies} studies fail a check; alone", alone.round(3).to_dict())
    assert np.mean(failed) <= most(studies, 0.05)
    assert alone.max() <= most(studies, 0.07)
    assert misfits(tables[0], "residuals") == []


def test_people_who_scatter_otherwise_are_named() -> None:
    found = checked(3, scatter=0.6)
    assert not found.set_index("check").loc[BY_PERSON, "fits"]
    words = misfits(found, "residuals")
    assert words == ["some people's ratings scatter more, others' less, than it allows for"]


def test_people_who_avoid_the_ends_are_named() -> None:
    found = checked(5, style=0.7)
    words = misfits(found, "predicted shares")
    assert "some people give the lowest rating more often, others less, than it expects" in words


def test_ends_are_counted_together(rng: np.random.Generator) -> None:
    frame = pd.DataFrame(
        {"participant": list("abcdef") * 2, "lod": "low", "rating": [5, 3, 3, 2, 4, 1] * 2}
    )
    rows = tables_from({"ratings": frame}).ratings
    ends = predicted_ends(realism_of(rows, rng, scale=(1, 5)), np.random.default_rng(2))
    given, mean, low, high = end_counts(ends)
    assert given == 2
    assert low <= mean <= high
    assert mean == pytest.approx(2, abs=1)


@pytest.mark.parametrize("count", [8, 160])
def test_the_normal_law_is_judged_as_scipy_judges_it(count: int) -> None:
    rng = np.random.default_rng(count)
    for spread in (0.5, 1.0, 1.3):
        values = spread * rng.standard_normal(count)
        distance, p = normal_law(values)
        expected = kstest(values, norm.cdf)
        assert distance == pytest.approx(expected.statistic, rel=1e-12)
        assert p == pytest.approx(expected.pvalue, abs=0.02)
