"""What a design shows, what it cannot answer, and which differences no pixel shows."""

from __future__ import annotations

from typing import Any

import pytest

from renderer.detail import EFFECTS, LEVELS, Detail
from study.design import audit
from study.design.definition import parse_definition, read_definition
from study.design.visibility import hidden_effects, visible_from


def test_the_thesis_shows_9_of_16_cells_and_one_mirrored_pair() -> None:
    lines = audit.statements(read_definition("thesis"))
    assert lines[0].startswith("One visit has 8 clips (1 for practice) and takes about ")
    assert lines[0].endswith(" s).")
    assert "9 of 16 combinations of LoD and distance were shown." in lines
    assert any("exchanged" in line and "4 and 6" in line for line in lines)
    assert any(line.startswith("No clip showed the same LoD in both eyes") for line in lines)
    assert any(line.startswith("No comparison links two distances") for line in lines)


def test_cells_count_the_eyes_that_are_shown() -> None:
    assert [line.split() for line in audit.cell_table(read_definition("thesis"))] == [
        ["distance", "low", "medium", "high", "ultra"],
        ["macroscopic", "1", "2", "2", "1"],
        ["near", "3", "1", "-", "2"],
        ["medium", "-", "-", "-", "-"],
        ["far", "1", "-", "-", "1"],
    ]


def test_the_recommended_study_leaves_no_cell_empty() -> None:
    lod = read_definition("lod")
    facts = audit.audit(lod)
    assert facts.empty_cells == ()
    assert facts.catch_clips == 16
    assert len(facts.mirrored) == 12
    assert facts.lods == ("low", "medium", "high", "ultra")
    assert all(len(groups) == 1 for groups in facts.linked.values())


def test_the_plan_says_who_sees_how_much_and_when_it_is_balanced() -> None:
    visit, share, orders, *rest = audit.statements(read_definition("lod"))
    assert visit.startswith("One visit has 24 clips (3 for practice, 1 gold) and takes about 14.")
    assert "calibration 75 s" in visit
    assert share == (
        "One person sees 20 of 112 clips. 12 blocks x 2 directions are 24 arms: after so many "
        "people every clip was shown equally often in each direction."
    )
    assert orders == (
        "Orders are 20 rows of a Williams design: after 20 people the kinds of trial stood at "
        "every place, and each came right after each other, equally often."
    )
    assert "Shown with the eyes exchanged: 12 pairings." in rest


def test_warnings_name_what_is_worth_a_second_look(raw: dict[str, Any]) -> None:
    raw["contact"] = {"name": "Somebody"}
    raw["practice"] = []
    raw["orbit"]["directions"] = ["leftward"]
    found = audit.warnings(parse_definition(raw))
    starts = [
        "contact: neither email nor details",
        "decision: no margins",
        "practice: no clip",
        "orbit.directions: only one",
        "questions: none is called rating_right",
        "questions: none is called comparison",
        "lods.no-caustics: no clip shows it",
    ]
    assert [line[: len(start)] for line, start in zip(found, starts, strict=False)] == starts


def test_a_study_that_asks_nothing_the_analysis_knows_is_told_so(raw: dict[str, Any]) -> None:
    raw["questions"] = [{"id": "mood", "kind": "text", "text": "How does it look?"}]
    (told,) = [line for line in audit.warnings(parse_definition(raw)) if "questions: " in line]
    assert told.startswith(
        "questions: none is called rating_left, rating_right, comparison, noticed; ocularist "
        "analyse knows these alone and will have nothing to say"
    )


@pytest.mark.parametrize("effect", EFFECTS)
def test_equal_levels_differ_nowhere(effect: str) -> None:
    for level in LEVELS:
        same = Detail.uniform(level)
        assert visible_from(effect, same, same) is None


@pytest.mark.parametrize(
    ("effect", "one", "other", "iris_px"),
    [
        ("texture", "off", "low", 12),
        ("texture", "high", "ultra", 1024),
        ("refraction", "medium", "high", 9),
        ("refraction", "low", "medium", None),
        ("reflection", "medium", "high", 191),
        ("reflection", "high", "ultra", None),
        ("reflection", "low", "medium", None),
        ("subsurface", "low", "high", 39),
        ("subsurface", "high", "ultra", None),
        ("caustics", "high", "ultra", 256),
        ("caustics", "off", "ultra", None),
        ("tessellation", "low", "ultra", 14),
        ("sclera", "low", "ultra", 117),
    ],
)
def test_a_difference_shows_from_its_size_on(
    effect: str, one: str, other: str, iris_px: float | None
) -> None:
    details = Detail().with_levels(**{effect: one}), Detail().with_levels(**{effect: other})
    found = visible_from(effect, *details)
    assert (None if found is None else found.iris_px) == iris_px
    assert visible_from(effect, *reversed(details)) == found
    if iris_px is not None:
        assert set(hidden_effects(*details, iris_px - 1)) == {effect}
        assert hidden_effects(*details, iris_px) == {}
