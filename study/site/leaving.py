"""Pausing, coming back, stopping, withdrawing, handing a shared computer to the next person."""

from __future__ import annotations

import secrets
from typing import Annotated

from fastapi import APIRouter, Depends, Request
from fastapi.responses import HTMLResponse, Response
from markupsafe import Markup

from study.data import erasure, participants, stopping
from study.site.access import (
    PARTICIPANT_COOKIE,
    REMEMBER_S,
    WITHDRAWN,
    AVisitor,
    MaybeVisitor,
    Visitor,
    VisitorsForm,
    check_csrf,
    participant_by,
    redirect,
    remember,
)
from study.site.arrival import ARRIVAL_COOKIE
from study.site.forms import first, read_form
from study.site.frame import shared
from study.site.language import Wishes
from study.site.place import Here

router = APIRouter(default_response_class=HTMLResponse)
IDLE_S = int(participants.IDLE.total_seconds())


@router.get("/resume/{token}", name="resume")
def resume(request: Request, here: Here, token: str) -> Response:
    """Take a participant in again by their private link, in any browser."""
    participant = participant_by(here, token)
    if participant is None:
        return redirect("/")
    participants.seen(here.db, participant)
    answer = redirect("/continue")
    remember(request, answer, PARTICIPANT_COOKIE, token, REMEMBER_S)
    return answer


@router.get("/withdrawn")
def withdrawn(request: Request, here: Here, wishes: Wishes) -> Response:
    """Confirm that the answers of someone who withdrew are gone; others have no such page."""
    if request.cookies.get(PARTICIPANT_COOKIE) != WITHDRAWN:
        return redirect("/continue")
    frame = shared(here.study(wishes), None, "withdrawn", wishes=wishes)
    text = frame["text"]
    return here.page(
        "participant/ended.html",
        **frame,
        heading=text("withdrawn.heading"),
        lines=[text("withdrawn.removed"), text("withdrawn.thanks")],
        offer="next",
    )


@router.get("/stop")
def stop(here: Here, visitor: AVisitor) -> Response:
    """Offer a break, an end, or withdrawal."""
    return here.page("participant/stop.html", **shared(visitor.study, visitor, "stop"), fault="")


@router.post("/stop")
def end(request: Request, here: Here, visitor: AVisitor, fields: VisitorsForm) -> Response:
    """End the participation, with the answers kept or removed as the participant chose."""
    if first(fields, "choice") != "remove":
        return _keep_and_end(here, visitor)
    if first(fields, "sure") != "yes":
        frame = shared(visitor.study, visitor, "stop")
        fault = frame["text"]("stop.tick_first")
        return here.page("participant/stop.html", status=422, **frame, fault=fault)
    erasure.withdraw(here.db, visitor.participant)
    answer = redirect("/withdrawn")
    remember(request, answer, PARTICIPANT_COOKIE, WITHDRAWN, IDLE_S)
    return answer


def _keep_and_end(here: Here, visitor: Visitor) -> Response:
    stopping.stop(here.db, visitor.participant, key=f"stop-{secrets.token_hex(8)}")
    page = _ended(
        here,
        visitor,
        "stopped.heading",
        "stopped.kept",
        "stopped.link",
    )
    page.delete_cookie(PARTICIPANT_COOKIE)
    return page


def _ended(here: Here, visitor: Visitor, heading: str, *lines: str) -> Response:
    """Show a page after which nothing comes; ``heading`` and ``lines`` are keys of texts."""
    frame = shared(visitor.study, visitor, "ended")
    text, link = frame["text"], Markup('<a href="{0}" dir="ltr">{0}</a>').format(visitor.resume_url)
    return here.page(
        "participant/ended.html",
        **{**frame, "visitor": None},
        heading=text(heading),
        lines=[text(line, link=link) for line in lines],
        offer="next",
    )


@router.get("/next")
def hand_over(request: Request, here: Here, visitor: MaybeVisitor, wishes: Wishes) -> Response:
    """Offer a shared computer to the next person, once nothing waits in this browser."""
    study = visitor.study if visitor else here.study(wishes)
    frame = shared(study, visitor, "next", wishes=wishes)
    has_withdrawn = request.cookies.get(PARTICIPANT_COOKIE) == WITHDRAWN
    return here.page("participant/next.html", **frame, has_withdrawn=has_withdrawn)


@router.post("/next")
def forget(
    here: Here,
    visitor: MaybeVisitor,
    fields: Annotated[dict[str, list[str]], Depends(read_form)],
) -> Response:
    """Make this browser forget its participant."""
    answer = redirect("/")
    if visitor is not None:
        check_csrf(here.secret, visitor.token, first(fields, "csrf"))
    answer.delete_cookie(PARTICIPANT_COOKIE)
    answer.delete_cookie(ARRIVAL_COOKIE)
    return answer
