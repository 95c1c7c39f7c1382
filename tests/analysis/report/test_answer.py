"""The answer in sentences: what is claimed, what is not, and what odd data are told."""

import pandas as pd
import pytest

from analysis.costs.cost import Costs
from analysis.report.answer import Finding, findings
from analysis.tables.reading import Tables, tables_from

Row = tuple[str, str, int | None]


def tables(rows: list[Row], noticed: list[tuple[str, str]] | None = None) -> Tables:
    ratings = pd.DataFrame(rows, columns=["participant", "lod", "rating"]).assign(distance="near")
    frames = {"ratings": ratings}
    if noticed:
        frames["comparisons"] = pd.DataFrame(
            [(f"P{i}", "near", "ultra", lod, answer) for i, (lod, answer) in enumerate(noticed)],
            columns=["participant", "distance", "left_lod", "right_lod", "noticed"],
        )
    return tables_from(frames)


def people(ultra: list[int], **others: list[int]) -> list[Row]:
    rows: list[Row] = [(f"P{i}", "ultra", rating) for i, rating in enumerate(ultra)]
    for lod, ratings in others.items():
        rows += [(f"P{i}", lod, rating) for i, rating in enumerate(ratings)]
    return rows


def only(found: list[Finding]) -> Finding:
    assert len(found) == 1
    return found[0]


def plain(sentence: str) -> str:
    return sentence.replace("\N{NO-BREAK SPACE}", " ")


ULTRA = [4, 4, 5, 4, 3, 4, 5, 4, 4, 3]
ALIKE = [4, 4, 5, 3, 4, 4, 4, 5, 4, 3]  # ultra minus this: mean 0, sd 0.667
LOWER = [2, 2, 2, 2, 1, 2, 3, 2, 1, 1]  # mean 2.2 below


def test_the_least_lod_without_a_loss_is_named_with_the_loss_not_ruled_out() -> None:
    found = only(findings(tables(people(ULTRA, high=ALIKE, low=LOWER))))
    assert found.lod == "high"
    assert plain(found.sentence) == (
        "high is the least LoD not shown to be rated below ultra (ultra − high = 0.00 points, "
        "95 % CI −0.48 to 0.48, n = 10), but a loss of up to 0.48 points is not ruled out; "
        "rated below ultra: low by 2.20 points (95 % CI 1.90 to 2.50, n = 10)."
    )


def test_a_lod_below_a_demonstrated_loss_is_never_chosen() -> None:
    """Low looks as good as ultra here, but medium above it was rated lower: the walk stops."""
    found = only(findings(tables(people(ULTRA, high=ALIKE, medium=LOWER, low=ALIKE))))
    assert found.lod == "high"


def test_where_all_are_lower_only_the_best_will_do() -> None:
    found = only(findings(tables(people(ULTRA, low=LOWER))))
    assert found.lod == "ultra"
    assert found.sentence.startswith("every lower LoD shown was rated below ultra, low by 2.20")
    assert found.sentence.endswith("so by the means alone only ultra is left.")


def test_nothing_is_named_where_half_the_scale_is_not_ruled_out() -> None:
    found = only(findings(tables(people([4, 2], low=[2, 4]))))
    assert found.lod is None
    assert plain(found.sentence) == (
        "too little is known about low (ultra − low = 0.00 points, 95 % CI −25.41 to 25.41, n = 2)."
    )


def test_one_person_says_nothing_about_others() -> None:
    found = only(findings(tables(people([4], low=[2]))))
    assert found.sentence == (
        "ultra − low = 2.00 points, from one person, which says nothing about others."
    )
    assert found.lod is None


def test_people_who_agree_completely_give_no_interval() -> None:
    found = only(findings(tables(people([4, 4, 4], low=[2, 2, 2]))))
    assert found.sentence.endswith("the same for all 3 people, which gives no interval.")


def test_one_lod_alone_cannot_be_compared() -> None:
    found = only(findings(tables(people(ULTRA))))
    assert plain(found.sentence) == (
        "only one LoD was rated: ultra 4.00 (3.52 to 4.48, n = 10), so nothing can be compared."
    )


def test_missing_ratings_are_said_to_be_missing() -> None:
    found = only(findings(tables([("A", "ultra", None), ("B", "low", None)])))
    assert found.sentence == "no rating has been given, so nothing can be said."


def test_people_who_rated_only_one_lod_each_are_not_compared() -> None:
    found = only(findings(tables([("A", "ultra", 4), ("B", "low", 2)])))
    assert found.sentence == (
        "nobody rated both ultra and another LoD, so they cannot be compared."
    )


def test_lods_without_rank_have_no_best() -> None:
    rows: list[Row] = [("A", "gloss", 2), ("A", "matt", 4), ("B", "gloss", 1), ("B", "matt", 2)]
    assert only(findings(tables(rows))).sentence.startswith(
        "the LoDs have no rank, so none counts as the best; mean ratings: gloss 1.50"
    )


def test_a_named_lod_is_compared_with_the_best_ranked_one() -> None:
    rows = people(ULTRA) + [(f"P{i}", "ultra-no-caustics", r) for i, r in enumerate(LOWER)]
    assert plain(only(findings(tables(rows))).sentence) == (
        "without a rank: ultra-no-caustics (ultra − ultra-no-caustics = 2.20 points, "
        "95 % CI 1.90 to 2.50, n = 10)."
    )


def test_noticing_stands_beside_realism() -> None:
    """Different is not worse: both are said."""
    noticed = [("high", "yes")] * 9 + [("high", "no"), ("low", "yes")]
    found = only(findings(tables(people(ULTRA, high=ALIKE), noticed)))
    assert "beside ultra, 90 % noticed a difference (60 % to 98 % of 10 answers)" in plain(
        found.sentence
    )


@pytest.mark.parametrize(
    ("own", "wanted"),
    [
        ({"high": 80.0, "ultra": 320.0}, "high costs 80.0 ms per frame, ultra 320 ms, 75 % less."),
        ({"high": 80.0}, "high costs 80.0 ms per frame."),
        ({"ultra": 320.0}, "the cost of high was not measured here."),
    ],
)
def test_costs_stand_beside_the_answer(own: dict[str, float], wanted: str) -> None:
    table = pd.DataFrame({"distance": "near", "lod": list(own), "ms_median": list(own.values())})
    found = findings(tables(people(ULTRA, high=ALIKE)), Costs(table, "2 eyes"))
    assert plain(only(found).sentence).endswith(wanted)


def test_distances_are_answered_from_closest_to_farthest(thesis_tables: Tables) -> None:
    assert [f.distance for f in findings(thesis_tables)] == ["macroscopic", "near", "far"]
