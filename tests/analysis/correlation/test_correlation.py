"""Correlations with repeated measures: against scipy, least squares and published data."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from analysis.correlation import (
    count_pairs,
    mean_tau,
    person_concordance,
    rank_correlations,
    repeated_measures_correlation,
    tau_p,
)
from analysis.tables.reading import tables_from

# Bland and Altman, BMJ 1995;310:446, table 1: intramural pH and PaCO2 of eight people.
BLAND = (
    ((6.68, 6.53, 6.43, 6.33), (3.97, 4.12, 4.09, 3.97)),
    ((6.85, 7.06, 7.13, 7.17), (5.27, 5.37, 5.41, 5.44)),
    (
        (7.40, 7.42, 7.41, 7.37, 7.34, 7.35, 7.28, 7.30, 7.34),
        (5.67, 3.64, 4.32, 4.73, 4.96, 5.04, 5.22, 4.82, 5.07),
    ),
    ((7.36, 7.33, 7.29, 7.30, 7.35), (5.67, 5.10, 5.53, 4.75, 5.51)),
    (
        (7.35, 7.30, 7.30, 7.37, 7.27, 7.28, 7.32, 7.32),
        (4.28, 4.44, 4.32, 3.23, 4.46, 4.72, 4.75, 4.99),
    ),
    ((7.38, 7.30, 7.29, 7.33, 7.31, 7.33), (4.78, 4.73, 5.12, 4.93, 5.03, 4.93)),
    ((6.86, 6.94, 6.92), (6.85, 6.44, 6.52)),
    (
        (7.19, 7.29, 7.21, 7.25, 7.20, 7.19, 6.77, 6.82),
        (5.28, 4.56, 4.34, 4.32, 4.41, 3.69, 6.09, 5.58),
    ),
)


def ratings_from(rows: list[tuple[str, str, str, int | None]]) -> pd.DataFrame:
    frame = pd.DataFrame(rows, columns=["participant", "distance", "lod", "rating"])
    return tables_from({"ratings": frame}).ratings


def test_tau_b_and_somers_d_agree_with_scipy(rng: np.random.Generator) -> None:
    person = np.repeat(np.arange(50), 8)
    x, y = rng.integers(1, 5, 400), rng.integers(1, 6, 400)
    pairs = count_pairs(person, x, y)
    for k in range(50):
        own = person == k
        assert pairs.tau_b[k] == pytest.approx(stats.kendalltau(x[own], y[own]).statistic)
        assert pairs.somers_d[k] == pytest.approx(stats.somersd(x[own], y[own]).statistic)


def test_pairs_by_hand() -> None:
    """Ranks 1 2 2 4 rated 1 3 2 2: 1-2 up twice, 1-4 up, 2-2 same rank, 2-4 down and tied."""
    pairs = count_pairs([0] * 4, [1, 2, 2, 4], [1, 3, 2, 2])
    found = (pairs.concordant, pairs.discordant, pairs.tied_in_rating, pairs.tied_in_rank)
    assert [field.tolist() for field in found] == [[3], [1], [1], [1]]


def test_ratings_all_alike_have_no_tau_but_a_somers_d_of_zero() -> None:
    pairs = count_pairs([0, 0], [1, 4], [3, 3])
    assert np.isnan(pairs.tau_b).all()
    assert pairs.somers_d.tolist() == [0.0]


def test_no_ratings_have_no_pairs() -> None:
    assert count_pairs([], [], []).tau_b.size == 0


def test_repeated_measures_correlation_of_bland_and_altman() -> None:
    person = np.repeat(np.arange(8), [len(ph) for ph, _ in BLAND])
    ph, co2 = (np.concatenate([own[k] for own in BLAND]) for k in (0, 1))
    r, low, high, dof = repeated_measures_correlation(person, ph, co2)
    assert dof == 38
    assert r == pytest.approx(-0.507, abs=5e-4)
    assert low < r < high < 0


def test_repeated_measures_correlation_agrees_with_least_squares(
    rng: np.random.Generator,
) -> None:
    """r^2 = SSx / (SSx + SSe) from two nested regressions with one intercept per person."""
    person = np.repeat(np.arange(6), [3, 5, 2, 4, 1, 6])
    x = rng.integers(1, 5, person.size).astype(float)
    y = 0.4 * x + person + rng.standard_normal(person.size)
    intercepts = (person[:, None] == np.arange(6)).astype(float)
    slope, *_ = np.linalg.lstsq(np.c_[x, intercepts], y)[0]

    def error(design: np.ndarray) -> float:
        return float(((y - design @ np.linalg.lstsq(design, y)[0]) ** 2).sum())

    full, none = error(np.c_[x, intercepts]), error(intercepts)
    wanted = np.sign(slope) * np.sqrt((none - full) / none)
    assert repeated_measures_correlation(person, x, y)[0] == pytest.approx(wanted)


def test_mean_tau_with_equal_weights_is_the_t_interval_of_z() -> None:
    tau = np.array([0.2, 0.5, 0.7, -0.1])
    z = np.arctanh(tau)
    wanted = np.tanh(stats.t.interval(0.95, 3, loc=z.mean(), scale=stats.sem(z)))
    mean, low, high = mean_tau(tau, [9, 9, 9, 9])
    assert mean == pytest.approx(np.tanh(z.mean()))
    assert (low, high) == pytest.approx(tuple(wanted))


def test_people_with_more_untied_pairs_weigh_more() -> None:
    assert mean_tau([0.0, 0.6], [1, 100])[0] > mean_tau([0.0, 0.6], [1, 1])[0]


def test_a_perfect_tau_stays_finite() -> None:
    """One pair in order says little: it counts as 1 / 2."""
    assert mean_tau([1.0], [1])[0] == pytest.approx(0.5)
    assert np.isfinite(mean_tau([1.0, -1.0, 1.0], [1, 1, 1])).all()


def test_nobody_gives_no_correlation() -> None:
    assert np.isnan(mean_tau([], [])).all()
    assert np.isnan(mean_tau([np.nan], [0])).all()
    assert np.isnan(repeated_measures_correlation([], [], [])[:3]).all()


def test_everyone_is_listed_also_without_spread() -> None:
    rows = [("A", "near", "low", 3), ("A", "near", "ultra", 3)]
    rows += [("B", "near", "low", 1), ("B", "near", "ultra", 4)]
    people = person_concordance(ratings_from(rows))
    near = people[people["distance"] == "near"]
    assert near["participant"].tolist() == ["A", "B"]
    assert near["tau_b"].isna().tolist() == [True, False]
    row = rank_correlations(ratings_from(rows)).iloc[0]
    assert (row["people"], row["without_spread"], row["somers_d"]) == (2, 1, 0.5)


def test_over_all_only_ratings_at_one_distance_are_compared() -> None:
    """Low far away beats ultra close by: within each distance the order is still perfect."""
    rows = [("A", "near", "low", 1), ("A", "near", "ultra", 2)]
    rows += [("A", "far", "low", 4), ("A", "far", "ultra", 5)]
    people = person_concordance(ratings_from(rows)).set_index("distance")
    assert people.loc["all", "somers_d"] == 1.0
    assert people.loc["all", "untied"] == 2


def test_one_distance_is_reported_once() -> None:
    rows = [(p, "near", lod, r) for p, lod, r in (("A", "low", 1), ("A", "ultra", 2))]
    assert rank_correlations(ratings_from(rows))["distance"].tolist() == ["near"]


def test_interval_of_mean_tau_keeps_its_level_without_a_relation(
    rng: np.random.Generator,
) -> None:
    """Ten people, 14 ratings each at random: about 5 % of the intervals leave zero out."""
    person = np.repeat(np.arange(10), 14)
    misses = 0
    for _ in range(600):
        rank = np.concatenate([rng.permutation(np.tile([1, 2, 3, 4], 4))[:14] for _ in range(10)])
        pairs = count_pairs(person, rank, rng.integers(1, 6, 140))
        _, low, high = mean_tau(pairs.tau_b, pairs.untied)
        misses += not low <= 0 <= high
    assert misses / 600 == pytest.approx(0.05, abs=0.03)


def test_the_p_value_of_tau_is_that_of_students_t_on_fishers_scale() -> None:
    tau = np.array([0.5, 0.1, 0.62, -0.2, 0.3])
    mean = mean_tau(tau, np.full(5, 40))
    assert tau_p(mean, 5) == pytest.approx(stats.ttest_1samp(np.arctanh(tau), 0).pvalue)
    assert np.isnan(tau_p((0.4, np.nan, np.nan), 5))
    assert np.isnan(tau_p((0.4, 0.1, 0.6), 1))
