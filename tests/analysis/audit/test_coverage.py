"""Who saw what: counts over people, groups that nobody links, directions."""

from __future__ import annotations

from analysis.audit import audit_tables
from analysis.audit.coverage import coverage, linked_groups
from analysis.tables.reading import Tables

NEAR, FAR, HIGH = ("near", "low"), ("far", "low"), ("near", "high")


def test_cells_that_one_person_saw_are_linked_also_over_distances() -> None:
    found = coverage({"a": [NEAR, FAR], "b": [FAR, HIGH], "c": [NEAR]})
    assert found.groups == ((NEAR, FAR, HIGH),)
    assert found.seen_by == {NEAR: 2, FAR: 2, HIGH: 1}
    assert found.limits() == []
    assert found.facts() == [
        "Each of these combinations was rated by 1 to 2 of 3 people; high at distance=near by 1 "
        "only."
    ]


def test_groups_that_nobody_links_are_named() -> None:
    found = coverage({"a": [NEAR, FAR], "b": [HIGH]}, directions={"leftward": 1, "rightward": 1})
    assert found.groups == ((NEAR, FAR), (HIGH,))
    assert found.limits() == [
        "Nobody rated eyes of more than one of these groups: low at distance=near and low at "
        "distance=far; high at distance=near. Differences between the groups cannot be told from "
        "differences between people."
    ]
    assert found.facts()[1] == "The camera turned rightward for 1 person and leftward for 1 person."


def test_groups_grow_together_in_any_order() -> None:
    assert linked_groups([(1, 2), (3, 4), (), (2, 3), (5,)], [1, 2, 3, 4, 5]) == (
        (1, 2, 3, 4),
        (5,),
    )


def test_the_thesiss_report_says_that_all_ten_rated_everything(thesis_tables: Tables) -> None:
    audit = audit_tables(thesis_tables.ratings, thesis_tables.comparisons)
    assert audit.coverage is not None
    assert len(audit.coverage.seen_by) == 9
    assert audit.coverage.people == 10
    assert len(audit.coverage.groups) == 1
    assert any(line.startswith("Each of these combinations was rated by") for line in audit.facts())


def test_nobody_covers_nothing() -> None:
    assert coverage({}).facts() == coverage({}).limits() == []
