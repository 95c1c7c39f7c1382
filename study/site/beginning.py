"""The first page and the consent: what this is, who takes part, on what terms."""

from __future__ import annotations

import math
from typing import Annotated, Final

from fastapi import APIRouter, Depends, Request
from fastapi.responses import HTMLResponse, Response

from study.data import participants, progress
from study.data.studies import Study
from study.design.definition import StudyDefinition
from study.site.access import (
    PARTICIPANT_COOKIE,
    REMEMBER_S,
    ForgedError,
    MaybeVisitor,
    redirect,
    remember,
    to_current,
)
from study.site.browsers import browser_family
from study.site.forms import first, read_form
from study.site.frame import shared
from study.site.language import Wishes, language_of, remember_language
from study.site.place import Here
from study.site.signatures import SIMULATION_HEADER, is_simulation_token
from study.texts import catalogue

router = APIRouter(default_response_class=HTMLResponse)

QUESTIONNAIRE_S: Final = 45  # for one clip's questions, by our own trials
AROUND_S: Final = 150  # for everything before and after the clips


def minutes_of(definition: StudyDefinition) -> int:
    """Estimate how long taking part takes, rounded up to five minutes."""
    one_s = 1.5 * definition.orbit.duration_s + QUESTIONNAIRE_S
    return 5 * math.ceil((AROUND_S + len(definition.every_clip) * one_s) / 300)


@router.get("/")
def landing(here: Here, visitor: MaybeVisitor, wishes: Wishes) -> Response:
    """Say in plain words what this is."""
    study = visitor.study if visitor else here.study(wishes)
    page = here.page(
        "participant/landing.html",
        **shared(study, visitor, "landing", wishes=wishes),
        is_under_way=visitor is not None and not visitor.is_over,
        is_over=visitor is not None and visitor.is_over,
        clip_count=len(study.definition.every_clip),
        minutes=minutes_of(study.definition),
    )
    remember_language(page, language_of(study, wishes))
    return page


@router.get("/consent")
def consent(here: Here, visitor: MaybeVisitor, wishes: Wishes) -> Response:
    """Show what a participant agrees to."""
    if visitor is not None:
        return to_current(here, visitor)
    return _consent_page(here, wishes)


def _consent_page(here: Here, wishes: tuple[str, ...], *, fault: str = "") -> Response:
    """Show the consent; ``fault`` is the key of what to say about a form that was sent."""
    study = here.study(wishes)
    frame = shared(study, None, "consent", wishes=wishes)
    return here.page(
        "participant/consent.html",
        status=422 if fault else 200,
        **frame,
        consent=study.definition.consent,
        statements=statements_of(study, language_of(study, wishes)),
        fault=frame["text"](fault) if fault else "",
    )


def statements_of(study: Study, language: str) -> tuple[str, ...]:
    """Return the sentences to tick; at least one, because agreement has to be explicit."""
    return study.definition.consent.statements or (catalogue(language).text("consent.statement"),)


@router.post("/consent")
def agree(
    request: Request,
    here: Here,
    visitor: MaybeVisitor,
    wishes: Wishes,
    fields: Annotated[dict[str, list[str]], Depends(read_form)],
) -> Response:
    """Enrol a participant who agrees to everything in the version that they read."""
    if visitor is not None:  # a double click, or Back and send again
        return to_current(here, visitor)
    study = here.study(wishes)
    language = language_of(study, wishes)
    statements = statements_of(study, language)
    if first(fields, "version") != study.definition.consent.version:
        return _consent_page(here, wishes, fault="consent.changed")
    if len(set(fields.get("agree", ()))) < len(statements):
        return _consent_page(here, wishes, fault="consent.tick_all")
    with here.db.writing():
        enrolment = participants.enrol(
            here.db,
            study,
            simulated=_is_simulated(request, here),
            language=language,
            device={"user_agent_family": browser_family(request.headers.get("user-agent", ""))},
        )
        progress.give_consent(
            here.db,
            enrolment.participant,
            key="consent",
            payload={"statements": list(statements)},
        )
    answer = redirect("/continue")
    remember(request, answer, PARTICIPANT_COOKIE, enrolment.token, REMEMBER_S)
    return answer


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
    return here.page(
        "participant/ended.html",
        **frame,
        heading=frame["text"]("declined.heading"),
        lines=[frame["text"]("declined.nothing_stored")],
        offer="start",
    )
