"""Personal links: each opens one session, on any device, until that session is over."""

from __future__ import annotations

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse, Response

from study.data import links, participants, studies
from study.site.access import PARTICIPANT_COOKIE, REMEMBER_S, MaybeVisitor, redirect, remember
from study.site.arrival import Arrival, to_first_page
from study.site.place import Here
from study.site.problems import problem_page
from study.site.signatures import sign_participant

router = APIRouter(default_response_class=HTMLResponse)


@router.get("/link/{token}", name="link")
def open_link(request: Request, here: Here, visitor: MaybeVisitor, token: str) -> Response:
    """Let in the person that a link is for, or back in; refuse whoever comes after the end."""
    link = links.find(here.db, token)
    if link is None or studies.by_id(here.db, link.study_id).key != here.study().key:
        return problem_page(request, status=404, code="LINK-UNKNOWN")
    if link.participant is None:
        if link.is_used:  # by somebody who withdrew
            return problem_page(request, status=410, code="LINK-USED")
        is_someone_else = visitor is not None
        return to_first_page(request, here, Arrival(link=token), is_someone_else=is_someone_else)
    is_mine = visitor is not None and visitor.participant.id == link.participant.id
    if link.participant.outcome is not None and not is_mine:
        return problem_page(request, status=410, code="LINK-USED")
    participants.seen(here.db, link.participant)
    answer = redirect("/continue")
    if not is_mine:
        credential = sign_participant(here.secret, link.participant.public_id)
        remember(request, answer, PARTICIPANT_COOKIE, credential, REMEMBER_S)
    return answer
