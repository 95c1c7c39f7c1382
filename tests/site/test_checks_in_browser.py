"""The checks before the clips in a real Chromium: by keyboard alone, by the clock, left out."""

from __future__ import annotations

import json
import math
from importlib import resources
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect

from study.commands.self_test import make_self_test
from study.data import events, export
from study.design.definition import StudyDefinition, parse_definition
from study.design.patches import strip_levels
from study.design.plates import plates

AXE = (resources.files("axe_playwright_python") / "axe.min.js").read_text(encoding="utf-8")
STANDARDS = ("wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa")
RUN_AXE = f"async () => (await axe.run({{runOnly: {json.dumps(STANDARDS)}}})).violations"
# The gap's direction as somebody sees it: where the ring's middle line is white.
GAP = """() => {
  const ring = document.querySelector("[data-ring]");
  const [middle, gap] = [ring.width / 2, ring.width / 5];
  const pixels = ring.getContext("2d");
  const light = (turn) => pixels.getImageData(
    Math.round(middle + 2 * gap * Math.cos(turn * Math.PI / 4) - 0.5),
    Math.round(middle + 2 * gap * Math.sin(turn * Math.PI / 4) - 0.5), 1, 1).data[0];
  return [0, 1, 2, 3, 4, 5, 6, 7].sort((a, b) => light(b) - light(a))[0];
}"""
PAD = "63214789"  # the number pad's keys, from the right on clockwise
APART = """() => {
  const middle = (what) => {
    const box = document.querySelector(what).getBoundingClientRect();
    return box.x + box.width / 2;
  };
  return [middle("[data-fixation]"), middle("[data-dot]"), performance.now()];
}"""


@pytest.fixture
def definition(definition: StudyDefinition) -> StudyDefinition:
    """The small study with all checks."""
    checks = {
        "device_check": {"required": ["screen", "decoder", "contrast", "light"]},
        "calibration": {"repetitions": 3},
        "eyesight": {},
    }
    return parse_definition(json.loads(definition.to_json()) | checks)


def enter(page: Page, site: Any, *checks_done: str) -> Any:
    """Take the place of somebody who has come to the checks; returns their seed."""
    guest = site.guest()
    guest.get("/consent")
    fields = {"version": guest.hidden("version"), "agree": ["1", "2", "3"], "health": "yes"}
    guest.post("/consent", **fields)
    guest.post("/about-you", age="33")
    person = site.people()[0]
    for check in checks_done:
        done: dict[str, Any] = {"report": {}, "facts": {}}
        events.record(site.db, person, key=check, kind=check, payload=done)
    name = "ocularist_participant"
    cookie: Any = {"name": name, "value": guest.client.cookies[name], "url": site.url}
    guest.client.close()
    page.context.add_cookies([cookie])
    page.goto(f"{site.url}/continue")
    return person.seed


def tab_to(page: Page, what: str) -> None:
    """Press Tab until something has the focus."""
    for _ in range(40):
        if page.evaluate("(what) => document.activeElement.matches(what)", what):
            return
        page.keyboard.press("Tab")
    raise AssertionError(f"the keyboard does not reach {what}")


def press(page: Page, what: str) -> None:
    tab_to(page, what)
    page.keyboard.press("Enter")


