"""Agreement: published worked examples, missing ratings, leniency, degenerate tables."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from scipy.stats import kendalltau

from analysis.reliability.intraclass import intraclass
from analysis.reliability.ordinal_alpha import krippendorff
from analysis.reliability.reliability import person_taus, reliability, tau_b
from analysis.tables.reading import Tables, tables_from

# Shrout and Fleiss 1979, table 2: six targets, four judges.
JUDGES = [[9, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9], [6, 2, 4, 7]]
# Krippendorff 2011, "Computing Krippendorff's alpha-reliability", section C: four observers.
N = np.nan
OBSERVERS = [
    [1, 2, 3, 3, 2, 1, 4, 1, 2, N, N, N],
    [1, 2, 3, 3, 2, 2, 4, 1, 2, 5, N, 3],
    [N, 3, 3, 3, 2, 3, 4, 2, 2, 5, 1, N],
    [1, 2, 3, 3, 2, 4, 4, 1, 2, 5, 1, N],
]


def alpha(table: np.ndarray) -> float:
    rater, unit = np.nonzero(np.isfinite(table))
    return krippendorff(unit, rater, table[rater, unit], np.random.default_rng(1))[0].value


def by_definition(table: np.ndarray) -> float:
    """Return ordinal alpha from the coincidence matrix, value by value."""
    values = np.unique(table[np.isfinite(table)])
    together = np.zeros((len(values), len(values)))
    for unit in table.T:
        own = np.searchsorted(values, unit[np.isfinite(unit)])
        for i in range(len(own)):
            for j in range(len(own)):
                if i != j:
                    together[own[i], own[j]] += 1 / (len(own) - 1)
    n = together.sum(axis=0)
    away = np.zeros_like(together)
    for c in range(len(n)):
        for k in range(c, len(n)):
            away[c, k] = away[k, c] = (n[c : k + 1].sum() - (n[c] + n[k]) / 2) ** 2
    expected = (np.outer(n, n) * away).sum() / (n.sum() - 1)
    return float(1 - (together * away).sum() / expected)


def test_icc_of_the_published_example() -> None:
    one, mean = intraclass(JUDGES)
    assert (one.value, one.low, one.high) == pytest.approx((0.29, 0.02, 0.76), abs=0.005)
    assert (mean.value, mean.low, mean.high) == pytest.approx((0.62, 0.07, 0.93), abs=0.005)


def test_ordinal_alpha_of_the_published_example() -> None:
    assert alpha(np.array(OBSERVERS)) == pytest.approx(0.815, abs=0.0005)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_ordinal_alpha_is_that_of_its_definition(seed: int) -> None:
    rng = np.random.default_rng(seed)
    table = rng.integers(1, 6, (7, 20)) // 2 + rng.integers(0, 3, 20)
    table = np.where(rng.random(table.shape) < 0.4, np.nan, table)
    assert alpha(table) == pytest.approx(by_definition(table))


def test_the_jackknife_is_that_of_leaving_raters_out() -> None:
    rng = np.random.default_rng(4)
    table = np.round(rng.normal(3, 1, 60) + rng.normal(0, 0.7, (9, 60)))
    rater, unit = np.nonzero(np.isfinite(table))
    found = krippendorff(unit, rater, table[rater, unit], rng)[0]
    values = np.array([alpha(np.delete(table, i, axis=0)) for i in range(9)])
    pseudo = 9 * found.value - 8 * values
    half = 2.306 * pseudo.std(ddof=1) / 3
    assert found.high - found.low == pytest.approx(2 * half, rel=0.1)  # ranks are kept, not remade


def test_leniency_lowers_agreement_until_it_is_removed(rng: np.random.Generator) -> None:
    quality, bias = np.array([1, 2, 3, 4, 5, 6]), np.array([-2, -1, 0, 1, 2])
    rows = [
        (f"P{i}", f"L{j}", "near", q + b + 3)
        for i, b in enumerate(bias)
        for j, q in enumerate(quality)
    ]
    frame = pd.DataFrame(rows, columns=["participant", "lod", "distance", "rating"])
    book = {"tables": {"ratings": [{"name": "rating", "accepted": {"lowest": 1, "highest": 11}}]}}
    ratings = tables_from({"ratings": frame}, codebook=book).ratings
    found = reliability(ratings, rng).set_index(["coefficient", "bias"])["value"]
    assert found["ICC(2,1)", "as rated"] < 0.7
    assert found["ICC(2,1)", "bias removed"] == pytest.approx(1.0)
    assert found["alpha, ordinal", "as rated"].iloc[0] < 0.8
    assert found["alpha, ordinal", "bias removed"].iloc[0] == pytest.approx(1.0)


def test_a_persons_tau_leaves_their_own_ratings_out() -> None:
    rows = [(who, lod, r) for who in "ABC" for lod, r in zip("abcd", (1, 2, 3, 4), strict=True)]
    rows += [("X", lod, r) for lod, r in zip("abcd", (4, 3, 2, 1), strict=True)]
    rows += [("Y", lod, 3) for lod in "abcd"]
    ratings = tables_from(
        {"ratings": pd.DataFrame(rows, columns=["participant", "lod", "rating"])}
    ).ratings
    taus = person_taus(ratings).set_index("participant")["tau_b"]
    assert taus[["A", "B", "C", "X"]].tolist() == pytest.approx([1, 1, 1, -1])
    assert np.isnan(taus["Y"])


def test_the_thesiss_study_has_every_coefficient(thesis_tables: Tables) -> None:
    found = reliability(thesis_tables.ratings, np.random.default_rng(1))
    assert found["value"].between(0.2, 1.0).all()
    assert (found["low"] < found["value"]).all()
    assert (found["value"] < found["high"]).all()
    assert found["people"].max() == 10


@pytest.mark.parametrize("given", [[], [("A", "low", 3)], [(p, "low", 3) for p in "ABCD"]])
def test_where_nothing_can_be_told_every_value_is_empty(given: list[tuple[str, str, int]]) -> None:
    frame = pd.DataFrame(given, columns=["participant", "lod", "rating"])
    ratings = tables_from({"ratings": frame}).ratings
    assert reliability(ratings, np.random.default_rng(1))["value"].isna().all()


def test_tau_b_is_that_of_scipy(rng: np.random.Generator) -> None:
    x, y = rng.integers(1, 6, 40).astype(float), rng.integers(1, 6, 40).astype(float)
    assert tau_b(x, y) == pytest.approx(float(kendalltau(x, y).statistic))
    assert np.isnan(tau_b(x, np.ones(40)))
