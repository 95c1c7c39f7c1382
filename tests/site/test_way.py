"""Before the clips: every page says how many there are and which of them it is."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest

from study.design.definition import StudyDefinition, parse_definition
from study.site.way import pages_before

CHECKS: dict[str, Any] = {"calibration": {}, "eyesight": {}}


@pytest.fixture
def definition(definition: StudyDefinition) -> StudyDefinition:
    """The small study with two checks, the second of which not everybody is asked for."""
    return parse_definition(json.loads(definition.to_json()) | CHECKS)


def marks(guest: Any) -> tuple[str, list[str]]:
    [said] = re.findall(r"Before the clips: [0-9]+ of [0-9]+", guest.page.text)
    return said.removeprefix("Before the clips: "), re.findall(
        r'<li class="(\w+)"></li>', guest.page.text
    )


@pytest.mark.parametrize("database_kind", ["sqlite"])
@pytest.mark.parametrize(("health", "total"), [("yes", 5), ("", 4)])
def test_steps_are_counted_for_whoever_takes_them(guest: Any, health: str, total: int) -> None:
    guest.get("/consent")
    assert "Before the clips" not in guest.page.text
    guest.post("/consent", version=guest.hidden("version"), agree=["1", "2"], health=health)
    assert marks(guest) == (f"1 of {total}", ["now"] + ["ahead"] * (total - 1))
    guest.post("/about-you")
    assert marks(guest) == (f"2 of {total}", ["done", "now"] + ["ahead"] * (total - 2))


def test_a_step_that_a_study_has_not_is_no_page(definition: StudyDefinition) -> None:
    bare = definition.model_copy(update={"about": (), "calibration": None, "eyesight": None})
    assert pages_before(bare, has_health=True) == ("instructions", "preparing")
