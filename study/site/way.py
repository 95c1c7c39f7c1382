"""The way to the clips: its pages in order, who is at one of them, and what a form there changes.

A page is one look at the database and a form one errand, among those of everybody else.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse, Response

from study.data import checks, consents, participants, progress
from study.data.errands import Errand
from study.design.definition import StudyDefinition
from study.site.access import (
    ElsewhereError,
    Visitor,
    as_visitor,
    check_csrf,
    redirect,
    step_url,
)
from study.site.asker import Asker, by_cookie, found, locked, study_of
from study.site.casting import Frame, cast_page
from study.site.forms import Fields, first, read_form
from study.site.frame import shared
from study.site.place import Place, place_in

router = APIRouter(default_response_class=HTMLResponse)
Change = Callable[[Any, StudyDefinition], Errand[Any]]
"""What a form changes, given the participant's row, which is held for writing, and the study."""


@dataclass(frozen=True)
class AtStep:
    """Somebody at a step; ``has_health`` says whether they let us ask about health."""

    here: Place
    visitor: Visitor
    who: Any
    has_health: bool

    def marks(self, page: str) -> list[str]:
        """Return the marks of the way, for the page."""
        definition = self.visitor.study.definition
        return _marks(pages_before(definition, has_health=self.has_health), page)

    def page(
        self,
        name: str,
        *,
        own: Mapping[str, object],
        fixed: Callable[[Frame], Mapping[str, Any]],
        asked: tuple[Hashable, ...] = (),
    ) -> HTMLResponse:
        """Return a page of the way, with its marks; the rest is as ``cast_page`` says."""
        return cast_page(
            self.here,
            self.visitor.study,
            self.visitor,
            name,
            own=own,
            asked=(self.has_health, *asked),
            fixed=lambda frame: {**fixed(frame), "way": self.marks(name)},
        )


@dataclass(frozen=True)
class Sent:
    """A form, and who sent it; it carries the proof that it is theirs."""

    here: Place
    asker: Asker
    fields: Fields


async def at_step(request: Request, name: str) -> AtStep:
    """Return who asks for the page of a step; raises ElsewhereError if they are not there."""
    here = place_in(request)
    asker = by_cookie(request, here)
    who, has_health = await here.writer.look(partial(_look, request, here, asker, name))
    visitor = as_visitor(request, here, participants.record_of(who), asker.token)
    return AtStep(here, visitor, who, has_health)


def _look(request: Request, here: Place, asker: Asker, name: str) -> Errand[tuple[Any, bool]]:
    who = yield from found(request, here, asker)
    definition = study_of(here, who).definition
    step = yield from progress.stepping(who, definition)
    if step.name != name:
        raise ElsewhereError(step_url(step))
    has_health = definition.consent.health is None or (yield from consents.allowing_health(who.id))
    return who, has_health


@router.get("/continue")
async def lead(request: Request) -> Response:
    """Lead a participant to where they are; anybody else to the first page."""
    here = place_in(request)
    try:
        asker = by_cookie(request, here)
    except ElsewhereError:
        return redirect("/")
    return redirect(await here.writer.look(partial(_lead, here, asker)))


def _lead(here: Place, asker: Asker) -> Errand[str]:
    who = yield from participants.finding(asker.by, asker.value)
    if who is None:
        return "/"
    definition = study_of(here, who).definition
    is_idle = here.db.now() - who.last_seen_at > participants.IDLE
    if is_idle and definition.entrance.shared_computers:
        return "/"
    return step_url((yield from progress.stepping(who, definition)))


async def sent_form(request: Request) -> Sent:
    """Return a participant's posted form; raises ForgedError if it is not truly theirs."""
    here = place_in(request)
    asker = by_cookie(request, here)
    fields = await read_form(request)
    check_csrf(here.secret, asker.token, first(fields, "csrf"))
    return Sent(here, asker, fields)


async def go_on(request: Request, sent: Sent, change: Change) -> Response:
    """Store what a form changes, and lead to where its sender is then."""
    return redirect(step_url(await sent.here.writer.write(partial(_go_on, request, sent, change))))


def _go_on(request: Request, sent: Sent, change: Change) -> Errand[progress.Step]:
    who = yield from locked(request, sent.asker)
    definition = study_of(sent.here, who).definition
    yield from change(who, definition)
    return (yield from progress.stepping_on(who.id, definition))


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
