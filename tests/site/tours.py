"""A tour through pages in a real Chromium: WCAG 2.2 AA by axe, zoom, focus, pictures.

PICTURES=docs/pictures/pages (as `make pictures` sets it) also writes a picture of each page.
"""

from __future__ import annotations

import io
import json
import os
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from typing import Any

from PIL import Image
from playwright.sync_api import Error, Page, expect
from sqlalchemy import update

from study.data import events
from study.data.schema import ParticipantRow

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