def test_all_checks_are_passed_by_keyboard_alone(site: Any, page: Page) -> None:
    make_self_test(site.settings.media_folder)
    page.route("**/clips/*.mp4", lambda route: route.fulfill(body=b"x" * 600_000))
    seed = enter(page, site)
    look_at_the_screen(page, site, seed)
    measure(page)
    expect(page).to_have_url(f"{site.url}/eyesight")
    press(page, "[data-begin]")
    press(page, "[data-start=rings]")
    told: list[str] = []
    while page.locator("[data-stage=rings]").is_visible() and len(told) < 40:
        told.append(PAD[page.evaluate(GAP)])
        page.keyboard.press(told[-1])
    assert len(set(told)) > 3
    press(page, "[data-start=plates]")
    for number, plate in enumerate(plates(seed), 1):
        expect(page.locator("[data-plate-number]")).to_have_text(f"Disc {number} of 6")
        expect(page.locator("[data-plate]")).to_have_js_property("complete", True)
        page.keyboard.press(str(plate.digit))
    expect(page).to_have_url(f"{site.url}/instructions")

    row = export.tables(site.db, site.study).participants.iloc[0]
    assert 0 < row["colour_error"] <= 3
    assert row["codec"].startswith("avc1.")
    assert 10 < row["refresh_hz"] < 300
    assert row["mbit_s"] > 1
    assert (row["dark_steps"], row["light_steps"]) == (5, 5)
    # The card was set to 340 CSS pixels of 1.5 device pixels each, the eye is at 50 cm.
    assert row["mm_per_px"] == pytest.approx(85.6 / 340 / 1.5, rel=0.01)
    assert row["view_dist_cm"] == pytest.approx(50, abs=1)
    assert row["smallest_gap_px"] == 2
    assert row["smallest_gap_arcmin"] == pytest.approx(2 * 60 * 0.168 / 500 * 57.3, rel=0.03)
    read = [row[f"{kind}_plates_read"] for kind in ("control", "protan", "deutan", "tritan")]
    assert read == [1, 2, 2, 1]


def look_at_the_screen(page: Page, site: Any, seed: int) -> None:
    """Meet the gate once, follow its remedy, and go on."""
    go_on = page.locator("[data-actions] button[type=submit]")
    expect(go_on).to_be_visible()
    for item in ("device", "screen", "refresh", "decoder"):
        verdict = page.locator(f"[data-item={item}]")
        if item != "refresh":  # a loaded machine shows few frames, and may
            expect(verdict).to_have_attribute("data-verdict", "good")
    tab_to(page, "[name=dark_counted]")
    page.keyboard.type(str(len(strip_levels(seed, "dark"))))
    tab_to(page, "[name=light_counted]")
    page.keyboard.type(str(len(strip_levels(seed, "light"))))
    tab_to(page, "[name=night_light]")
    page.keyboard.press("ArrowRight")
    expect(page.locator("[name=night_light][value=on]")).to_be_checked()
    expect(page.locator("[data-item=light] [data-remedy]")).to_be_visible()
    press(page, "[data-actions] button[type=submit]")
    expect(page.locator("[data-stopped]")).to_be_visible()
    expect(go_on).to_be_visible()
    expect(page.locator("[name=dark_counted]")).not_to_have_value("")  # what was answered stays
    tab_to(page, "[name=night_light]")
    page.keyboard.press("ArrowLeft")
    tab_to(page, "[name=hdr]")
    page.keyboard.press("Space")
    press(page, "[data-actions] button[type=submit]")
    expect(page).to_have_url(f"{site.url}/calibration")


def measure(page: Page) -> None:
    """Set the card twice, then find the blind spot with the arrow keys, for an eye at 50 cm."""
    for _ in range(2):
        tab_to(page, "#card-width")
        slider = page.locator("#card-width")
        while (width := float(slider.input_value())) != 340:
            far = abs(width - 340) > 80
            key = ("PageUp" if far else "ArrowUp") if width < 340 else None
            page.keyboard.press(key or ("PageDown" if far else "ArrowDown"))
        press(page, "[data-card-fits]")
    press(page, "[data-spot=by_key]")
    for number in range(3):
        for _ in range(200):
            mark, dot, _now = page.evaluate(APART)
            if is_gone(mark - 450, dot - 450):
                break
            page.keyboard.press("ArrowLeft")
        page.keyboard.press("Space")
        if number < 2:
            page.keyboard.press("Space")
    expect(page.locator("[data-result]")).to_contain_text("You sit about 50 cm from the screen")
    press(page, "[data-send] button[type=submit]")


def is_gone(mark_px: float, dot_px: float) -> bool:
    """Say whether an eye at 50 cm has lost the dot; places in CSS pixels from the middle."""
    mm = 85.6 / 340
    left, right = (math.atan((x * mm + 31.5) / 500) for x in (dot_px, mark_px))
    return math.degrees(right - left) >= 13.5


