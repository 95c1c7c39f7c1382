"""Means, intervals and differences: by hand, against scipy, and by their coverage."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from analysis.descriptive.means import (
    differences_from_best,
    mean_ratings,
    person_means,
    rating_counts,
    t_interval,
)
from analysis.tables.ordering import distance_order, lod_order, natural
from analysis.tables.reading import tables_from


def ratings_from(rows: list[tuple[object, ...]], *names: str) -> pd.DataFrame:
    frame = pd.DataFrame(rows, columns=["participant", "lod", "rating", *names])
    return tables_from({"ratings": frame}).ratings


def test_t_interval_agrees_with_scipy() -> None:
    x = np.array([1.0, 2, 2, 3, 5, 4, 2])
    wanted = stats.t.interval(0.95, x.size - 1, loc=x.mean(), scale=stats.sem(x))
    assert t_interval(x) == pytest.approx(wanted)


def test_t_interval_by_hand() -> None:
    """1 and 3: mean 2, s / sqrt(n) = 1, t(1) at .975 = 12.706."""
    assert t_interval([1, 3]) == pytest.approx((2 - 12.706, 2 + 12.706), abs=1e-3)


@pytest.mark.parametrize("values", [[], [3.0], [3.0, 3.0, 3.0]])
def test_there_is_no_interval_without_spread(values: list[float]) -> None:
    assert np.isnan(t_interval(values)).all()


def test_t_interval_covers_its_share_of_ratings_at_ten_people(rng: np.random.Generator) -> None:
    """Coverage on skewed five-step ratings; the normal interval reaches about .91 here."""
    shares = np.array([0.19, 0.34, 0.29, 0.15, 0.03])
    mean = shares @ np.arange(1, 6)
    studies = rng.choice(np.arange(1, 6), size=(1500, 10), p=shares)
    intervals = np.array([t_interval(study) for study in studies])
    covered = (intervals[:, 0] <= mean) & (mean <= intervals[:, 1])
    assert covered.mean() == pytest.approx(0.945, abs=0.02)


def test_a_person_counts_once_however_often_asked() -> None:
    ratings = ratings_from([("A", "low", 1), ("A", "low", 2), ("A", "low", 3), ("B", "low", 4)])
    row = mean_ratings(ratings, ["lod"]).iloc[0]
    assert (row["people"], row["ratings"], row["mean"]) == (2, 4, 3.0)
    assert (row["low"], row["high"]) == pytest.approx(t_interval([2.0, 4.0]))


def test_missing_ratings_and_practice_do_not_count() -> None:
    ratings = ratings_from(
        [("A", "low", 1, False), ("B", "low", None, False), ("C", "low", 5, True)], "is_practice"
    )
    assert person_means(ratings, ["lod"])["participant"].tolist() == ["A"]


def test_all_missing_gives_an_empty_table_with_its_columns() -> None:
    table = mean_ratings(ratings_from([("A", "low", None)]), ["distance", "lod"])
    assert table.empty
    assert list(table.columns)[:4] == ["distance", "lod", "people", "ratings"]


def test_differences_are_taken_within_people() -> None:
    """Leniency cancels: everyone puts ultra one and low two below, from wherever they start."""
    rows = [
        (person, lod, start + gap)
        for person, start in (("A", 1), ("B", 2), ("C", 2))
        for lod, gap in (("low", 0), ("medium", 2), ("ultra", 3))
    ]
    table = differences_from_best(ratings_from([*rows, ("D", "ultra", 1)]))
    assert table["lod"].tolist() == ["low", "medium"]
    assert table["best"].tolist() == ["ultra", "ultra"]
    assert table["difference"].tolist() == [3.0, 1.0]
    assert table["people"].tolist() == [3, 3]


def test_difference_interval_is_the_paired_t() -> None:
    low, ultra = [1, 2, 2, 1], [4, 3, 5, 2]
    people = "ABCD"
    rows = [(p, "low", r) for p, r in zip(people, low, strict=True)]
    rows += [(p, "ultra", r) for p, r in zip(people, ultra, strict=True)]
    row = differences_from_best(ratings_from(rows)).iloc[0]
    wanted = stats.ttest_rel(ultra, low).confidence_interval(0.95)
    assert (row["low"], row["high"]) == pytest.approx((wanted.low, wanted.high))


def test_counts_show_every_step_of_the_scale() -> None:
    counts = rating_counts(
        ratings_from([("A", "low", 2), ("B", "low", 2), ("C", "low", 5)]), ["lod"], scale=(1, 5)
    )
    assert counts.iloc[0][["1", "2", "3", "4", "5", "total"]].tolist() == [0, 2, 0, 0, 1, 3]


def test_order_is_closest_first_and_lods_by_rank() -> None:
    ratings = ratings_from(
        [
            ("A", "ultra", 1, "far", 12),
            ("A", "shiny", 1, "porch", 60),
            ("A", "low", 1, "sofa", 90),
            ("A", "low", 1, "near", 160),
        ],
        "distance",
        "iris_px",
    )
    assert distance_order(ratings) == ["near", "far", "sofa", "porch"]
    assert lod_order(ratings) == ["low", "ultra", "shiny"]
    assert sorted(["clip-10", "clip-2"], key=natural) == ["clip-2", "clip-10"]
