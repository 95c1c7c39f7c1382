"""The pages in a real Chromium: clips that play, answers that survive whatever happens."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright.sync_api import BrowserContext, Page, expect

from study.data import completion, events, export, trials


def test_a_session_survives_reload_back_double_click_and_a_lost_connection(
    site: Any, page: Page, visit: Any, context: BrowserContext
) -> None:
    visit.to_trial()
    visit.state("ready")
    expect(page.locator("input[name=rating_left]").first).to_be_disabled()
    visit.watch()
    shown = page.locator("video").bounding_box()
    assert shown is not None
    assert shown["width"] * 1.5 == pytest.approx(320, abs=0.05)
    # Layout counts in 1/64 CSS px; what is painted is the nearest whole device pixel.
    assert shown["x"] * 1.5 == pytest.approx(round(shown["x"] * 1.5), abs=0.05)

    # Answers given, then the page is reloaded: same trial, same answers, still unlocked.
    visit.rate(2, 4)
    visit.saved("Saved")
    page.reload()
    expect(page).to_have_url(f"{site.url}/trial/1")
    visit.state("watched")
    expect(page.locator("input[name=rating_left][value='2']")).to_be_checked()

    # A double click on the button finishes one trial, not two.
    page.get_by_role("button", name="Save and go to the next clip").dblclick()
    expect(page).to_have_url(f"{site.url}/trial/2")

    # Back leads to the present trial.
    page.go_back()
    page.goto(f"{site.url}/instructions")
    expect(page).to_have_url(f"{site.url}/trial/2")

    # Without a connection answers wait in the browser, say so, and arrive later.
    visit.state("ready")
    visit.watch()
    context.set_offline(True)
    visit.rate(1, 5)
    visit.saved("Not yet saved – kept in this browser, trying again")
    page.get_by_role("button", name="Save and go to the next clip").click()
    expect(page).to_have_url(f"{site.url}/trial/2")
    context.set_offline(False)
    expect(page).to_have_url(f"{site.url}/trial/3")

    visit.state("ready")
    visit.watch()
    visit.rate(3, 3)
    page.get_by_role("button", name="Finish").click()
    code = completion.code(site.db, site.people()[0]) if at_thanks(page, site) else None
    assert code is not None
    expect(page.locator("#completion-code")).to_have_text(code)

    tables = export.tables(site.db, site.study)
    ratings = tables.ratings.sort_values(["trial", "eye"])
    assert list(ratings["rating"]) == [2, 4, 1, 5, 3, 3]
    assert list(tables.comparisons["views"]) == [1, 1, 1]
    assert list(tables.ratings["shown_scale"].unique()) == [1.0]
    assert (tables.comparisons["response_ms"] > 0).all()
    finals = [
        e
        for e in events.history(site.db, site.people()[0])
        if e.kind == "answered" and e.payload["is_final"]
    ]
    assert [e.position for e in finals] == [1, 2, 3]
    kinds = {e.kind for e in events.history(site.db, site.people()[0])}
    assert "amended" not in kinds


def at_thanks(page: Page, site: Any) -> bool:
    expect(page).to_have_url(f"{site.url}/thanks")
    return True


def test_a_broken_clip_stops_with_a_code_and_a_next_step(site: Any, page: Page, visit: Any) -> None:
    visit.to_trial()
    page.route("**/clips/*.mp4", lambda route: route.fulfill(status=404))
    page.reload()
    visit.state("broken")
    again = page.locator(".card[data-when=broken]").get_by_role("button", name="Try again")
    expect(again).to_be_focused()
    expect(page.locator(".card[data-when=broken] .code")).to_have_text(
        re.compile(r"^P-[0-9A-Z]{8}-1-HTTP-404$")
    )
    visit.saved("Saved")
    page.unroute("**/clips/*.mp4")
    again.click()
    visit.state("ready")
    problems = [e.payload for e in events.history(site.db, site.people()[0]) if e.kind == "problem"]
    assert problems == [{"code": "CLIP-HTTP-404"}]


def test_a_cut_off_clip_is_not_shown(page: Page, visit: Any) -> None:
    visit.to_preparing()
    page.get_by_role("button", name="Start with the whole screen").wait_for()
    page.route("**/clips/*.mp4", lambda route: route.fulfill(status=416))
    page.reload()
    expect(page.get_by_text("A clip did not arrive.")).to_be_visible()
    expect(page.locator("[data-code]")).to_have_text("LOAD-HTTP-416")
    page.unroute("**/clips/*.mp4")
    page.get_by_role("button", name="Try again").click()
    expect(page.get_by_role("button", name="Start with the whole screen")).to_be_visible()


@pytest.mark.parametrize("are_clips_ready", [False])
def test_the_waiting_page_goes_on_by_itself(
    site: Any, page: Page, visit: Any, put_clips: Any
) -> None:
    visit.to_preparing()
    expect(page.get_by_text("The clips are still being made.")).to_be_visible()
    put_clips(site)
    expect(page.get_by_role("button", name="Start with the whole screen")).to_be_visible()


def test_questions_can_be_answered_with_the_keyboard_alone(
    site: Any, page: Page, visit: Any
) -> None:
    visit.to_trial()
    visit.state("ready")
    page.get_by_role("button", name="Play the clip").press("Enter")
    visit.state("watched")
    expect(page.get_by_role("button", name="Answer the questions")).to_be_focused()
    page.keyboard.press("Enter")
    page.keyboard.press("Tab")
    page.keyboard.press("Space")
    expect(page.locator("input[name=comparison][value='1']")).to_be_checked()
    page.keyboard.press("ArrowDown")
    expect(page.locator("input[name=comparison][value='-1']")).to_be_checked()
    visit.saved("Saved")
    page.get_by_role("button", name="Save and go to the next clip").press("Enter")
    note = page.locator("[data-open-note]")
    expect(note).to_be_focused()
    expect(note).to_contain_text("3 questions are still open.")
    page.get_by_role("button", name="Save and go to the next clip").press("Enter")
    expect(page).to_have_url(f"{site.url}/trial/2")


def test_a_shared_computer_waits_for_the_last_answers(
    site: Any, page: Page, visit: Any, context: BrowserContext
) -> None:
    visit.to_trial()
    visit.watch()
    page.route("**/events", lambda route: route.abort())
    page.locator("input[name=rating_left][value='5']").check()
    visit.saved("Not yet saved – kept in this browser, trying again")
    page.goto(f"{site.url}/next")
    expect(page.get_by_text("are still on their way")).to_be_visible()
    expect(page.get_by_role("button", name="Start for a new person")).to_be_disabled()
    page.unroute("**/events")
    expect(page.get_by_text("All answers of the last person are stored.")).to_be_visible()
    page.get_by_role("button", name="Start for a new person").click()
    expect(page.get_by_role("link", name="Begin")).to_be_visible()
    assert context.cookies() == []
    found = trials.at(site.db, site.people()[0], 1)
    assert found is not None
    assert found.answers["rating_left"] == 5


def test_the_dashboard_renews_itself(site: Any, page: Page) -> None:
    page.goto(f"{site.url}/researcher")
    page.get_by_label("Name").fill("ada")
    page.get_by_label("Password").fill("correct horse battery")
    page.get_by_role("button", name="Sign in").click()
    expect(page.locator("#people dd").first).to_have_text("0")
    person = site.guest()
    person.agree()
    person.client.close()
    expect(page.locator("#people dd").first).to_have_text("1")
    expect(page.locator("[data-stamp]")).to_contain_text("As of")


def test_ending_waits_for_the_last_answers(site: Any, page: Page, visit: Any) -> None:
    visit.to_trial()
    visit.watch()
    page.route("**/events", lambda route: route.abort())
    page.locator("input[name=rating_left][value='5']").check()
    visit.saved("Not yet saved – kept in this browser, trying again")
    page.goto(f"{site.url}/stop")
    page.get_by_role("button", name="End and keep my answers").click()
    page.unroute("**/events")
    expect(page.get_by_text("The answers you gave are kept.")).to_be_visible()
    found = trials.at(site.db, site.people()[0], 1)
    assert found is not None
    assert found.answers["rating_left"] == 5


@pytest.mark.parametrize("make_video", [lambda number: bytes(4000 + number)])
def test_a_clip_that_no_browser_can_read_is_told(page: Page, visit: Any) -> None:
    visit.to_trial()
    visit.state("broken")
    expect(page.get_by_text("Your answers so far are safe.")).to_be_visible()
    expect(page.locator(".card[data-when=broken] .code")).to_contain_text("DEMUXER")
