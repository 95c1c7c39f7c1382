"""The way to the clips: its pages in order, and how far on it somebody is."""

from __future__ import annotations

from typing import Any

from study.data import checks, consents
from study.design.definition import StudyDefinition
from study.site.access import Visitor
from study.site.frame import shared
from study.site.place import Place


def on_the_way(here: Place, visitor: Visitor, page: str) -> dict[str, Any]:
    """Return what a page before the clips shows around its own content, with the steps' marks."""
    definition = visitor.study.definition
    has_health = definition.consent.health is None or consents.allows_health(
        here.db, visitor.participant
    )
    pages = pages_before(definition, has_health=has_health)
    return {**shared(visitor.study, visitor, page), "way": _marks(pages, page)}


def pages_before(definition: StudyDefinition, *, has_health: bool) -> tuple[str, ...]:
    """Return the pages between consent and clips; eyesight is left to those who agreed to it."""
    wanted = [name for name in checks.wanted(definition) if name != "eyesight" or has_health]
    about = ("about",) if definition.about else ()
    return (*about, *wanted, "instructions", "preparing")


def _marks(pages: tuple[str, ...], page: str) -> list[str]:
    """Return a mark per page; none where somebody is not on the way."""
    if page not in pages:
        return []
    at = pages.index(page)
    return ["done" if n < at else "now" if n == at else "ahead" for n in range(len(pages))]
