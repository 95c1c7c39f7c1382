"""The consent: shown, agreed to in the version that was read, or declined."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import HTMLResponse, Response

from study.data.refusals import FormUsedError, LinkUsedError
from study.data.studies import Study
from study.site.access import (
    PARTICIPANT_COOKIE,
    REMEMBER_S,
    redirect,
    remember,
    to_current,
    visitor_or_none,
)
from study.site.arrival import ARRIVAL_COOKIE, Arrival, arrival_of, is_let_in, keep_arrival
from study.site.casting import cast_page
from study.site.consent_words import consent_words
from study.site.forms import Fields, first, read_form
from study.site.frame import shared
from study.site.joining import is_simulated, join
from study.site.language import Wishes, language_of, wishes_of
from study.site.place import Here, Place, place_in
from study.site.problems import problem_page
from study.site.signatures import sign_ticket
from study.texts import catalogue

router = APIRouter(default_response_class=HTMLResponse)


@dataclass(frozen=True)
class Reader:
    """Whoever reads the consent: nobody yet, with what brought them and the languages they wish."""

    request: Request
    here: Place
    study: Study
    arrival: Arrival
    wishes: tuple[str, ...]


@router.get("/consent")
async def consent(request: Request) -> Response:
    """Show what a participant agrees to."""
    reader = await _reader(request)
    return reader if isinstance(reader, Response) else _consent_page(reader)


async def _reader(request: Request) -> Reader | Response:
    """Return who reads the consent; or the way on, for a participant and for who is not let in."""
    here = place_in(request)
    if PARTICIPANT_COOKIE in request.cookies:  # a double click, or Back and send again
        visitor = await run_in_threadpool(visitor_or_none, request, here)
        if visitor is not None and not visitor.is_released:
            return await run_in_threadpool(to_current, here, visitor)
    arrival, wishes = arrival_of(request, here), wishes_of(request)
    study = here.study(wishes)
    if not is_let_in(study, arrival) and not is_simulated(request, here):
        return redirect("/")
    return Reader(request, here, study, arrival, wishes)


def _consent_page(reader: Reader) -> Response:
    """Show the consent with nothing ticked."""
    arrival = reader.arrival.with_ticket()
    page = cast_page(
        reader.here,
        reader.study,
        None,
        "consent",
        own={"ticket": sign_ticket(reader.here.secret, arrival.ticket)},
        wishes=reader.wishes,
        fixed=lambda _frame: {**_terms(reader), **_UNTICKED},
    )
    keep_arrival(reader.request, page, reader.here, arrival)
    return page


def _terms(reader: Reader) -> dict[str, Any]:
    study = reader.study
    words = consent_words(study.definition, catalogue(language_of(study, reader.wishes)))
    return {"consent": study.definition.consent, "words": words}


_UNTICKED = {"ticked": (), "is_health_ticked": False, "fault": ""}


def _faulty_page(reader: Reader, fault: str, given: Fields) -> Response:
    """Show the consent again: ``fault`` is the key of what to say about the form that was sent."""
    arrival = reader.arrival.with_ticket()
    frame = shared(reader.study, None, "consent", wishes=reader.wishes)
    page = reader.here.page(
        "participant/consent.html",
        status=422,
        **frame,
        **_terms(reader),
        ticket=sign_ticket(reader.here.secret, arrival.ticket),
        ticked=given.get("agree", ()),
        is_health_ticked=first(given, "health") == "yes",
        fault=frame["text"](fault),
    )
    keep_arrival(reader.request, page, reader.here, arrival)
    return page


@router.post("/consent")
async def agree(request: Request) -> Response:
    """Enrol a participant who agrees to everything in the version that they read."""
    given, reader = await read_form(request), await _reader(request)
    if isinstance(reader, Response):
        return reader
    if fault := _fault(reader.study, given):
        # What was ticked under another text is not ticked under this one.
        kept = given if fault == "consent.tick_all" else {}
        return await run_in_threadpool(_faulty_page, reader, fault, kept)
    try:
        credential = await join(
            request, reader.here, reader.study, reader.arrival, wishes=reader.wishes, fields=given
        )
    except LinkUsedError:
        return problem_page(request, status=410, code="LINK-USED")
    except FormUsedError:
        anew = replace(reader, arrival=replace(reader.arrival, ticket=""))
        return await run_in_threadpool(_faulty_page, anew, "consent.again", {})
    answer = redirect("/continue")
    remember(request, answer, PARTICIPANT_COOKIE, credential, REMEMBER_S)
    answer.delete_cookie(ARRIVAL_COOKIE)
    return answer


def _fault(study: Study, fields: Fields) -> str:
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
