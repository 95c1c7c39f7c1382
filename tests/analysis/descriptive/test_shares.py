"""Shares of answers and Wilson's interval."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from analysis.descriptive.shares import (
    comparison_shares,
    notice_shares,
    pair_comparison_shares,
    pair_notice_shares,
    wilson,
)
from analysis.tables.reading import tables_from


def comparisons_from(rows: list[tuple[object, ...]]) -> pd.DataFrame:
    names = ["participant", "clip", "left_lod", "right_lod", "comparison", "noticed"]
    ratings = pd.DataFrame({"participant": ["A"], "lod": ["low"], "rating": [1]})
    frame = pd.DataFrame(rows, columns=names)
    return tables_from({"ratings": ratings, "comparisons": frame}).comparisons


@pytest.mark.parametrize(("count", "total"), [(0, 10), (3, 10), (10, 10), (1, 1), (40, 997)])
def test_wilson_agrees_with_scipy(count: int, total: int) -> None:
    wanted = stats.binomtest(count, total).proportion_ci(method="wilson")
    assert wilson(count, total) == pytest.approx((wanted.low, wanted.high), abs=1e-12)


def test_wilson_of_nothing_is_nothing() -> None:
    assert np.isnan(wilson(0, 0)).all()


def test_right_relative_to_left_is_read_the_right_way_round() -> None:
    table = comparison_shares(
        comparisons_from(
            [
                ("A", "c", "low", "ultra", 1, None),
                ("B", "c", "low", "ultra", 1, None),
                ("C", "c", "low", "ultra", -1, None),
                ("D", "c", "low", "ultra", 0, None),
                ("E", "c", "low", "ultra", None, None),
            ]
        )
    )
    assert dict(zip(table["answer"], table["count"], strict=True)) == {
        "left": 1,
        "none": 1,
        "right": 2,
    }
    assert set(table["total"]) == {4}


def test_a_pair_counts_the_same_from_either_side() -> None:
    table = pair_comparison_shares(
        comparisons_from(
            [
                ("A", "c4", "low", "ultra", 1, None),
                ("A", "c6", "ultra", "low", -1, None),
                ("B", "c6", "ultra", "low", 1, None),
                ("B", "catch", "ultra", "ultra", 1, None),
            ]
        )
    )
    assert table[["lesser", "greater"]].drop_duplicates().to_numpy().tolist() == [["low", "ultra"]]
    counts = dict(zip(table["answer"], table["count"], strict=True))
    assert counts == {"lesser": 1, "none": 0, "greater": 2}
    assert set(table["people"]) == {2}


def test_pairs_without_ranks_go_by_name() -> None:
    table = pair_comparison_shares(comparisons_from([("A", "c", "matt", "gloss", -1, None)]))
    assert (table["lesser"][0], table["greater"][0]) == ("gloss", "matt")
    assert table.loc[table["answer"] == "greater", "count"].tolist() == [1]


def test_not_sure_is_an_answer_and_catch_trials_are_pairs() -> None:
    rows = comparisons_from(
        [
            ("A", "c", "low", "ultra", None, "unsure"),
            ("B", "c", "low", "ultra", None, "yes"),
            ("C", "c", "low", "ultra", None, None),
            ("A", "k", "high", "high", None, "yes"),
        ]
    )
    table = notice_shares(rows)
    assert table["count"].tolist() == [1, 1, 0, 1, 0, 0]
    false_alarms = pair_notice_shares(rows).query("lesser == 'high' and greater == 'high'")
    assert false_alarms["share"].tolist() == [1.0, 0.0, 0.0]


def test_no_answers_give_empty_tables() -> None:
    rows = comparisons_from([("A", "c", "low", "ultra", None, None)])
    for shares in (comparison_shares, pair_comparison_shares, notice_shares, pair_notice_shares):
        assert shares(rows).empty