def test_the_dot_moves_by_the_clock_and_the_mark_makes_room(
    site: Any, page: Page, context: BrowserContext
) -> None:
    # Three of four frames are lost, as on a slow machine.
    context.add_init_script(
        """const real = requestAnimationFrame.bind(window);
        const thin = (n, done) => real((now) => (n ? thin(n - 1, done) : done(now)));
        window.requestAnimationFrame = (done) => thin(3, done);"""
    )
    enter(page, site, "device_check")
    page.locator("[data-to=diagonal]").click()
    page.locator("#diagonal").fill("900")
    page.locator("[data-stage=diagonal] button[type=submit]").click()
    expect(page.locator("[data-diagonal-fault]")).to_be_visible()
    page.locator("#diagonal").fill("10.7")
    page.locator("[data-stage=diagonal] button[type=submit]").click()
    page.locator("[data-spot=by_itself]").click()
    mark, begun, began = page.evaluate(APART)
    page.wait_for_function(f"() => performance.now() > {began + 1500}")
    _, dot, now = page.evaluate(APART)
    mm = 25.4 * 10.7 / (900**2 + 640**2) ** 0.5
    expected = 600 * 0.0524 / mm  # 3 degrees per second at 60 cm
    assert (begun - dot) / ((now - began) / 1000) == pytest.approx(expected, rel=0.2)
    # Nobody presses: the dot comes to the end, and the mark stands further to the right.
    expect(page.locator("[data-spot-news]")).to_contain_text("The dot reached the end.")
    page.locator("[data-next]").click()
    assert page.evaluate(APART)[0] > mark + 50
    page.locator("[data-spot-end]").click()
    page.get_by_label("I cannot cover one eye").check()
    page.locator("[data-stage=skip-distance] button[type=submit]").click()
    expect(page.locator("[data-result]")).to_contain_text("Your screen is about 22 cm wide.")
    page.locator("[data-send] button[type=submit]").click()
    expect(page).to_have_url(f"{site.url}/eyesight")
    row = export.tables(site.db, site.study).participants.iloc[0]
    assert (row["scale_method"], row["calibration_skipped"]) == ("diagonal", "one_eye")


def test_less_motion_is_offered_first_to_those_who_wish_it(site: Any, page: Page) -> None:
    enter(page, site, "device_check")
    first = page.locator("[data-stage=distance] .actions button").first
    expect(first).to_have_attribute("data-spot", "by_itself")
    page.emulate_media(reduced_motion="reduce")
    page.reload()
    expect(first).to_have_attribute("data-spot", "by_key")


def test_an_enlarged_page_is_told_and_makes_no_larger_screen(site: Any, page: Page) -> None:
    enter(page, site)
    # A window of 1125 pixels that shows 900 of the page's: 125 %, as Chromium tells it.
    page.add_init_script("Object.defineProperty(window, 'outerWidth', { value: 1125 })")
    page.reload()
    zoom = page.locator("[data-item=window]")
    expect(zoom).to_have_attribute("data-verdict", "bad")
    expect(zoom.locator("[data-found]")).to_have_text("125 %, pixel ratio 1.5")
    expect(zoom.locator("[data-remedy]")).to_contain_text("Press Ctrl and 0")
    expect(page.locator("[data-item=screen] [data-found]")).to_contain_text("1080 × 768 pixels")


def test_a_phone_is_told_to_come_back_at_a_computer(
    site: Any, page: Page, chromium: Browser
) -> None:
    enter(page, site)
    cookies: Any = page.context.cookies()
    size: Any = {"width": 390, "height": 844}
    phone = chromium.new_context(viewport=size, screen=size, is_mobile=True, has_touch=True)
    page.close()
    small = phone.new_page()
    small.goto(site.url)
    expect(small.locator(".when-phone")).to_be_visible()
    phone.add_cookies(cookies)
    small.goto(f"{site.url}/device-check")
    expect(small.locator("[data-item=device]")).to_have_attribute("data-verdict", "bad")
    expect(small.locator("[data-item=device] [data-remedy]")).to_be_visible()
    expect(small.locator("[data-actions]")).to_be_visible()
    phone.close()


def test_an_eyesight_test_can_be_left_out_at_every_step(site: Any, page: Page) -> None:
    enter(page, site, "device_check", "calibration")
    page.locator("[data-begin]").click()
    page.locator("[data-stage=rings-intro] [data-skip]").click()
    page.locator("[data-start=plates]").click()
    page.locator("[data-digit='']").click()
    expect(page.locator("[data-plate-number]")).to_contain_text("2 of 6")
    page.locator("[data-stage=plates] [data-skip]").click()
    expect(page).to_have_url(f"{site.url}/instructions")
    [report] = [
        event.payload["report"]
        for event in events.history(site.db, site.people()[0])
        if event.kind == "eyesight"
    ]
    assert (report["rings_skipped"], report["plates_skipped"], report["digits"]) == (True, True, [])


