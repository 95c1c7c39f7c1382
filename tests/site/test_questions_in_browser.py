"""Every kind of question in a real Chromium: keyboard alone, reload, rules, what is stored."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import Page, expect

from study.data import events
from study.design.definition import StudyDefinition

OWN: list[dict[str, Any]] = [
    {
        "id": "devices",
        "kind": "multiple",
        "text": "What do you play on?",
        "options": [
            {"value": "phone", "label": "A phone"},
            {"value": "computer", "label": "A computer"},
            {"value": "none", "label": "Nothing", "is_exclusive": True},
        ],
    },
    {
        "id": "hours",
        "kind": "number",
        "text": "How many hours a week?",
        "minimum": 0,
        "maximum": 168,
        "decimals": 1,
        "shown_if": {"question": "devices", "values": ["phone", "computer"]},
    },
    {
        "id": "tired",
        "kind": "number",
        "text": "How many of them in bed?",
        "minimum": 0,
        "maximum": 168,
        "shown_if": {"question": "hours", "at_least": 10},
    },
    {
        "id": "mood",
        "kind": "analogue",
        "text": "How awake are you?",
        "lowest_label": "asleep",
        "highest_label": "wide awake",
    },
    {
        "id": "trust",
        "kind": "matrix",
        "text": "How well do you see?",
        "rows": [{"id": "near", "label": "Near"}, {"id": "far", "label": "Far"}],
        "labels": ["badly", "so-so", "well"],
        "highest": 3,
    },
    {"id": "eyesight", "kind": "text", "text": "Your eyesight?", "is_long": False},
]


@pytest.fixture
def definition(small_study: Any) -> StudyDefinition:
    """The small study with every kind of question about the participant."""
    made: StudyDefinition = small_study(about=OWN)
    return made


def begin(page: Page, url: str) -> None:
    page.goto(f"{url}/consent")
    for box in page.get_by_role("checkbox").all():
        box.check()
    page.get_by_role("button", name="I agree and want to take part").click()
    expect(page).to_have_url(f"{url}/about-you")


def test_every_kind_is_answered_with_the_keyboard_and_survives_a_reload(
    site: Any, page: Page
) -> None:
    begin(page, site.url)
    hours, bed = page.get_by_label("How many hours a week?"), page.get_by_label("How many of them")
    line = page.get_by_label("How awake are you?")
    expect(hours).to_be_hidden()

    # "Nothing" and the others untick each other; a rule shows what is asked next.
    keys = page.keyboard
    page.get_by_label("Nothing").focus()
    keys.press("Space")
    page.get_by_label("A computer").focus()
    keys.press("Space")
    expect(page.get_by_label("Nothing")).not_to_be_checked()
    keys.press("Tab")
    keys.press("Shift+Tab")
    expect(hours).to_be_visible()
    hours.focus()
    keys.type("12,5")
    keys.press("Tab")
    expect(bed).to_be_visible()

    # A line holds no answer until it is marked; Space marks it where it stands.
    expect(line).to_have_attribute("aria-valuetext", "not marked yet")
    line.focus()
    keys.press("Space")
    keys.press("ArrowRight")
    expect(page.locator("input[name=mood]")).to_have_value("51")
    page.get_by_role("group", name="Near").get_by_label("well").focus()
    keys.press("Space")
    expect(page.locator(".saved [role=status]")).to_have_text("Saved")

    page.reload()
    expect(page.get_by_label("A computer")).to_be_checked()
    expect(page.get_by_label("A phone")).not_to_be_checked()
    expect(hours).to_have_value("12,5")
    expect(line).to_have_value("51")
    expect(page.locator("input[name=trust_near][value='3']")).to_be_checked()

    # An answer can be taken back, and then it is missing.
    page.locator("[data-clear=mood]").press("Enter")
    expect(page.locator("input[name=mood]")).to_have_value("")
    page.get_by_role("button", name="Continue").press("Enter")
    expect(page).to_have_url(f"{site.url}/instructions")
    [given] = [
        event.payload["answers"]
        for event in events.history(site.db, site.people()[0])
        if event.kind == "about"
    ]
    assert given == {
        "devices": ["computer"],
        "hours": 12.5,
        "tired": None,
        "mood": None,
        "trust_near": 3,
        "trust_far": None,
        "eyesight": None,
    }


def test_what_cannot_be_stored_is_told_beside_its_question(site: Any, page: Page) -> None:
    begin(page, site.url)
    page.get_by_label("A phone").check()
    page.get_by_label("How many hours a week?").fill("many")
    page.get_by_role("button", name="Continue").click()
    page.get_by_role("alert").get_by_role("link", name="How many hours a week?").click()
    expect(page).to_have_url(f"{site.url}/about-you#about-hours")
    field = page.get_by_label("How many hours a week?")
    expect(field).to_have_accessible_description(
        "Please enter a number from 0 to 168 with at most 1 decimal."
    )
    expect(field).to_have_attribute("aria-invalid", "true")
    expect(field).to_have_value("many")
    expect(page.get_by_label("A phone")).to_be_checked()
