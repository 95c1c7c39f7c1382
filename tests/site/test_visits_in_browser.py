"""Whole visits in a real Chromium: crashes, second tabs, plain http, keyboard, small screens."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Error, Page, expect

from study.data import completion, trials

NEXT = "Save and go to the next clip"
ELSEWHERE = "This study is open in another tab"


def answer(visit: Any, position: int, question: str) -> Any:
    """Return the answer that the site has stored, or None."""
    found = trials.at(visit.site.db, visit.site.people()[0], position)
    return None if found is None else found.answers.get(question)


def test_plain_http_under_a_host_name_is_enough(visit: Any, site: Any, page: Page) -> None:
    visit.to_trial(site.by_name)
    lacking = "() => [isSecureContext, typeof crypto.subtle, 'wakeLock' in navigator, "
    lacking += "'serviceWorker' in navigator]"
    assert page.evaluate(lacking) == [False, "undefined", False, False]
    visit.state("ready")
    visit.watch()
    visit.rate(2, 4)
    visit.saved()
    [play] = visit.recorded("played")
    assert (play["is_secure"], play["wake_lock"], play["source"]) == (False, "absent", "memory")
    assert play["clip_sha256"] == play["expected_sha256"]
    page.get_by_role("button", name=NEXT).click()
    expect(page).to_have_url(f"{site.by_name}/trial/2")
    assert answer(visit, 1, "rating_right") == 4


def test_a_second_tab_is_told_to_use_one(
    visit: Any, site: Any, page: Page, context: BrowserContext
) -> None:
    visit.straight_to_trial()
    visit.state("ready")
    second = context.new_page()
    second.goto(f"{site.url}/trial/1")
    heading = second.get_by_role("heading", name=ELSEWHERE)
    expect(heading).to_be_focused()
    expect(second.get_by_role("button", name="Play the clip")).to_be_hidden()
    expect(second.get_by_role("link", name="Stop")).to_be_in_viewport(ratio=1)

    # Both go on: the first with its clip, and the second, once it is asked to, with all of it.
    visit.watch()
    page.route("**/events", lambda route: route.abort())
    page.locator("input[name=rating_left][value='5']").check()
    visit.saved("Not yet saved – kept in this browser, trying again")
    second.get_by_role("button", name="Go on in this tab instead").click()
    expect(second.locator(".stage")).to_be_visible()
    expect(page.get_by_role("heading", name=ELSEWHERE)).to_be_visible()
    expect(second.locator(".saved [role=status]")).to_have_text("Saved")
    expect(second.locator("input[name=rating_left][value='5']")).to_be_checked()
    assert answer(visit, 1, "rating_left") == 5

    # The second is closed, and the first goes on by itself.
    page.unroute("**/events")
    second.close(run_before_unload=True)
    expect(page.locator(".stage")).to_be_visible()
    expect(page.locator("input[name=rating_left][value='5']")).to_be_checked()


def test_nothing_is_lost_in_a_crash(
    visit: Any, site: Any, page: Page, context: BrowserContext
) -> None:
    visit.straight_to_trial()
    visit.state("ready")
    visit.watch()
    visit.saved()
    page.route("**/events", lambda route: route.abort())
    visit.rate(2, 4)
    page.locator("[name=comments]").fill("The left one looks flat")
    page.get_by_role("button", name="Watch the clip again").click()
    visit.state("playing")
    with page.expect_event("crash"):
        crash(page)

    fresh = context.new_page()
    fresh.goto(f"{site.url}/trial/1")
    # The tab that crashed still has its lease for some seconds; then this one goes on by itself.
    expect(fresh.locator(".stage[data-state=watched]")).to_be_visible()
    expect(fresh.locator("[name=comments]")).to_have_value("The left one looks flat")
    expect(fresh.locator("input[name=rating_left][value='2']")).to_be_checked()
    expect(fresh.locator(".saved [role=status]")).to_have_text("Saved")
    assert answer(visit, 1, "rating_right") == 4
    assert answer(visit, 1, "comments") == "The left one looks flat"
    plays = visit.recorded("played")
    assert [play["ended_by"] for play in plays] == ["end", "lost"]
    fresh.close()


def crash(page: Page) -> None:
    """Let the page's process die, as a browser's crash does."""
    with pytest.raises(Error, match="crash"):
        page.goto("chrome://crash")


def test_what_was_typed_survives_a_reload_without_a_connection(visit: Any, page: Page) -> None:
    visit.straight_to_trial()
    visit.state("ready")
    visit.watch()
    page.route("**/events", lambda route: route.fulfill(status=503, body="restarting"))
    page.locator("input[name=noticed][value=yes]").check()
    page.locator("[name=what_differed]").press_sequentially("lashes")
    page.reload()
    expect(page.locator("[name=what_differed]")).to_have_value("lashes")
    expect(page.locator("input[name=noticed][value=yes]")).to_be_checked()
    page.unroute("**/events")
    visit.saved()
    assert answer(visit, 1, "what_differed") == "lashes"


def test_the_page_about_oneself_survives_a_reload(visit: Any, site: Any, page: Page) -> None:
    guest = site.guest()
    guest.agree()
    name = "ocularist_participant"
    cookie: Any = {"name": name, "value": guest.client.cookies[name], "url": site.url}
    guest.client.close()
    page.context.add_cookies([cookie])
    page.route("**/events", lambda route: route.abort())
    page.goto(f"{site.url}/about-you")
    page.get_by_label("How old are you?").press_sequentially("47")
    page.reload()
    expect(page.get_by_label("How old are you?")).to_have_value("47")
    page.unroute("**/events")
    page.get_by_role("button", name="Continue").click()
    expect(page).to_have_url(re.compile(r"/instructions$"))
    assert [about["answers"]["age"] for about in visit.recorded("about")] == [47]


def test_the_keyboard_alone_leads_through_the_trials(visit: Any, site: Any, page: Page) -> None:
    visit.straight_to_trial()
    for position in (1, 2, 3):
        expect(page).to_have_url(f"{site.url}/trial/{position}")
        visit.state("ready")
        tab_to(page, "Play the clip")
        page.keyboard.press("Enter")
        expect(page.get_by_role("button", name="Answer the questions")).to_be_focused()
        page.keyboard.press("Enter")
        page.keyboard.press("Tab")
        page.keyboard.press("Space")
        tab_to(page, "Finish" if position == 3 else NEXT)
        page.keyboard.press("Enter")
        expect(page.locator("[data-open-note]")).to_be_focused()
        tab_to(page, "Finish" if position == 3 else NEXT)
        page.keyboard.press("Enter")
    expect(page).to_have_url(f"{site.url}/thanks")
    code = page.locator("#completion-code")
    expect(code).to_have_text(completion.code(site.db, site.people()[0]) or "no code")
    assert [answer(visit, position, "comparison") for position in (1, 2, 3)] == [1, 1, 1]


def tab_to(page: Page, name: str) -> None:
    """Press the Tab key until the button of a name is reached."""
    for _ in range(40):
        if page.evaluate("document.activeElement.textContent.trim()") == name:
            return
        page.keyboard.press("Tab")
    pytest.fail(f"the Tab key does not lead to {name}")


def test_a_small_laptop_shows_everything(chromium: Browser, site: Any) -> None:
    screen: Any = {"width": 1366, "height": 768}
    with chromium.new_context(viewport=screen, screen=screen) as context:
        page = context.new_page()
        guest = site.guest()
        guest.walk_to_trial()
        name = "ocularist_participant"
        cookie: Any = {"name": name, "value": guest.client.cookies[name], "url": site.url}
        guest.client.close()
        context.add_cookies([cookie])
        page.goto(f"{site.url}/trial/1")
        button = page.get_by_role("button", name="Play the clip")
        expect(button).to_be_in_viewport(ratio=1)
        expect(page.get_by_role("link", name="Stop")).to_be_in_viewport(ratio=1)
        button.click()
        expect(page.get_by_role("button", name="Answer the questions")).to_be_in_viewport(ratio=1)
        page.get_by_role("button", name="Answer the questions").click()
        assert page.evaluate("document.documentElement.scrollWidth") <= 1366
        last = page.get_by_role("button", name=NEXT)
        last.scroll_into_view_if_needed()
        expect(last).to_be_in_viewport(ratio=1)
        expect(page.get_by_role("link", name="Stop")).to_be_in_viewport(ratio=1)
