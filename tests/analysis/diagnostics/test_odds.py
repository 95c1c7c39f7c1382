"""The proportional-odds check beside R's, and how often it cries wolf."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.stats import chi2

from analysis.diagnostics.odds import CATEGORIES, SCALE, odds_tests
from analysis.models.counts import Counts, count_answers
from analysis.models.ordinal import LENIENCY, OrdinalModel
from analysis.models.predictors import Linear

sys.path.append(str(Path(__file__).parents[1] / "models"))
from peers import ask_r

TESTS = (
    "own <- function(table, test) data.frame(factor = rownames(table)[-1], test = test,"
    " statistic = table$LRT[-1], dof = table$Df[-1], p = table[['Pr(>Chi)']][-1])\n"
    "tests <- rbind(own(scale_test(f), 'scale'), own(nominal_test(f), 'categories'))\n"
)
# The data and, beside their first rows, what R says of them: R takes long to start.
TOGETHER = "tests[nrow(s), 1] <- NA\nwrite.csv(cbind(s, tests[seq_len(nrow(s)), ]))"


def agree(own: pd.DataFrame, both: pd.DataFrame, *, within: float) -> None:
    peer = both[["factor", "test", "statistic", "dof", "p"]].dropna()
    joined = own.merge(peer, on=["factor", "test"], suffixes=("", "_r"))
    assert len(joined) == len(own) == 4
    ratio = joined["statistic"].to_numpy()
    assert ratio == pytest.approx(joined["statistic_r"].to_numpy(), abs=within)
    assert joined["dof"].tolist() == joined["dof_r"].tolist()
    assert chi2.sf(ratio, joined["dof"]) == pytest.approx(joined["p_r"].to_numpy(), abs=2e-3)
    assert (joined["p"] >= joined["p_r"] - 2e-3).all()  # R's makes no allowance for few answers


@pytest.mark.peer
def test_wine_is_tested_as_r_tests_it() -> None:
    mixed = "random = judge, data = wine, Hess = TRUE, nAGQ = 10, link = 'probit'"
    both = ask_r(
        f"f <- clm(rating ~ temp + contact, data = wine, link = 'probit')\n{TESTS}"
        f"g <- clmm2(rating ~ temp + contact, {mixed})\n"
        f"h <- clmm2(rating ~ temp + contact, scale = ~temp, {mixed})\n"
        "s <- wine[c('rating', 'temp', 'contact', 'judge')]\n"
        f"s$ratio <- as.numeric(2 * (logLik(h) - logLik(g)))\n{TOGETHER}"
    )
    kinds, what = np.unique(both[["temp", "contact"]].agg(" ".join, axis=1), return_inverse=True)
    location = np.array([["warm" in kind, "yes" in kind] for kind in kinds], dtype=float)
    counts = count_answers(both["judge"] - 1, what, both["rating"] - 1, shape=(9, 4, 5))
    factors = {"temp": location[:, :1], "contact": location[:, 1:]}
    predictor = Linear(location, ("temp", "contact"))
    agree(odds_tests(OrdinalModel(predictor, effects=()), counts, factors), both, within=2e-3)
    mixed_tests = odds_tests(OrdinalModel(predictor, effects=(LENIENCY,)), counts, factors)
    found = mixed_tests.set_index(["factor", "test"])["statistic"]
    assert found["temp", SCALE] == pytest.approx(both["ratio"][0], abs=2e-3)


@pytest.mark.peer
def test_soup_with_more_levels_is_tested_as_r_tests_it() -> None:
    both = ask_r(
        "s <- subset(soup, !is.na(SURENESS))\n"
        f"f <- clm(SURENESS ~ PRODID + DAY, data = s, link = 'probit')\n{TESTS}"
        "s <- data.frame(product = as.integer(s$PRODID), day = as.integer(s$DAY),"
        f" sure = as.integer(s$SURENESS))\n{TOGETHER}"
    )
    kinds, what = np.unique(both[["product", "day"]], axis=0, return_inverse=True)
    product = (kinds[:, :1] == np.arange(2, 7)).astype(float)
    day = (kinds[:, 1:] == 2).astype(float)
    terms = (*(f"product {i}" for i in range(2, 7)), "day")
    counts = count_answers(
        both["sure"] * 0, what.ravel(), both["sure"] - 1, shape=(1, len(kinds), 6)
    )
    model = OrdinalModel(Linear(np.column_stack([product, day]), terms), 6, effects=())
    agree(odds_tests(model, counts, {"PRODID": product, "DAY": day}), both, within=1e-2)


def drawn(
    rng: np.random.Generator, *, people: int, each: int, noise: float = 1.0
) -> tuple[OrdinalModel, Counts, dict[str, np.ndarray]]:
    """Draw ratings of 3 LoDs at 2 distances; ``noise`` is the third LoD's."""
    lod, distance = np.repeat(np.arange(3), 2), np.tile([0, 1], 3)
    columns = {
        "LoD": (lod[:, None] == [1, 2]).astype(float),
        "distance": distance[:, None].astype(float),
    }
    design = np.eye(6)[:, 1:]
    who = np.repeat(np.arange(people), each)
    what = np.tile(np.arange(6), people * each // 6)
    place = np.array([-0.6, -0.2, 0.2, 0.3, 0.5, 0.4])
    spread = np.where(lod == 2, noise, 1.0)
    percept = place[what] + 0.45 * rng.standard_normal(people)[who]
    percept = percept + spread[what] * rng.standard_normal(who.size)
    answer = (percept[:, None] > [-1.35, -0.25, 0.85, 1.85]).sum(axis=1)
    model = OrdinalModel(Linear(design, tuple(f"cell {i}" for i in range(1, 6))))
    return model, count_answers(who, what, answer, shape=(people, 6, 5)), columns


def rejected(seeds: range, *, people: int, each: int) -> pd.Series:
    tables = []
    for seed in seeds:
        model, counts, factors = drawn(np.random.default_rng(seed), people=people, each=each)
        tables.append(odds_tests(model, counts, factors))
    rows = pd.concat(tables)
    return (rows["p"] < 0.05).groupby([rows["factor"], rows["test"]]).mean()


def test_it_seldom_cries_wolf() -> None:
    found = rejected(range(25), people=10, each=18)
    assert found.mean() <= 0.07 + 2 * np.sqrt(0.07 * 0.93 / 100)


@pytest.mark.long
@pytest.mark.parametrize(("people", "each"), [(10, 12), (24, 24)])
def test_false_alarms_are_at_most_seven_in_a_hundred(people: int, each: int) -> None:
    found = rejected(range(1000, 1500), people=people, each=each)
    assert (found <= 0.07 + 1.64 * np.sqrt(0.07 * 0.93 / 500)).all(), found


def test_greater_noise_is_found_and_named() -> None:
    model, counts, factors = drawn(np.random.default_rng(4), people=60, each=24, noise=2.0)
    found = odds_tests(model, counts, factors).set_index(["factor", "test"])["p"]
    assert found["LoD", SCALE] < 1e-4
    assert found["distance", SCALE] > 0.05


def test_too_few_categories_are_a_statement() -> None:
    model, counts, factors = drawn(np.random.default_rng(4), people=8, each=12)
    few = np.zeros_like(counts.table)
    few[:, :, 1:3] = counts.table[:, :, :2] + counts.table[:, :, 2:4]
    found = odds_tests(model, Counts(few), factors)
    assert found["p"].isna().all()
    assert set(found["note"]) == {"people used 2 of the scale's categories; it takes three"}


def test_a_factor_of_one_level_is_a_statement() -> None:
    model, counts, factors = drawn(np.random.default_rng(4), people=8, each=12)
    found = odds_tests(model, counts, {"LoD": factors["LoD"], "distance": np.zeros((6, 0))})
    by_test = found.set_index(["factor", "test"])
    assert by_test["note"]["distance", CATEGORIES] == "all stimuli share one level"
    assert by_test["p"].notna()["LoD", SCALE]
