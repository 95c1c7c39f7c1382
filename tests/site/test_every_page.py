"""Every page in both languages: what somebody meets from the first to the last, and researchers.

What is looked for is in ``tours``.
"""

from __future__ import annotations

import functools
import json
from collections.abc import Iterator
from typing import Any

import pytest
from full_study import full_definition
from playwright.sync_api import Browser, Page, Route, expect
from tours import LANGUAGES, LAPTOP, Tour, check_focus

from study.design.definition import StudyDefinition
from study.simulate import simulate


@pytest.fixture
def definition() -> StudyDefinition:
    """The study with every page."""
    return full_definition()


@pytest.fixture
def tour(chromium: Browser, site: Any) -> Iterator[Tour]:
    """A laptop's browser that nobody has used."""
    context = chromium.new_context(viewport=LAPTOP, screen=LAPTOP, locale="en-GB")
    context.set_default_timeout(60_000)
    yield Tour(context.new_page(), site)
    context.close()


def walk_to_the_clips(tour: Tour) -> None:
    """Look at every page before the clips."""
    page = tour.page
    tour.look("landing", "/")
    expect(page.locator(".when-less-motion")).to_be_hidden()
    page.emulate_media(reduced_motion="reduce")
    expect(page.locator(".when-less-motion")).to_be_visible()
    page.emulate_media(reduced_motion="no-preference")
    tour.look("declined", "/declined")
    tour.look("problem", "/no-such-page")
    tour.look("problem-link", "/link/nobody-has-this-link")
    tour.look("consent", "/consent")
    for box in page.get_by_role("checkbox").all():
        box.check()
    tour.press("I agree and want to take part")
    expect(page).to_have_url(f"{tour.site.url}/about-you")
    tour.look("about")
    page.get_by_label("How old are you?").fill("7")
    tour.press("Continue")
    expect(page.locator(".fault").first).to_be_visible()
    tour.check("about-fault")
    page.get_by_label("How old are you?").fill("33")
    tour.press("Continue")
    for check in ("device_check", "calibration", "eyesight"):
        page.wait_for_url(f"**/{check.replace('_', '-')}")
        tour.look(check)
        tour.done(check)
    tour.look("instructions")
    tour.press("I am ready")
    page.wait_for_url("**/preparing")
    look_at_waiting(tour)


def fulfil(body: str, route: Route) -> None:
    """Answer instead of the site."""
    route.fulfill(body=body)


def look_at_waiting(tour: Tour) -> None:
    """Look at the page that waits for clips, in every state it can be in."""
    waiting = {"fits": True, "is_ready": False, "progress": 0.4, "wait": "…", "clips": []}
    for name, news in (("waiting", waiting), ("small-screen", waiting | {"fits": False})):
        answer = functools.partial(fulfil, json.dumps(news))
        tour.page.route("**/preparing/state*", answer)
        tour.look(f"preparing-{name}", "/preparing")
        tour.page.unroute("**/preparing/state*")
    tour.page.goto(f"{tour.site.url}/preparing")
    expect(tour.page.locator("form button")).to_be_visible()
    tour.look("preparing-ready", "/preparing")


def watch(page: Page) -> None:
    """Watch the clip to its end."""
    page.locator(".card[data-when=ready] [data-play]").click()
    expect(page.locator(".stage")).to_have_attribute("data-state", "watched")


def finish_trial(page: Page) -> None:
    """Answer nothing and confirm it."""
    page.locator("form [type=submit]").click()
    page.locator("[data-open-note]").wait_for()
    page.locator("form [type=submit]").click()


def look_at_a_trial(tour: Tour) -> None:
    """Look at a trial before, after and below its clip."""
    page = tour.page
    tour.look("trial-ready", "/trial/1")
    watch(page)
    tour.check("trial-watched")
    for language in reversed(LANGUAGES):
        tour.speak(language)
        page.goto(f"{tour.site.url}/trial/1")
        page.locator(".card[data-when=watched] [data-to-questions]").click()
        tour.check("trial-questions", language)
        check_left_and_right(page)
    check_focus(tour)
    page.locator("input[name=rating_left][value='5']").check()
    expect(page.get_by_label("How sure are you?")).to_be_visible()
    page.locator("form [type=submit]").click()
    tour.check("trial-open")
    page.locator("form [type=submit]").click()
    page.wait_for_url("**/trial/2")


