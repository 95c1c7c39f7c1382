"""The study that we recommend needs no scrolling after a clip, on small and on large screens."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import Page, expect

from study.design.definition import StudyDefinition, read_definition


@pytest.fixture
def definition(small_study: Any) -> StudyDefinition:
    """The small study with the questions of lod.toml."""
    lod = read_definition("lod").model_dump(mode="json", exclude_unset=True)
    made: StudyDefinition = small_study(questions=lod["questions"])
    return made


def test_all_questions_and_their_button_are_seen_at_once(page: Page, visit: Any) -> None:
    page.set_viewport_size({"width": 1366, "height": 768})
    visit.straight_to_trial()
    visit.watch()
    page.locator("[data-when=watched] [data-to-questions]").click()
    expect(page.locator("#questions-heading")).to_be_focused()
    expect(page.locator("#questions-heading")).to_be_in_viewport(ratio=1)
    expect(page.locator("form [type=submit]")).to_be_in_viewport(ratio=1)
    strip, heading = (
        page.locator(name).bounding_box() for name in (".strip", "#questions-heading")
    )
    assert strip is not None
    assert heading is not None
    assert strip["y"] + strip["height"] <= heading["y"]

    page.set_viewport_size({"width": 1920, "height": 1080})
    page.reload()
    page.locator("[data-when=watched] [data-to-questions]").click()
    page.locator("input[name=noticed][value=yes]").check()
    expect(page.get_by_label("What do you think was different?")).to_be_visible()
    expect(page.locator("form [type=submit]")).to_be_in_viewport(ratio=1)
    page.locator("[data-again]").click()
    visit.state("watched")
