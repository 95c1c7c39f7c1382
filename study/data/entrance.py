"""Who comes in: somebody new, or somebody who came before.

They came before by the same personal link, as the same person, or with the same token: by the very
form that is sent once more, because its answer was lost. One transaction looks and enrols, so that
two windows opened at once make one participant.
"""

from __future__ import annotations

import secrets
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from sqlalchemy import bindparam, select, update

from study.data.consents import agreeing, going_on
from study.data.database import Database
from study.data.enrolment import enrolling
from study.data.errands import Errand
from study.data.participants import Participant, finding, record_of, token_hash
from study.data.prepared import Prepared, table_of
from study.data.refusals import FormUsedError, LinkUsedError
from study.data.schema import LinkRow, ParticipantRow, StudyRow
from study.data.senders import locking
from study.data.studies import Study

_S: Final = table_of(StudyRow)
_L: Final = table_of(LinkRow)
_P: Final = table_of(ParticipantRow)
# All versions of the study: whoever began one is known in the next. ``studies.gate`` says why.
_GATE: Final = Prepared(
    select(_S.c.id)
    .where(_S.c.key == bindparam("study"))
    .order_by(_S.c.id)
    .with_for_update(key_share=True)
)
_LINK: Final = Prepared(
    select(*_L.c).where(_L.c.token_hash == bindparam("value")).with_for_update()
)
_USE: Final = Prepared(
    update(_L)
    .where(_L.c.id == bindparam("link"))
    .values(is_used=True, participant_id=bindparam("who"))
)
_PERSON: Final = Prepared(select(*_P.c).where(_P.c.person_key == bindparam("value")))


@dataclass(frozen=True)
class Arrived:
    """Who has come in. ``token`` is None for somebody known by link or person: they have theirs."""

    participant: Participant
    token: str | None = None


@dataclass(frozen=True)
class Newcomer:
    """What is known of somebody who comes in.

    ``arrival`` is what their address brought, as it is to be stored; ``person_key``, ``link`` and
    ``token``, which is theirs from now on, tell who came before.
    """

    arrival: Mapping[str, str] = field(default_factory=dict)
    person_key: str | None = None
    link: str | None = None
    token: str | None = None
    simulated: bool = False
    language: str | None = None
    device: Mapping[str, Any] = field(default_factory=dict)

    @property
    def recruited_by(self) -> str:
        """What brought them."""
        if self.link is not None:
            return "personal link"
        return "recruiter" if self.arrival else "link"


def enter(db: Database, study: Study, **known: Any) -> Arrived:
    """Let somebody in, in a transaction of its own; ``known`` are the fields of Newcomer."""
    return db.run(lambda: entering(db, study, Newcomer(**known)))


def entering(
    db: Database, study: Study, newcomer: Newcomer, *, agreed: Mapping[str, Any] | None = None
) -> Errand[Arrived]:
    """Enrol somebody, or find them again; ``agreed`` is what they agreed to by the form.

    Raises LinkUsedError for a link that lets nobody in any more, and FormUsedError for the token
    of somebody who has gone on.
    """
    yield _GATE, {"study": study.key}
    opened = yield from _unused_or_mine(newcomer.link)
    who, token = (yield from _knowing(newcomer.person_key, opened)), None
    if who is None:
        token = newcomer.token or secrets.token_urlsafe(32)
        who = yield from _just_enrolled(token)
    if who is None:
        who = yield from enrolling(
            db,
            study,
            token=token or "",
            simulated=newcomer.simulated,
            language=newcomer.language,
            recruited_by=newcomer.recruited_by,
            arrival=newcomer.arrival,
            person_key=newcomer.person_key,
            device=newcomer.device,
        )
        if opened is not None:
            yield _USE, {"link": opened.id, "who": who.id}
    if agreed is not None:
        yield from locking("id", who.id)
        yield from agreeing(db, who, study.definition, agreed)
    return Arrived(record_of(who), token)


def by_person(db: Database, person_key: str) -> Participant | None:
    """Return who came before as the same person, or None."""

    def errand() -> Errand[Participant | None]:
        row = yield from _person(person_key)
        return None if row is None else record_of(row)

    return db.look(errand)


def _unused_or_mine(link: str | None) -> Errand[Any | None]:
    if link is None:
        return None
    rows = yield _LINK, {"value": token_hash(link)}
    if not rows or (rows[0].is_used and rows[0].participant_id is None):
        raise LinkUsedError("this personal link lets nobody in any more")
    return rows[0]


def _knowing(person_key: str | None, link: Any | None) -> Errand[Any]:
    if link is not None and link.participant_id is not None:
        row: Any = yield from finding("id", link.participant_id)
        if row.outcome is not None:
            raise LinkUsedError("this personal link was used to the end")
        return row
    return None if person_key is None else (yield from _person(person_key))


def _person(person_key: str) -> Errand[Any | None]:
    rows = yield _PERSON, {"value": person_key}
    return rows[0] if rows else None


def _just_enrolled(token: str) -> Errand[Any | None]:
    """Return whom a token has enrolled; a form is theirs only until they go on from it.

    At a shared computer the form of whoever sat there before may be a press on "Back" away.
    """
    row = yield from finding("token_hash", token_hash(token))
    if row is not None and (yield from going_on(row.id)):
        raise FormUsedError("this form was used; whoever sent it has gone on since")
    return row
