"""Which participant is asking: by the secret in their cookie, or a name that this site has signed.

Their posts must carry the token of their cookie; without it a foreign page could act for them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Final
from urllib.parse import quote

from fastapi import Depends, Request
from fastapi.responses import RedirectResponse, Response

from study.data import participants, progress, studies
from study.data.participants import Participant
from study.data.progress import Step
from study.data.studies import Study
from study.site.forms import first, read_form
from study.site.place import Here
from study.site.signatures import (
    csrf_token,
    is_csrf_token,
    read_participant,
    sign_outbox,
)

PARTICIPANT_COOKIE: Final = "ocularist_participant"
REMEMBER_S: Final = 60 * 24 * 3600
WITHDRAWN: Final = "withdrawn"
"""What the participant's cookie says where somebody withdrew: nobody's token."""


class ElsewhereError(Exception):
    """The asker belongs on another page."""

    def __init__(self, url: str) -> None:
        self.url = url
        super().__init__(url)


class ForgedError(Exception):
    """A form came without the token of its cookie."""


@dataclass(frozen=True)
class Visitor:
    """A participant as a page sees them."""

    participant: Participant
    token: str
    csrf: str
    outbox: str
    study: Study
    is_idle: bool
    request: Request

    @property
    def name(self) -> str:
        """The pseudonym: names this browser's outbox."""
        return self.participant.public_id

    @property
    def resume_url(self) -> str:
        """The link with which they come back at another browser; none for a signed name."""
        return f"{self.request.base_url}resume/{quote(self.token)}" if self.token else ""

    @property
    def is_simulated(self) -> bool:
        """True for a simulated participant."""
        return self.participant.simulated

    @property
    def is_over(self) -> bool:
        """True once completed or screened out."""
        return self.participant.outcome is not None

    @property
    def is_at_shared_computer(self) -> bool:
        """True where one person follows the other at the same browser."""
        return self.study.definition.entrance.shared_computers

    @property
    def is_released(self) -> bool:
        """True where the next person may begin: who was here has finished or gone."""
        return self.is_at_shared_computer and (self.is_over or self.is_idle)


def participant_by(here: Here, credential: str) -> Participant | None:
    """Return whom a token or a signed name belongs to, or None."""
    if not credential:
        return None
    found = participants.by_token(here.db, credential)
    if found is None and (name := read_participant(here.secret, credential)) is not None:
        found = participants.by_name(here.db, name)
    return found


def as_visitor(request: Request, here: Here, participant: Participant, token: str) -> Visitor:
    """Return a participant as pages see them."""
    return Visitor(
        participant=participant,
        token=token,
        csrf=csrf_token(here.secret, token),
        outbox=sign_outbox(here.secret, participant.public_id),
        study=studies.by_id(here.db, participant.study_id).spoken(participant.language),
        is_idle=here.db.now() - participant.last_seen_at > participants.IDLE,
        request=request,
    )


def visitor_or_none(request: Request, here: Here) -> Visitor | None:
    """Return the participant whose cookie the request carries, or None.

    A shared computer that nobody has used for half an hour belongs to nobody.
    """
    token = request.cookies.get(PARTICIPANT_COOKIE, "")
    participant = participant_by(here, token)
    if participant is None:
        return None
    visitor = as_visitor(request, here, participant, token)
    is_released = visitor.is_at_shared_computer and visitor.is_idle and request.method == "GET"
    return None if is_released else visitor


MaybeVisitor = Annotated[Visitor | None, Depends(visitor_or_none)]


async def a_visitor(request: Request, visitor: MaybeVisitor) -> Visitor:
    """Return the participant; others are led to the first page.

    So is who comes back after half an hour: the first page asks whether it is still the same
    person. What was sent from an open page is taken all the same.
    """
    if visitor is None:
        has_withdrawn = request.cookies.get(PARTICIPANT_COOKIE) == WITHDRAWN
        raise ElsewhereError("/withdrawn" if has_withdrawn else "/")
    if visitor.is_idle and not visitor.is_over and request.method == "GET":
        raise ElsewhereError("/")
    return visitor


AVisitor = Annotated[Visitor, Depends(a_visitor)]


async def visitors_form(request: Request, here: Here, visitor: AVisitor) -> dict[str, list[str]]:
    """Return a participant's posted form if it is truly theirs."""
    fields = await read_form(request)
    check_csrf(here.secret, visitor.token, first(fields, "csrf"))
    return fields


VisitorsForm = Annotated[dict[str, list[str]], Depends(visitors_form)]


def check_csrf(secret: str, credential: str, given: str) -> None:
    """Raise ForgedError unless ``given`` is the token of this cookie."""
    if not is_csrf_token(secret, credential, given):
        raise ForgedError


def step_url(step: Step) -> str:
    """Return the page of a step."""
    if step.trial is not None:
        return f"/trial/{step.trial.position}"
    return "/about-you" if step.name == "about" else f"/{step.name.replace('_', '-')}"


def step_of(here: Here, visitor: Visitor, *expected: str) -> Step:
    """Return where a participant is; leads them there if it is none of the ``expected`` steps."""
    step = progress.current_step(here.db, visitor.participant)
    if expected and step.name not in expected:
        raise ElsewhereError(step_url(step))
    return step


def to_current(here: Here, visitor: Visitor) -> RedirectResponse:
    """Lead a participant to where they are."""
    return redirect(step_url(step_of(here, visitor)))


def redirect(url: str) -> RedirectResponse:
    """Answer with "see there", which a reload does not post again."""
    return RedirectResponse(url, status_code=303)


def remember(request: Request, response: Response, name: str, value: str, max_age_s: int) -> None:
    """Set a cookie that scripts cannot read and other sites' posts do not carry."""
    response.set_cookie(
        name,
        value,
        max_age=max_age_s,
        httponly=True,
        samesite="lax",
        secure=request.url.scheme == "https",
    )
