"""Data quality: missing answers, use of the scale, and what was pooled or left out."""

import pandas as pd
import pytest

from analysis.descriptive.quality import missing_answers, people_overview, quality_statements
from analysis.tables.reading import Tables, tables_from


def tables(rows: list[tuple[object, ...]], *names: str, **more: pd.DataFrame) -> Tables:
    columns = ["participant", "lod", "rating", *names]
    return tables_from({"ratings": pd.DataFrame(rows, columns=columns), **more})


def test_missing_answers_are_counted_per_question(thesis_tables: Tables) -> None:
    table = missing_answers(thesis_tables).set_index("column")
    assert table.loc["rating", "asked"] == 140
    assert table.loc["rating", "answered"] + table.loc["rating", "missing"] == 140
    assert table.loc["comparison", "asked"] == 70
    assert table.loc["rating", "missing"] == thesis_tables.ratings["rating"].isna().sum()


def test_practice_is_not_asked_for() -> None:
    data = tables([("A", "low", None, True), ("A", "low", 1, False)], "is_practice")
    assert missing_answers(data).set_index("column").loc["rating", "asked"] == 1
    assert quality_statements(data)[0] == "Ratings of practice trials, not counted: 1."


def test_gold_trials_are_left_out_like_practice_and_told_apart() -> None:
    rows = [
        ("A", "bare", 1, False, True),
        ("A", "low", 2, True, False),
        ("A", "low", 1, False, None),
    ]
    data = tables(rows, "is_practice", "is_gold")
    assert missing_answers(data).set_index("column").loc["rating", "asked"] == 1
    assert quality_statements(data)[:2] == [
        "Ratings of practice trials, not counted: 1.",
        "Ratings of gold trials, not counted: 1.",
    ]


def test_use_of_the_scale_by_person() -> None:
    rows = [("A", "low", 1, 2000), ("A", "high", 5, 4000), ("A", "ultra", None, None)]
    row = people_overview(tables(rows, "response_ms")).iloc[0]
    assert row[["ratings", "missing", "lowest", "highest", "distinct"]].tolist() == [2, 1, 1, 1, 2]
    assert row["median_response_s"] == pytest.approx(3.0)


def test_the_number_of_perfect_ratings_is_said_with_who_gave_them() -> None:
    given = [*((person, "ultra", 5) for person in "AAAB"), ("B", "low", 1)]
    rows = [(*own, trial) for trial, own in enumerate(given)]
    assert quality_statements(tables(rows, "trial")) == [
        "The highest rating (5) was given 4 times in 5, at most 3 times by one person.",
        "Gave the same rating throughout: A.",
    ]


def test_uncertified_ratings_are_kept_and_said() -> None:
    data = tables([("A", "low", 1, False), ("A", "low", 2, True), ("A", "low", 3, "")], "certified")
    assert (
        "Ratings of presentations that failed the study's rule, kept and counted: 1."
        in quality_statements(data)
    )


def test_pooled_versions_and_unknown_people_are_said() -> None:
    people = pd.DataFrame({"participant": ["A"]})
    data = tables(
        [("A", "low", 1, "thesis", "1"), ("B", "low", 2, "thesis", "2")],
        "study",
        "study_version",
        participants=people,
    )
    text = quality_statements(data)
    assert "Several studies or versions are pooled: thesis 1; thesis 2." in text
    assert "Not in the table of participants: B." in text


def test_unfinished_people_are_counted_and_said() -> None:
    people = pd.DataFrame(
        {"participant": ["A", "B", "C"], "completed_at": ["2026-01-31T09:30:00+00:00", None, None]}
    )
    data = tables([("A", "low", 1), ("B", "low", 2)], participants=people)
    assert "People who have not finished, whose answers are counted: 1." in quality_statements(data)
