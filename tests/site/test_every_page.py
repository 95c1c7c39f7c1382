"""Every page in a real Chromium, in both languages: WCAG 2.2 AA by axe, zoom, focus, pictures.

PICTURES=docs/pictures/pages (as `make pictures` sets it) also writes a picture of each.
"""

from __future__ import annotations

import functools
import io
import json
import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from typing import Any

import pytest
from PIL import Image
from playwright.sync_api import Browser, Error, Page, Route, expect
from sqlalchemy import update

from study.data import events
from study.data.schema import ParticipantRow
from study.design.definition import StudyDefinition, parse_definition, read_definition
from study.simulate import simulate

LAPTOP: Any = {"width": 1366, "height": 768}
ZOOMED: Any = {"width": 683, "height": 384}  # the same screen at 200 %
NARROW: Any = {"width": 320, "height": 640}  # WCAG 1.4.10: 1280 px at 400 %
LANGUAGES = ("en", "ar")
STANDARDS = ("wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa")
AXE = (resources.files("axe_playwright_python") / "axe.min.js").read_text(encoding="utf-8")
RUN_AXE = f"async () => (await axe.run({{runOnly: {json.dumps(STANDARDS)}}})).violations"
# What tells that a page's script has come to rest.
SETTLES = {"device_check": ("[data-actions] [type=submit]",), "preparing-ready": ("form button",)}
PICTURES = os.environ.get("PICTURES")

PARTS = [{"id": "iris", "label": "Iris"}, {"id": "white", "label": "White of the eye"}]
MORE: list[dict[str, Any]] = [
    {
        "id": "where",
        "kind": "multiple",
        "text": "Where did you look?",
        "options": [
            {"value": "iris", "label": "At the iris"},
            {"value": "lids", "label": "At the lids"},
            {"value": "nowhere", "label": "Nowhere in particular", "is_exclusive": True},
        ],
    },
    {
        "id": "alive",
        "kind": "analogue",
        "text": "How alive do these eyes look?",
        "lowest_label": "not at all",
        "highest_label": "fully alive",
    },
    {
        "id": "detail",
        "kind": "matrix",
        "text": "How detailed is each part?",
        "labels": ["poor", "fair", "good"],
        "highest": 3,
        "rows": PARTS,
        "per_eye": True,
    },
    {
        "id": "confidence",
        "kind": "number",
        "text": "How sure are you?",
        "minimum": 0,
        "maximum": 1,
        "decimals": 2,
        "unit": "from 0 to 1",
        "shown_if": {"question": "rating_left", "at_least": 4},
    },
    {"id": "word", "kind": "text", "text": "One word for these eyes?", "is_long": False},
]
MORE_IN_ARABIC = {
    "where": {
        "text": "إلى أين نظرت؟",
        "options": {"iris": "إلى القزحية", "lids": "إلى الجفنين", "nowhere": "لا مكان بعينه"},
    },
    "alive": {
        "text": "كم تبدو هاتان العينان حيّتين؟",
        "lowest_label": "إطلاقًا",
        "highest_label": "تمامًا",
    },
    "detail": {
        "text": "ما مقدار التفاصيل في كل جزء؟",
        "labels": ["قليل", "متوسط", "جيد"],
        "rows": {"iris": "القزحية", "white": "بياض العين"},
    },
    "confidence": {"text": "ما مدى تأكدك؟", "unit": "من 0 إلى 1"},
    "word": {"text": "كلمة واحدة لهاتين العينين؟"},
}


@pytest.fixture
def definition(small_study: Any) -> StudyDefinition:
    """A study with every page and every kind of question, in English and Arabic."""
    lod = read_definition("lod").model_dump(mode="json", exclude_unset=True)
    thesis = read_definition("thesis").model_dump(mode="json", exclude_unset=True)
    small = small_study().model_dump(mode="json", exclude_unset=True)
    arabic = thesis["translations"]["ar"]
    more = {name: lod["translations"]["ar"][name] for name in ("breaks", "attention")}
    return parse_definition(
        small
        | {
            "breaks": lod["breaks"] | {"after": [1]},
            "attention": [lod["attention"][0] | {"after": 1}],
            "device_check": {},
            "calibration": {},
            "eyesight": {},
            "questions": [*small["questions"], *MORE],
            "translations": {
                "ar": arabic | more | {"questions": arabic["questions"] | MORE_IN_ARABIC}
            },
        }
    )