SEEN_WHOLE = """(what) => {
  const [part, place] = [document.querySelector(what), document.querySelector(what).parentElement];
  const [inner, outer] = [part, place].map((one) => one.getBoundingClientRect());
  const { clientHeight } = document.documentElement;
  return outer.left <= inner.left && inner.right <= outer.right && outer.top <= inner.top
    && inner.bottom <= outer.bottom && inner.top >= 0 && inner.bottom <= clientHeight;
}"""
LAPTOPS: Any = ({"width": 1366, "height": 768}, {"width": 683, "height": 384})  # as it is, at 200 %


def test_the_largest_ring_and_every_plate_are_seen_whole(site: Any, page: Page) -> None:
    enter(page, site, "device_check", "calibration")
    page.locator("[data-begin]").click()
    page.locator("[data-start=rings]").click()
    for _ in range(5):  # one ring of the first size, two of each larger one
        page.locator("[data-direction='']").click()
    assert page.locator("[data-ring]").evaluate("(ring) => ring.width") == 5 * 40
    for size in LAPTOPS:
        page.set_viewport_size(size)
        assert page.evaluate(SEEN_WHOLE, "[data-ring]"), size
    page.locator("[data-stage=rings] [data-skip]").click()
    page.locator("[data-start=plates]").click()
    for size in LAPTOPS:
        page.set_viewport_size(size)
        assert page.evaluate(SEEN_WHOLE, "[data-plate]"), size


SHOWN = """(stage) => {
  for (const part of document.querySelectorAll("[data-stage]")) {
    part.hidden = part.dataset.stage !== stage;
  }
}"""
STAGES = {
    "calibration": ("card", "diagonal", "skip-card", "distance", "skip-distance", "result"),
    "eyesight": ("glasses", "rings-intro", "rings", "plates-intro", "plates"),
}


def faults_of(page: Page, name: str) -> list[str]:
    """Return what axe finds on a page, and whether it has to be scrolled sideways when zoomed."""
    page.evaluate(AXE)
    found = [
        f"{name}: {fault['id']}: {node['html'][:120]}"
        for fault in page.evaluate(RUN_AXE)
        for node in fault["nodes"]
    ]
    for width in (450, 320):  # this screen at 200 %, and WCAG 1.4.10's
        page.set_viewport_size({"width": width, "height": 640})
        if page.evaluate("() => document.documentElement.scrollWidth > innerWidth + 1"):
            found.append(f"{name}: wider than {width} px")
    page.set_viewport_size({"width": 900, "height": 640})
    return found


def test_every_stage_serves_everybody(site: Any, page: Page) -> None:
    seed = enter(page, site)
    found: list[str] = []
    for number in (1, 2):  # after the second try there is a way out
        expect(page.locator("[data-actions]")).to_be_visible()
        page.locator("[name=night_light][value=on]").check()
        page.locator("[data-actions] button[type=submit]").click()
        expect(page.locator("[data-leave]")).to_have_count(number - 1)
        expect(page.locator("[data-stopped]")).to_be_visible()
    expect(page.locator("[data-actions]")).to_be_visible()
    found += faults_of(page, "stopped")
    person = site.people()[0]
    for check, stages in STAGES.items():
        before = "device_check" if check == "calibration" else "calibration"
        done: dict[str, Any] = {"report": {}, "facts": {}}
        events.record(site.db, person, key=before, kind=before, payload=done)
        page.goto(f"{site.url}/{check}")
        for stage in stages:
            page.evaluate(SHOWN, stage)
            if stage == "plates":
                address = f"/eyesight/plates/{len(plates(seed))}.svg"
                page.locator("[data-plate]").evaluate("(plate, url) => (plate.src = url)", address)
            found += faults_of(page, stage)
        if check == "calibration":
            page.evaluate(SHOWN, "distance")
            page.locator("[data-spot=by_key]").click()
            found += faults_of(page, "spot")
    assert found == []
