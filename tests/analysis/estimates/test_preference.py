"""The preference scale: closed forms, another library, side, ties, references."""

from __future__ import annotations

from itertools import combinations

import choix
import numpy as np
import pandas as pd
import pytest
from scipy.special import ndtri

from analysis.estimates.preference import JOD, preference_of
from analysis.models.counts import Counts
from analysis.models.fitting import fit
from analysis.models.links import LOGIT
from analysis.models.ordinal import OrdinalModel
from analysis.models.predictors import Linear

RANKS = {"low": 0, "medium": 1, "high": 2, "ultra": 3}


def tables(rows: list[tuple[str, str, str, int, int]]) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return comparisons and ratings: (distance, left, right, outcome, how often)."""
    spread = [row[:4] for row in rows for _ in range(row[4])]
    comparisons = pd.DataFrame(spread, columns=["distance", "left_lod", "right_lod", "comparison"])
    people = [f"p{i % 40}" for i in range(len(comparisons))]  # a few answers from each
    comparisons = comparisons.assign(participant=people, is_practice=False)
    lods = sorted({lod for row in rows for lod in row[1:3]}, key=lambda lod: RANKS.get(lod, -1))
    cells = [(row[0], lod) for row in rows for lod in lods]
    ratings = pd.DataFrame(cells, columns=["distance", "lod"]).drop_duplicates()
    ratings["lod_rank"] = ratings["lod"].map(RANKS)
    return comparisons, ratings.assign(iris_px=100.0)


def test_one_pair_is_its_closed_form() -> None:
    # 600 for the right, 250 ties, 150 for the left, whichever LoD stands there: side and band.
    rows = [("near", "low", "ultra", 1, 600), ("near", "low", "ultra", 0, 250)]
    rows += [("near", "low", "ultra", -1, 150), ("near", "ultra", "low", 1, 150)]
    rows += [("near", "ultra", "low", 0, 250), ("near", "ultra", "low", -1, 600)]
    found = preference_of(*tables(rows), np.random.default_rng(1))
    assert found is not None
    a, b = ndtri(0.15), ndtri(0.40)  # -delta - D and delta - D
    assert dict(zip(found.cells, found.jod()[0], strict=True)) == {
        ("near", "low"): pytest.approx(JOD * (a + b) / 2, abs=0.01),
        ("near", "ultra"): 0.0,
    }
    assert found.side()[0] == pytest.approx(0.0, abs=0.03)
    shares = found.shares(("near", "ultra"), ("near", "low"))
    assert shares == pytest.approx((0.6, 0.25, 0.15), abs=3e-3)


def test_the_side_is_told_from_the_lods() -> None:
    rows = [("near", "low", "ultra", 1, 90), ("near", "low", "ultra", -1, 10)]
    rows += [("near", "ultra", "low", 1, 40), ("near", "ultra", "low", -1, 60)]
    rows += [("near", "ultra", "ultra", 0, 30), ("near", "ultra", "ultra", 1, 40)]
    rows += [("near", "ultra", "ultra", -1, 30)]
    found = preference_of(*tables(rows), np.random.default_rng(1))
    assert found is not None
    value, draws = found.side()
    assert value > 0.2
    assert np.quantile(draws, 0.05) > 0.0


def test_without_ties_and_side_it_is_bradley_and_terrys_model() -> None:
    rng = np.random.default_rng(3)
    strength = np.array([0.0, 0.8, 1.1, 2.0])
    wins = np.zeros((4, 4))
    for i, j in combinations(range(4), 2):
        wins[i, j] = rng.binomial(60, 1 / (1 + np.exp(strength[j] - strength[i])))
        wins[j, i] = 60 - wins[i, j]
    pairs = [(i, j) for i, j in combinations(range(4), 2)]
    design = np.array([[(k == j) * 1.0 - (k == i) for k in range(1, 4)] for i, j in pairs])
    counts = Counts(np.array([[[wins[i, j], wins[j, i]] for i, j in pairs]]))
    # Shown with either side as often, the threshold is 0: add each pair the other way round.
    both = Counts(np.concatenate([counts.table, counts.table[:, :, ::-1]], axis=1))
    model = OrdinalModel(Linear(np.vstack([design, -design]), ("b", "c", "d")), 2, (), LOGIT)
    found = fit(model, both)
    data = [(i, j) for i in range(4) for j in range(4) for _ in range(int(wins[i, j]))]
    peer = choix.opt_pairwise(4, data, tol=1e-10)
    own = [found.value(name) for name in "bcd"]
    assert own == pytest.approx(peer[1:] - peer[0], abs=1e-4)
    assert found.value("threshold_1") == pytest.approx(0.0, abs=1e-6)


def test_every_lod_is_measured_from_the_highest_that_comparisons_link_it_to() -> None:
    rows = [("near", "low", "medium", 1, 5), ("near", "high", "ultra", 1, 5)]
    rows += [("far", "low", "medium", -1, 5)]
    found = preference_of(*tables(rows), np.random.default_rng(1))
    assert found is not None
    table = found.table().set_index(["distance", "lod"])["reference"]
    assert table["near", "low"] == "medium"
    assert table["near", "high"] == "ultra"
    assert table["far", "low"] == "medium"
    assert found.table()["jod_low"].isna().tolist() == [False, True, False, True, False, True]


def test_ties_alone_and_perfect_agreement_stay_finite() -> None:
    ties = [("near", "low", "ultra", 0, 20), ("near", "ultra", "low", 0, 20)]
    only_ties = preference_of(*tables(ties), np.random.default_rng(1))
    assert only_ties is not None
    assert only_ties.jod()[0][0] == pytest.approx(0.0, abs=0.05)
    agreed = preference_of(*tables([("near", "low", "ultra", 1, 40)]), np.random.default_rng(1))
    assert agreed is not None
    assert -10 < agreed.jod()[0][0] < -1


def test_nobody_compared_different_lods() -> None:
    assert preference_of(*tables([("near", "low", "low", 0, 9)]), np.random.default_rng(1)) is None
