"""The first page: what this is, whether it is still the same person, who is let in."""

from __future__ import annotations

import math

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse, Response

from study.data import entrance, participants
from study.design.definition import StudyDefinition
from study.design.duration import minutes
from study.site.access import (
    PARTICIPANT_COOKIE,
    REMEMBER_S,
    AVisitor,
    MaybeVisitor,
    Visitor,
    VisitorsForm,
    redirect,
    remember,
    to_current,
)
from study.site.arrival import Arrival, Arrived, brought, is_let_in, person_key, to_first_page
from study.site.frame import shared
from study.site.language import Wishes
from study.site.place import Here
from study.site.signatures import sign_participant

router = APIRouter(default_response_class=HTMLResponse)


def minutes_of(definition: StudyDefinition) -> int:
    """Estimate how long taking part takes, rounded up to five minutes."""
    return 5 * math.ceil(minutes(definition) / 5)


def clips_of(definition: StudyDefinition) -> int:
    """Return how many clips one person watches."""
    return len(definition.practice) + definition.trial_count


def _allows_phones(definition: StudyDefinition) -> bool:
    check = definition.device_check
    return check is not None and check.allow_phones


@router.get("/")
def landing(
    request: Request, here: Here, visitor: MaybeVisitor, arrival: Arrived, wishes: Wishes
) -> Response:
    """Say in plain words what this is; take what the address brings."""
    study = here.study(wishes)
    if values := brought(request, study):
        return _arrive(request, here, visitor, values)
    staying = None if visitor is None or visitor.is_released else visitor
    study = staying.study if staying else study
    page = here.page(
        "participant/landing.html",
        **shared(study, staying, "landing", wishes=wishes),
        is_under_way=staying is not None and not staying.is_over,
        is_over=staying is not None and staying.is_over,
        is_let_in=is_let_in(study, arrival),
        allows_phones=_allows_phones(study.definition),
        clip_count=clips_of(study.definition),
        minutes=minutes_of(study.definition),
    )
    if staying is None and PARTICIPANT_COOKIE in request.cookies:
        page.delete_cookie(PARTICIPANT_COOKIE)
    return page


def _arrive(
    request: Request, here: Here, visitor: Visitor | None, values: dict[str, str]
) -> Response:
    """Take in somebody whom their address names: their own session, or a new one."""
    key = person_key(here.secret, here.study(), values)
    known = None if key is None else entrance.by_person(here.db, key)
    if known is None:
        is_someone_else = visitor is not None and (key is not None or visitor.is_released)
        return to_first_page(request, here, Arrival(values), is_someone_else=is_someone_else)
    participants.seen(here.db, known)
    answer = redirect("/continue")
    if visitor is None or visitor.participant.id != known.id:
        credential = sign_participant(here.secret, known.public_id)
        remember(request, answer, PARTICIPANT_COOKIE, credential, REMEMBER_S)
    return answer


@router.post("/continue")
def still_me(here: Here, visitor: AVisitor, fields: VisitorsForm) -> Response:
    """Go on after a pause: whoever sends this says that they are the same person."""
    del fields  # the form carries only its proof
    participants.seen(here.db, visitor.participant)
    return to_current(here, visitor)
