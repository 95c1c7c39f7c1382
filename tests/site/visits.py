"""A participant in a real browser: from the first page to a rating."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from playwright.sync_api import Page, expect
from serving import Site

from study.data import events


@dataclass
class Visit:
    """A participant in a real browser."""

    page: Page
    site: Site

    def to_preparing(self, url: str | None = None) -> None:
        """Go from the first page to the clips."""
        self.page.goto(url or self.site.url)
        self.page.get_by_role("link", name="Begin").click()
        agree = self.page.get_by_role("button", name="I agree and want to take part")
        expect(agree).to_be_visible()  # all() does not wait: on the page before there is no box
        for box in self.page.get_by_role("checkbox").all():
            box.check()
        agree.click()
        self.page.get_by_label("How old are you?").fill("33")
        self.page.get_by_role("button", name="Continue").click()
        self.page.get_by_role("button", name="I am ready").click()

    def to_trial(self, url: str | None = None) -> None:
        """Go from the first page to the practice trial."""
        self.to_preparing(url)
        self.page.get_by_role("button", name="Start with the whole screen").click()
        expect(self.page).to_have_url(f"{url or self.site.url}/trial/1")

    def straight_to_trial(self) -> None:
        """Open the practice trial as somebody who came there without a browser."""
        guest = self.site.guest()
        guest.walk_to_trial()
        name = "ocularist_participant"
        cookie: Any = {"name": name, "value": guest.client.cookies[name], "url": self.site.url}
        guest.client.close()
        self.page.context.add_cookies([cookie])
        self.page.goto(f"{self.site.url}/trial/1")

    def state(self, name: str) -> None:
        """Wait until the stage is in a state."""
        expect(self.page.locator(".stage")).to_have_attribute("data-state", name)

    def play(self) -> None:
        """Start the clip."""
        self.page.get_by_role("button", name="Play the clip").click()

    def watch(self) -> None:
        """Watch the clip to its end."""
        self.play()
        self.state("watched")

    def rate(self, left: int, right: int) -> None:
        """Answer every question but those for text."""
        self.page.locator(f"input[name=rating_left][value='{left}']").check()
        self.page.locator(f"input[name=rating_right][value='{right}']").check()
        self.page.locator("input[name=comparison][value='1']").check()
        self.page.locator("input[name=noticed][value=no]").check()

    def saved(self, text: str = "Saved") -> None:
        """Wait until the strip says something about what is saved."""
        expect(self.page.locator(".saved [role=status]")).to_have_text(text)

    def recorded(self, kind: str) -> list[dict[str, Any]]:
        """Return what the site has stored of one kind, oldest first."""
        person = self.site.people()[0]
        return [dict(e.payload) for e in events.history(self.site.db, person) if e.kind == kind]
