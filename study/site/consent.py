"""The consent: shown, agreed to in the version that was read, or declined."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Annotated

from fastapi import APIRouter, Depends, Request
from fastapi.responses import HTMLResponse, Response

from study.data.refusals import FormUsedError, LinkUsedError
from study.data.studies import Study
from study.site.access import (
    PARTICIPANT_COOKIE,
    REMEMBER_S,
    MaybeVisitor,
    redirect,
    remember,
    to_current,
)
from study.site.arrival import (
    ARRIVAL_COOKIE,
    Arrival,
    Arrived,
    is_let_in,
    keep_arrival,
)
from study.site.consent_words import consent_words
from study.site.forms import first, read_form
from study.site.frame import shared
from study.site.joining import is_simulated, join
from study.site.language import Wishes, language_of
from study.site.place import Here
from study.site.problems import problem_page
from study.site.signatures import sign_ticket
from study.texts import catalogue

router = APIRouter(default_response_class=HTMLResponse)
Fields = Annotated[dict[str, list[str]], Depends(read_form)]


@router.get("/consent")
def consent(
    request: Request, here: Here, visitor: MaybeVisitor, arrival: Arrived, wishes: Wishes
) -> Response:
    """Show what a participant agrees to."""
    if visitor is not None and not visitor.is_released:
        return to_current(here, visitor)
    if not is_let_in(here.study(wishes), arrival) and not is_simulated(request, here):
        return redirect("/")
    return _consent_page(request, here, arrival=arrival, wishes=wishes)


def _consent_page(
    request: Request,
    here: Here,
    *,
    arrival: Arrival,
    wishes: tuple[str, ...],
    fault: str = "",
    fields: dict[str, list[str]] | None = None,
) -> Response:
    """Show the consent; ``fault`` is the key of what to say about a form that was sent."""
    study, arrival = here.study(wishes), arrival.with_ticket()
    frame = shared(study, None, "consent", wishes=wishes)
    given = fields or {}
    page = here.page(
        "participant/consent.html",
        status=422 if fault else 200,
        **frame,
        ticket=sign_ticket(here.secret, arrival.ticket),
        consent=study.definition.consent,
        words=consent_words(study.definition, catalogue(language_of(study, wishes))),
        ticked=given.get("agree", ()),
        is_health_ticked=first(given, "health") == "yes",
        fault=frame["text"](fault) if fault else "",
    )
    keep_arrival(request, page, here, arrival)
    return page


@router.post("/consent")
def agree(
    request: Request,
    here: Here,
    *,
    visitor: MaybeVisitor,
    arrival: Arrived,
    wishes: Wishes,
    fields: Fields,
) -> Response:
    """Enrol a participant who agrees to everything in the version that they read."""
    if visitor is not None and not visitor.is_released:  # a double click, or Back and send again
        return to_current(here, visitor)
    study = here.study(wishes)
    if not is_let_in(study, arrival) and not is_simulated(request, here):
        return redirect("/")
    shown = partial(_consent_page, request, here, wishes=wishes)
    if fault := _fault(study, fields):
        # What was ticked under another text is not ticked under this one.
        kept = fields if fault == "consent.tick_all" else None
        return shown(arrival=arrival, fault=fault, fields=kept)
    try:
        credential = join(request, here, study, arrival, wishes=wishes, fields=fields)
    except LinkUsedError:
        return problem_page(request, status=410, code="LINK-USED")
    except FormUsedError:
        return shown(arrival=replace(arrival, ticket=""), fault="consent.again")
    answer = redirect("/continue")
    remember(request, answer, PARTICIPANT_COOKIE, credential, REMEMBER_S)
    answer.delete_cookie(ARRIVAL_COOKIE)
    return answer


def _fault(study: Study, fields: dict[str, list[str]]) -> str:
    """Return the key of what is wrong with a form, or nothing."""
    terms = study.definition.consent
    if first(fields, "version") != terms.version:
        return "consent.changed"
    return "consent.tick_all" if len(set(fields.get("agree", ()))) < terms.tick_count else ""


@router.get("/declined")
def declined(here: Here, wishes: Wishes) -> Response:
    """Say goodbye to someone who does not want to take part; nothing was stored."""
    frame = shared(here.study(wishes), None, "ended", wishes=wishes)
    answer = here.page(
        "participant/ended.html",
        **frame,
        heading=frame["text"]("declined.heading"),
        lines=[frame["text"]("declined.nothing_stored")],
        offer="start",
    )
    answer.delete_cookie(ARRIVAL_COOKIE)
    return answer
