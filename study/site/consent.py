"""The consent: shown, agreed to in the version that was read, or declined."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Depends, Request
from fastapi.responses import HTMLResponse, Response

from study.data import entrance, limits, progress
from study.data.refusals import LinkUsedError
from study.data.studies import Study
from study.site.access import (
    PARTICIPANT_COOKIE,
    REMEMBER_S,
    ForgedError,
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
    person_key,
    to_store,
)
from study.site.browsers import browser_family
from study.site.consent_words import consent_words
from study.site.forms import first, read_form
from study.site.frame import shared
from study.site.language import Wishes, language_of
from study.site.place import Here
from study.site.problems import problem_page
from study.site.signatures import (
    SIMULATION_HEADER,
    is_simulation_token,
    sign_participant,
    who_hash,
)
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
    if not is_let_in(here.study(wishes), arrival) and not _is_simulated(request, here):
        return redirect("/")
    return _consent_page(here, wishes)


def _consent_page(
    here: Here,
    wishes: tuple[str, ...],
    *,
    fault: str = "",
    fields: dict[str, list[str]] | None = None,
) -> Response:
    """Show the consent; ``fault`` is the key of what to say about a form that was sent."""
    study = here.study(wishes)
    frame = shared(study, None, "consent", wishes=wishes)
    given = fields or {}
    return here.page(
        "participant/consent.html",
        status=422 if fault else 200,
        **frame,
        consent=study.definition.consent,
        words=consent_words(study.definition, catalogue(language_of(study, wishes))),
        ticked=given.get("agree", ()),
        is_health_ticked=first(given, "health") == "yes",
        fault=frame["text"](fault) if fault else "",
    )


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
    if not is_let_in(study, arrival) and not _is_simulated(request, here):
        return redirect("/")
    terms = study.definition.consent
    if first(fields, "version") != terms.version:
        return _consent_page(here, wishes, fault="consent.changed")
    if len(set(fields.get("agree", ()))) < terms.tick_count:
        return _consent_page(here, wishes, fault="consent.tick_all", fields=fields)
    try:
        credential = _enter(request, here, study, arrival, wishes=wishes, fields=fields)
    except LinkUsedError:
        return problem_page(request, status=410, code="LINK-USED")
    answer = redirect("/continue")
    remember(request, answer, PARTICIPANT_COOKIE, credential, REMEMBER_S)
    answer.delete_cookie(ARRIVAL_COOKIE)
    return answer


def _enter(
    request: Request,
    here: Here,
    study: Study,
    arrival: Arrival,
    *,
    wishes: tuple[str, ...],
    fields: dict[str, list[str]],
) -> str:
    """Enrol or find the person, with their consent; returns what proves who they are."""
    simulated = _is_simulated(request, here)
    if not simulated:
        address = request.client.host if request.client else ""
        limits.count(here.db, limits.JOINING, who_hash(here.secret, address))
    with here.db.writing():
        arrived = entrance.enter(
            here.db,
            study,
            arrival=to_store(here.secret, study, arrival.values),
            person_key=person_key(here.secret, study, arrival.values),
            link=arrival.link,
            simulated=simulated,
            language=language_of(study, wishes),
            device={"user_agent_family": browser_family(request.headers.get("user-agent", ""))},
        )
        if arrived.token is None:  # somebody who agreed when they first came
            return sign_participant(here.secret, arrived.participant.public_id)
        payload = _agreement(study, language_of(study, wishes), fields)
        progress.give_consent(here.db, arrived.participant, key="consent", payload=payload)
    return arrived.token


def _agreement(study: Study, language: str, fields: dict[str, list[str]]) -> dict[str, Any]:
    """Return what is kept of the agreement: which text, in which language, and what was ticked."""
    words = consent_words(study.definition, catalogue(language))
    terms = study.definition.consent
    health = None if terms.health is None else first(fields, "health") == "yes"
    return {
        "statements": list(words.statements),
        "minimum_age": terms.minimum_age,
        "health": health,
        "language": language,
        "text_sha256": words.sha256,
    }


def _is_simulated(request: Request, here: Here) -> bool:
    """Say whether this participant is simulated; a token that is not ours is refused outright."""
    token = request.headers.get(SIMULATION_HEADER)
    if token is not None and not is_simulation_token(here.secret, token):
        raise ForgedError
    return token is not None


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
