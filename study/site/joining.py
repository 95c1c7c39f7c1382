"""Joining: whoever agrees is enrolled with what they agreed to, or found if they came before."""

from __future__ import annotations

from functools import partial
from typing import Any

from fastapi import Request
from fastapi.concurrency import run_in_threadpool

from study.data import limits
from study.data.entrance import Newcomer, entering
from study.data.refusals import FormUsedError
from study.data.studies import Study
from study.site.access import ForgedError
from study.site.arrival import Arrival, person_key, to_store, token_of
from study.site.browsers import browser_family
from study.site.consent_words import consent_words
from study.site.forms import Fields, first
from study.site.language import language_of
from study.site.place import Here
from study.site.signatures import (
    SIMULATION_HEADER,
    is_simulation_token,
    read_ticket,
    sign_participant,
    who_hash,
)
from study.texts import catalogue


async def join(
    request: Request,
    here: Here,
    study: Study,
    arrival: Arrival,
    *,
    wishes: tuple[str, ...],
    fields: Fields,
) -> str:
    """Enrol or find the person, with their consent; returns what proves who they are.

    Raises LinkUsedError for a personal link that lets nobody in any more, FormUsedError for a form
    that is not ours, too old, or of somebody who has gone on since.
    """
    simulated = is_simulated(request, here)
    ticket = read_ticket(here.secret, first(fields, "ticket"))
    if ticket is None:
        raise FormUsedError("this form is not ours, or too old")
    if not simulated:
        address = request.client.host if request.client else ""
        who = who_hash(here.secret, address)
        await run_in_threadpool(limits.count, here.db, limits.JOINING, who)
    newcomer = Newcomer(
        arrival=to_store(here.secret, study, arrival.values),
        person_key=person_key(here.secret, study, arrival.values),
        link=arrival.link,
        token=token_of(here.secret, study, ticket),
        simulated=simulated,
        language=language_of(study, wishes),
        device={"user_agent_family": browser_family(request.headers.get("user-agent", ""))},
    )
    agreed = _agreement(study, language_of(study, wishes), fields)
    enter = partial(entering, here.db, study, newcomer, agreed=agreed)
    arrived = await here.writer.write(enter, is_gated=True)
    return arrived.token or sign_participant(here.secret, arrived.participant.public_id)


def _agreement(study: Study, language: str, fields: Fields) -> dict[str, Any]:
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


def is_simulated(request: Request, here: Here) -> bool:
    """Say whether this participant is simulated; a token that is not ours is refused outright."""
    token = request.headers.get(SIMULATION_HEADER)
    if token is not None and not is_simulation_token(here.secret, token):
        raise ForgedError
    return token is not None
