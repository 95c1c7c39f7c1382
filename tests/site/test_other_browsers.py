"""Sessions in browsers as people have them: Firefox, WebKit as GTK has it, a Chromium that hides.

Playwright, which drives Chromium in the other tests, keeps every page visible and in focus; by its
own driver alone a tab is hidden when another one is opened.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from study.data import completion, events, export
from study.design.certificate import Verdict, judge

sys.path.append(str(Path(__file__).parent))
from drivers import ELEMENT, Browser, chromium, firefox, wait_for, webkit

pytestmark = [pytest.mark.long, pytest.mark.parametrize("database_kind", ["sqlite"])]


@dataclass
class Person:
    """Somebody at a browser, who does what the pages say."""

    browser: Browser

    def script(self, body: str) -> Any:
        return self.browser.ask("ExecuteScript", script=body, args=[])

    def wait_until(self, condition: str) -> None:
        wait_for(condition, lambda: self.script(f"return Boolean({condition})"))

    def wait_for_stage(self, *states: str) -> None:
        stage = "document.querySelector('.stage')?.dataset.state"
        self.wait_until(f"{json.dumps(states)}.includes({stage})")

    def press(self, selector: str) -> None:
        self.wait_until(f"document.querySelector({json.dumps(selector)})?.checkVisibility()")
        # WebKit's driver takes what lies half below the window's edge for out of reach.
        self.script(
            f"document.querySelector({json.dumps(selector)}).scrollIntoView({{block: 'center'}})"
        )
        found = self.browser.ask("FindElement", using="css selector", value=selector)
        self.browser.ask("ElementClick", id=found[ELEMENT])

    def wait_for_page(self, path: str) -> None:
        self.wait_until(f"location.pathname === '{path}' && document.readyState === 'complete'")

    def take_part(self, url: str, trials: int) -> None:
        self.browser.ask("Navigate", url=url)
        self.press("a[href='/consent']")
        self.wait_for_page("/consent")
        for number in (1, 2):
            self.press(f"input[name=agree][value='{number}']")
        self.press("form[action='/consent'] [type=submit]")
        self.wait_for_page("/about-you")
        self.press("form [type=submit]")
        self.wait_for_page("/instructions")
        self.press("form [type=submit]")
        self.wait_for_page("/preparing")
        self.press("form button")
        for number in range(1, trials + 1):
            self.wait_until(f"location.pathname === '/trial/{number}'")
            self.watch_and_rate()
        after = "/thanks" if trials == 3 else f"/trial/{trials + 1}"
        self.wait_until(f"location.pathname === '{after}'")

    def watch_and_rate(self) -> None:
        self.press("[data-when=ready] [data-play]")
        self.wait_for_stage("watched")
        self.press("[data-when=watched] [data-to-questions]")
        for name, value in {"rating_left": 2, "rating_right": 4, "comparison": 1}.items():
            self.press(f"input[name={name}][value='{value}']")
        self.press("input[name=noticed][value=no]")
        self.press("form [type=submit]")


def plays(site: Any) -> list[tuple[dict[str, Any], Verdict]]:
    """Return what was recorded of every play, and the study's verdict on it."""
    [person] = site.people()
    rule = site.study.definition.certificate
    history = events.history(site.db, person)
    records = [dict(event.payload) for event in history if event.kind == "played"]
    return [(record, judge(record, rule)) for record in records]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Where the browser of the test keeps its own."""
    made = tmp_path / "profile"
    made.mkdir()
    return made


@pytest.mark.parametrize(("start", "counted_by"), [(firefox, "callbacks"), (webkit, "frames")])
def test_a_whole_session_runs_in_another_browser(
    site: Any, folder: Path, *, start: Any, counted_by: str
) -> None:
    with start(folder) as browser:
        person = Person(browser)
        person.take_part(site.url, trials=3)
        code = person.script("return document.querySelector('#completion-code').textContent.trim()")
    assert code == completion.code(site.db, site.people()[0])
    ratings = export.tables(site.db, site.study).ratings
    assert sorted(ratings["rating"]) == [2, 2, 2, 4, 4, 4]
    assert len(plays(site)) == 3
    for record, _ in plays(site):
        assert record["counted_by"] == counted_by
        assert (record["is_complete"], record["source"]) == (True, "memory")
        assert 1 <= record["presented_frames"] <= record["expected_frames"]
        assert (record["shown_scale"], record["is_on_grid"]) == (1, True)
        assert (record["hidden_ms"], record["dropped_frames"]) == (0, 0)


@pytest.mark.parametrize(
    ("preferences", "counted_by"),
    [({"layout.frame_rate": 10}, "callbacks"), ({"media.rvfc.enabled": False}, "quality")],
)
def test_firefox_proves_nothing_where_it_cannot_tell_what_it_showed(
    site: Any, folder: Path, *, preferences: dict[str, Any], counted_by: str
) -> None:
    """Ten pictures a second cannot show thirty frames, and decoded frames are not shown ones."""
    with firefox(folder, **preferences) as browser:
        Person(browser).take_part(site.url, trials=1)
    [(record, verdict)] = plays(site)
    assert record["counted_by"] == counted_by
    assert verdict.certified is not True
    assert "not-counted" in verdict.reasons


def other_tab(browser: Browser) -> None:
    browser.ask("SwitchToWindow", handle=browser.ask("NewWindow", type="tab")["handle"])


def minimised(browser: Browser) -> None:
    browser.ask("MinimizeWindow")


@pytest.mark.parametrize("hide", [other_tab, minimised])
def test_a_clip_in_a_tab_that_is_truly_hidden_does_not_count(
    site: Any, folder: Path, hide: Callable[[Browser], None]
) -> None:
    guest = site.guest()
    guest.walk_to_trial()
    name = "ocularist_participant"
    cookie = {"name": name, "value": guest.client.cookies[name]}
    guest.client.close()
    with chromium(folder) as browser:
        person = Person(browser)
        browser.ask("Navigate", url=site.url)
        browser.ask("AddCookie", cookie=cookie)
        browser.ask("Navigate", url=f"{site.url}/trial/1")
        person.wait_for_stage("ready")
        person.script("document.querySelector('video').playbackRate = 0.25")  # time to hide it
        person.press("[data-when=ready] [data-play]")
        hide(browser)
        wait_for("the play's record", lambda: plays(site))
    [(record, verdict)] = plays(site)
    assert (record["ended_by"], record["was_hidden"]) == ("hidden", True)
    assert verdict.certified is False
    assert {"incomplete", "hidden"} <= set(verdict.reasons)
