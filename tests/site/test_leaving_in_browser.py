"""A shared computer in real Chromium: nobody's answers are lost, nobody's traces stay."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import pytest
from playwright.sync_api import BrowserContext, Page, expect
from sqlalchemy import select

from study.data import events
from study.data.schema import ParticipantRow
from study.design.definition import StudyDefinition, parse_definition

WORDS = "the left one glows"


@pytest.fixture
def definition(definition: StudyDefinition) -> StudyDefinition:
    data = definition.model_dump(mode="json", exclude_unset=True, exclude={"translations"})
    return parse_definition(data | {"recruiting": {"shared_computers": True}})


def write_without_connection(page: Page) -> None:
    """Watch the clip and comment on it, while nothing that is reported arrives."""
    page.route("**/events", lambda route: route.abort())
    page.get_by_role("button", name="Play the clip").click()
    expect(page.locator(".stage")).to_have_attribute("data-state", "watched")
    page.locator("[name=comments]").fill(WORDS)
    page.locator("[name=comments]").blur()
    expect(page.locator(".saved")).to_have_attribute("data-state", "waiting")


def told(site: Any, person: Any) -> str:
    return str([event.payload for event in events.history(site.db, person)])


def test_what_waits_here_arrives_as_the_last_persons_when_the_next_begins(
    site: Any, page: Page, visit: Any, context: BrowserContext
) -> None:
    visit.straight_to_trial()
    write_without_connection(page)
    page.close(run_before_unload=False)
    with site.db.writing() as session:
        for row in session.scalars(select(ParticipantRow)):
            row.last_seen_at -= timedelta(minutes=31)
    other = context.new_page()
    with other.expect_response(lambda answer: WORDS in (answer.request.post_data or "")) as found:
        other.goto(site.url)
    assert found.value.json()["ok"] is True
    expect(other.get_by_role("link", name="Begin")).to_be_visible()
    other.get_by_role("link", name="Begin").click()
    for box in other.locator("[name=agree]").all():
        box.check()
    other.get_by_role("button", name="I agree and want to take part").click()
    expect(other).to_have_url(f"{site.url}/about-you")
    first, second = site.people()
    assert WORDS in told(site, first)
    assert WORDS not in told(site, second)
    kept = "() => JSON.stringify(localStorage)"
    other.wait_for_function(f"() => !({kept})().includes('{WORDS}')")


def test_half_an_hour_without_a_sign_shows_the_first_page(page: Page, visit: Any) -> None:
    page.clock.install()
    visit.straight_to_trial()
    page.clock.fast_forward(29 * 60 * 1000)
    page.mouse.move(30, 30)
    page.clock.fast_forward(29 * 60 * 1000)
    assert page.url.endswith("/trial/1")
    page.clock.fast_forward(2 * 60 * 1000)
    expect(page.get_by_role("link", name="Begin")).to_be_visible()
    page.goto(page.url + "trial/1")
    expect(page.get_by_role("link", name="Begin")).to_be_visible()


def test_withdrawing_clears_the_browser_too(site: Any, page: Page, visit: Any) -> None:
    visit.straight_to_trial()
    write_without_connection(page)
    assert WORDS in page.evaluate("() => JSON.stringify(localStorage)")
    page.goto(f"{site.url}/stop")
    page.get_by_label("Yes, remove everything that I have answered").check()
    page.get_by_role("button", name="Withdraw and remove my answers").click()
    expect(page.get_by_role("heading", name="You have withdrawn")).to_be_visible()
    page.wait_for_function("() => !Object.keys(localStorage).some((n) => /outbox|draft/.test(n))")
    assert WORDS not in page.evaluate(
        "() => JSON.stringify([{...localStorage}, {...sessionStorage}])"
    )
    assert site.people() == []
