"""Pauses in a real Chromium: by the keyboard alone, without losing what is loaded."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import BrowserContext, Page, expect

from study.design.definition import StudyDefinition

REST = {"title": "A rest", "button": "I have rested", "paragraphs": [{"text": "Look away."}]}
COLOUR = {
    "id": "colour",
    "kind": "choice",
    "text": "Please choose blue.",
    "options": [{"value": name, "label": name.title()} for name in ("red", "blue")],
}


@pytest.fixture
def definition(small_study: Callable[..., StudyDefinition]) -> StudyDefinition:
    """A question and a break after the first of two trials."""
    asked = {"after": 1, "expected": "blue", "question": COLOUR}
    return small_study(practice=[], breaks=REST | {"after": [1]}, attention=[asked])


def test_pauses_are_passed_by_keyboard_in_the_same_document(
    site: Any, page: Page, context: BrowserContext
) -> None:
    guest = site.guest()
    guest.walk_to_trial()
    guest.watch()
    name = "ocularist_participant"
    cookie: Any = {"name": name, "value": guest.client.cookies[name], "url": site.url}
    context.add_cookies([cookie])
    page.goto(f"{site.url}/trial/1")
    page.evaluate("window.sameDocument = true")
    page.get_by_role("button", name="Save and go to the next clip").click()
    page.get_by_role("button", name="Save and go to the next clip").click()  # questions are open

    expect(page.get_by_role("heading", name="A question in between")).to_be_focused()
    page.get_by_label("Blue").focus()
    page.keyboard.press("Space")
    page.keyboard.press("Enter")
    expect(page.get_by_role("heading", name="A rest")).to_be_focused()
    assert "1 of 2 clips are done." in page.inner_text("main")
    page.get_by_role("button", name="I have rested").focus()
    page.keyboard.press("Enter")
    expect(page).to_have_url(f"{site.url}/trial/2")
    assert page.evaluate("window.sameDocument") is True
    guest.client.close()
