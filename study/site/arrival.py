"""What brings somebody here: parameters of their address, or a personal link.

It waits in a signed cookie until they agree to take part; before that nothing is stored. With it
waits the ticket of their consent form: a form that is sent again, or opened and filled in again,
because its answer was lost on the way, enrols the same participant and not another one.
"""

from __future__ import annotations

import re
import secrets
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Annotated, Final

from fastapi import Depends, Request, Response

from study.data.studies import Study
from study.design.recruiting import readable
from study.site.access import PARTICIPANT_COOKIE, redirect, remember
from study.site.place import Here
from study.site.signatures import ARRIVAL_S, keyed_hash, keyed_token, read_arrival, sign_arrival

ARRIVAL_COOKIE: Final = "ocularist_arrival"


@dataclass(frozen=True)
class Arrival:
    """Parameter -> value, the token of a personal link if one was opened, the form's ticket."""

    values: Mapping[str, str] = field(default_factory=dict)
    link: str | None = None
    ticket: str = ""

    def with_ticket(self) -> Arrival:
        """Return it with a ticket: its own, or a new one."""
        return self if self.ticket else replace(self, ticket=secrets.token_urlsafe(24))


def arrival_of(request: Request, here: Here) -> Arrival:
    """Return what brought whoever asks; nothing for somebody who just came."""
    found = read_arrival(here.secret, request.cookies.get(ARRIVAL_COOKIE, ""))
    if found is None:
        return Arrival()
    return Arrival(found.get("values", {}), found.get("link"), found.get("ticket", ""))


Arrived = Annotated[Arrival, Depends(arrival_of)]


def brought(request: Request, study: Study) -> dict[str, str]:
    """Return the study's parameters in an address; what no recruiter sends is left out."""
    given = {
        one.name: readable(request.query_params.get(one.name, ""))
        for one in study.definition.entrance.parameters
    }
    return {name: value for name, value in given.items() if value}


def is_let_in(study: Study, arrival: Arrival) -> bool:
    """Say whether somebody who comes so may take part: some studies are by invitation."""
    entrance = study.definition.entrance
    if entrance.links_only:
        return arrival.link is not None
    return arrival.link is not None or all(name in arrival.values for name in entrance.required)


def person_key(secret: str, study: Study, values: Mapping[str, str]) -> str | None:
    """Return the key by which a person is known again; None where the address names nobody."""
    names = [one.name for one in study.definition.entrance.parameters if one.is_person]
    if not names or any(name not in values for name in names):
        return None
    return keyed_hash(secret, "person", study.key, *(values[name] for name in names))


def token_of(secret: str, study: Study, ticket: str) -> str:
    """Return the token of whom a ticket enrols: known from the ticket to this site alone."""
    return keyed_token(secret, "ticket", study.key, ticket)


def to_store(secret: str, study: Study, values: Mapping[str, str]) -> dict[str, str]:
    """Return the parameters as the study file lets them be kept: plain, or as a keyed hash."""
    return {
        one.name: values[one.name]
        if one.store == "plain"
        else keyed_hash(secret, one.name, study.key, values[one.name])[:16]
        for one in study.definition.entrance.parameters
        if one.name in values
    }


def to_first_page(
    request: Request, here: Here, arrival: Arrival, *, is_someone_else: bool
) -> Response:
    """Lead to the first page under a clean address: nobody passes on whom it named."""
    language = request.query_params.get("lang", "")
    is_tag = re.fullmatch(r"[A-Za-z0-9-]{1,20}", language) is not None
    answer = redirect(f"/?lang={language}" if is_tag else "/")
    before = arrival_of(request, here)
    if (before.values, before.link) == (arrival.values, arrival.link):  # by the same way again
        arrival = before
    keep_arrival(request, answer, here, arrival)
    if is_someone_else:
        answer.delete_cookie(PARTICIPANT_COOKIE)
    return answer


def keep_arrival(request: Request, answer: Response, here: Here, arrival: Arrival) -> None:
    """Leave what brought somebody here with their browser."""
    told = {"values": dict(arrival.values), "link": arrival.link, "ticket": arrival.ticket}
    remember(request, answer, ARRIVAL_COOKIE, sign_arrival(here.secret, told), ARRIVAL_S)