def check_left_and_right(page: Page) -> None:
    """Whatever the language, what is about the left eye stands on the left."""
    for stem in ("rating", "detail_iris"):
        boxes = [page.locator(f"fieldset[data-expected={stem}_{eye}]") for eye in ("left", "right")]
        left, right = (box.bounding_box() for box in boxes)
        assert left is not None
        assert right is not None
        assert left["x"] + left["width"] <= right["x"]


def walk_to_the_end(tour: Tour) -> None:
    """Look at pauses, stops and ends."""
    page = tour.page
    watch(page)
    finish_trial(page)
    page.wait_for_url("**/pause")
    tour.look("attention", "/pause")
    page.locator("input[type=radio]").first.check()
    page.locator("form [type=submit]").click()
    expect(page.locator("main[data-kind=break], main")).to_be_visible()
    page.goto(f"{tour.site.url}/continue")
    tour.look("break", "/pause")
    page.locator("form [type=submit]").click()
    page.wait_for_url("**/trial/3")
    tour.look("landing-under-way", "/")
    tour.look("next", "/next")
    tour.look("stop", "/stop")
    page.goto(f"{tour.site.url}/continue")
    watch(page)
    finish_trial(page)
    page.wait_for_url("**/thanks")
    tour.look("thanks")
    tour.look("landing-over", "/")
    tour.look("stop-over", "/stop")
    page.locator("input[name=sure]").check()
    page.locator("form [type=submit]").last.click()
    page.wait_for_url("**/withdrawn")
    tour.check("withdrawn")
    page.goto(f"{tour.site.url}/next")
    tour.check("next-withdrawn")
    end_and_keep(tour)


def end_and_keep(tour: Tour) -> None:
    """Look at the last page of somebody who ends before the end."""
    guest = tour.site.guest()
    guest.agree()
    name = "ocularist_participant"
    cookie: Any = {"name": name, "value": guest.client.cookies[name], "url": tour.site.url}
    guest.client.close()
    tour.page.context.add_cookies([cookie])
    tour.page.goto(f"{tour.site.url}/stop")
    tour.press("End and keep my answers")
    expect(tour.page.get_by_text("The answers you gave are kept.")).to_be_visible()
    tour.check("stopped")


def look_at_the_dashboard(tour: Tour) -> None:
    """Look at every page of the researcher, in English, with people on them."""
    page = tour.page
    simulate(tour.site.db, tour.site.study.definition, participants=4, seed=1)
    page.goto(f"{tour.site.url}/researcher")
    tour.check("researcher-sign-in")
    page.get_by_label("Name").fill("ada")
    page.get_by_label("Password").fill("correct horse battery")
    page.get_by_role("button", name="Sign in").click()
    tour.check("researcher-overview")
    for name in ("people", "clips", "results", "data"):
        page.goto(f"{tour.site.url}/researcher/{name}")
        tour.check(f"researcher-{name}")
    page.goto(f"{tour.site.url}/researcher/clips")
    page.locator("main a[href^='/researcher/clips/']").first.click()
    tour.check("researcher-clip")
    page.goto(f"{tour.site.url}/researcher/results")
    page.get_by_role("checkbox").check()
    page.locator("main form button").first.click()
    page.goto(f"{tour.site.url}/researcher/results?data=simulated")
    tour.check("researcher-results-shown")


def test_every_page_serves_everybody_in_every_language(tour: Tour) -> None:
    walk_to_the_clips(tour)
    tour.speak("en")
    tour.page.goto(f"{tour.site.url}/preparing")
    tour.press("Start with the whole screen")
    tour.page.wait_for_url("**/trial/1")
    look_at_a_trial(tour)
    walk_to_the_end(tour)
    look_at_the_dashboard(tour)
    assert len(tour.seen) > 50
    assert "\n".join(tour.faults) == ""