@dataclass
class Tour:
    """A browser on its way through every page; ``faults`` gathers what is wrong with them."""

    page: Page
    site: Any
    faults: list[str] = field(default_factory=list)
    seen: list[str] = field(default_factory=list)

    def look(self, name: str, path: str = "", *, languages: tuple[str, ...] = LANGUAGES) -> None:
        """Look at a page in both languages; what a form was answered with is lost."""
        for language in reversed(languages):
            self.speak(language)
            where = path or self.page.url.removeprefix(self.site.url).partition("?")[0]
            separator = "&" if "?" in where else "?"
            known = "" if self.site.people() else f"{separator}lang={language}"
            self.page.goto(f"{self.site.url}{where}{known}")
            self.check(name, language)

    def speak(self, language: str) -> None:
        """Let everybody who takes part speak another language."""
        with self.site.db.writing() as session:
            session.execute(update(ParticipantRow).values(language=language))

    def check(self, name: str, language: str = "en") -> None:
        """Check the page as it stands."""
        page, here = self.page, f"{name} ({language})"
        self.seen.append(here)
        page.wait_for_load_state()
        for part in SETTLES.get(name, ()):
            page.locator(part).wait_for()
        shown = (
            page.locator("html").get_attribute("lang"),
            page.locator("html").get_attribute("dir"),
        )
        expected = ("ar", "rtl") if language == "ar" else ("en", "ltr")
        if not name.startswith("researcher") and shown != expected:
            self.faults.append(f"{here}: is in {shown}")
        if PICTURES:
            keep_picture(page, Path(PICTURES) / f"{name}.{language}.png")
        for found in self.violations():
            for node in found["nodes"]:
                why = node["failureSummary"].replace("\n", " ")
                self.faults.append(f"{here}: {found['id']}: {node['html'][:120]}: {why[:200]}")
        for size in (ZOOMED, NARROW):
            self.check_reflow(here, size)
        page.set_viewport_size(LAPTOP)

    def violations(self) -> list[dict[str, Any]]:
        """Return what axe finds. A page may load itself anew, where it takes the tab over again."""
        for _ in range(5):
            try:
                expect(self.page.locator("[data-elsewhere]:visible")).to_have_count(0)
                self.page.evaluate(AXE)
                found: list[dict[str, Any]] = self.page.evaluate(RUN_AXE)
            except Error as error:
                if "context was destroyed" not in error.message:
                    raise
                self.page.wait_for_load_state()
            else:
                return found
        raise AssertionError(f"{self.page.url} does not come to rest")

    def check_reflow(self, here: str, size: Any) -> None:
        """Nothing has to be scrolled sideways, however narrow the window."""
        self.page.set_viewport_size(size)
        wide = self.page.evaluate(
            """() => document.documentElement.scrollWidth > innerWidth + 1
                 ? [...document.querySelectorAll("body *")]
                     .filter((e) => e.getBoundingClientRect().right > innerWidth + 1)
                     .map((e) => e.outerHTML.slice(0, 90)).slice(-1)[0] ?? "?" : null"""
        )
        if wide is not None:
            self.faults.append(f"{here}: wider than {size['width']} px: {wide}")

    def done(self, kind: str) -> None:
        """Finish a check before the clips without doing it, and go on."""
        payload = {"report": {}, "facts": {}}
        person = self.site.people()[-1]
        events.record(self.site.db, person, key=kind, kind=kind, payload=payload)
        self.page.goto(f"{self.site.url}/continue")

    def press(self, name: str) -> None:
        """Press a button or follow a link."""
        self.page.locator("button, a.button").get_by_text(name, exact=True).locator(
            "visible=true"
        ).first.click()


def keep_picture(page: Page, path: Path) -> None:
    """Write what is to be seen; pages of flat greys need no more than a palette."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with Image.open(io.BytesIO(page.screenshot())) as picture:
        picture.convert("RGB").quantize(96).save(path, optimize=True)


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


def check_focus(tour: Tour) -> None:
    """What the keyboard reaches is ringed and under nothing (WCAG 2.4.7, 2.4.11)."""
    page = tour.page
    for size in (LAPTOP, ZOOMED):
        page.set_viewport_size(size)
        page.locator("#questions-heading").focus()
        for _ in range(60):
            page.keyboard.press("Tab")
            found = page.evaluate(
                """() => {
                    const at = document.activeElement;
                    if (!at || at === document.body) return { end: true };
                    const seen = at.closest("label") ?? at;
                    const box = seen.getBoundingClientRect();
                    const there = document.elementFromPoint(
                        box.x + box.width / 2, box.y + Math.min(box.height / 2, innerHeight / 2));
                    const style = [at, seen].map((e) => getComputedStyle(e));
                    return {
                        name: at.outerHTML.slice(0, 90),
                        covered: !there || !(seen.contains(there) || there.contains(seen)),
                        ringed: style.some((s) => s.outlineStyle !== "none"),
                        end: at.type === "submit",
                    };
                }"""
            )
            if found.get("covered") or not found.get("ringed", True):
                tour.faults.append(f"focus at {size['width']} px: {found}")
            if found["end"]:
                break
    page.set_viewport_size(LAPTOP)


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
