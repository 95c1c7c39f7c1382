"""Who asks, found inside the errand that their request is: one transaction for all of it.

The rules are those of ``study.site.access``, for the two requests that come most: an entry of the
outbox and the page of a trial.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from fastapi import Request

from study.data import studies
from study.data.errands import Errand
from study.data.participants import IDLE, By, finding
from study.data.refusals import WithdrawnError
from study.data.senders import by_token, locking
from study.data.studies import Study
from study.site.access import PARTICIPANT_COOKIE, WITHDRAWN, ElsewhereError, ForgedError, check_csrf
from study.site.place import Place
from study.site.signatures import read_outbox, read_participant


@dataclass(frozen=True)
class Asker:
    """Whom to look for: by what, and the cookie that says so ("" for an outbox)."""

    by: By
    value: str
    token: str

    @property
    def is_outbox(self) -> bool:
        """True where an outbox names its owner."""
        return not self.token


def by_cookie(request: Request, here: Place) -> Asker:
    """Return whom the participant's cookie names; raises ElsewhereError where there is none."""
    token = request.cookies.get(PARTICIPANT_COOKIE, "")
    if not token or token == WITHDRAWN:
        raise nobody(request)
    # A token has no dots, a name that this site has signed has some.
    name = read_participant(here.secret, token) if "." in token else None
    by, value = by_token(token) if name is None else ("public_id", name)
    return Asker(by, value, token)


def by_outbox(request: Request, here: Place) -> Asker:
    """Return whose entry a browser delivers: whom the outbox names, else whom the cookie does."""
    if signed := request.headers.get("x-ocularist-outbox", ""):
        name = read_outbox(here.secret, signed)
        if name is None:
            raise ForgedError
        return Asker("public_id", name, "")
    asker = by_cookie(request, here)
    check_csrf(here.secret, asker.token, request.headers.get("x-csrf-token", ""))
    return asker


def nobody(request: Request) -> ElsewhereError:
    """Say where somebody belongs who is no participant."""
    has_withdrawn = request.cookies.get(PARTICIPANT_COOKIE) == WITHDRAWN
    return ElsewhereError("/withdrawn" if has_withdrawn else "/")


def locked(request: Request, asker: Asker) -> Errand[Any]:
    """Find who asks, to write about them; raises ElsewhereError or WithdrawnError for nobody."""
    who = yield from locking(asker.by, asker.value)
    if who is None and asker.is_outbox:
        raise WithdrawnError("this participant has withdrawn; nothing more is stored")
    if who is None:
        raise nobody(request)
    return who


def found(request: Request, here: Place, asker: Asker) -> Errand[Any]:
    """Find who asks for a page; raises ElsewhereError for nobody, and after half an hour."""
    who = yield from finding(asker.by, asker.value)
    if who is None:
        raise nobody(request)
    is_idle = here.db.now() - who.last_seen_at > IDLE
    shares = study_of(here, who).definition.entrance.shared_computers
    if is_idle and (shares or who.outcome is None):
        raise ElsewhereError("/")
    return who


def study_of(here: Place, who: Any) -> Study:
    """Return the study that somebody takes part in, in their language."""
    return studies.by_id(here.db, who.study_id).spoken(who.language)
