"""Whose entry a browser delivers: it may belong to somebody who has left this browser since."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Header, Request

from study.data import participants
from study.data.refusals import WithdrawnError
from study.site.access import (
    ElsewhereError,
    ForgedError,
    MaybeVisitor,
    Visitor,
    as_visitor,
    check_csrf,
)
from study.site.place import Here
from study.site.signatures import read_outbox


def reporter(
    request: Request,
    here: Here,
    visitor: MaybeVisitor,
    x_csrf_token: Annotated[str, Header()] = "",
    x_ocularist_outbox: Annotated[str, Header()] = "",
) -> Visitor:
    """Return whose entry a browser delivers: whom the outbox names, else whom the cookie does.

    An outbox keeps its owner's name, so that what waited in it arrives even when somebody else has
    begun in that browser since. Raises WithdrawnError for an owner who is gone.
    """
    if x_ocularist_outbox:
        name = read_outbox(here.secret, x_ocularist_outbox)
        if name is None:
            raise ForgedError
        participant = participants.by_name(here.db, name)
        if participant is None:
            raise WithdrawnError("this participant has withdrawn; nothing more is stored")
        return as_visitor(request, here, participant, "")
    if visitor is None:
        raise ElsewhereError("/")
    check_csrf(here.secret, visitor.token, x_csrf_token)
    return visitor


Reporter = Annotated[Visitor, Depends(reporter)]
