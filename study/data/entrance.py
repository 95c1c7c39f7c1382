"""Who comes in: somebody new, or somebody who came before.

They came before by the same personal link, as the same person, or with the same token: by the very
form that is sent once more, because its answer was lost. One transaction looks and enrols, so that
two windows opened at once make one participant.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from study.data.consents import has_gone_on
from study.data.database import Database
from study.data.enrolment import enrol
from study.data.participants import Participant, record_of, token_hash
from study.data.refusals import FormUsedError, LinkUsedError
from study.data.schema import LinkRow, ParticipantRow, StudyRow
from study.data.studies import Study, gate


@dataclass(frozen=True)
class Arrived:
    """Who has come in. ``token`` is None for somebody known by link or person: they have theirs."""

    participant: Participant
    token: str | None = None


def enter(
    db: Database,
    study: Study,
    *,
    arrival: Mapping[str, str] | None = None,
    person_key: str | None = None,
    link: str | None = None,
    token: str | None = None,
    simulated: bool = False,
    language: str | None = None,
    device: Mapping[str, Any] | None = None,
) -> Arrived:
    """Enrol somebody, or find them again.

    ``arrival`` is what their address brought, as it is to be stored; ``person_key``, ``link`` and
    ``token``, which is theirs from now on, tell who came before. Raises LinkUsedError for a link
    that lets nobody in any more, and FormUsedError for the token of somebody who has gone on.
    """
    with db.writing() as session:
        # All versions of the study: whoever began one is known in the next.
        gate(session, StudyRow.key == study.key)
        opened = _unused_or_mine(session, link)
        found = _known(session, person_key, opened)
        if found is not None:
            return Arrived(record_of(found))
        if token is not None and (found := _just_enrolled(session, token)) is not None:
            return Arrived(record_of(found), token)
        enrolment = enrol(
            db,
            study,
            simulated=simulated,
            language=language,
            recruited_by=_recruited_by(arrival, link),
            device=device,
            token=token,
        )
        row = session.get_one(ParticipantRow, enrolment.participant.id)
        row.arrival, row.person_key = dict(arrival) if arrival else None, person_key
        if opened is not None:
            opened.is_used, opened.participant_id = True, row.id
        session.flush()
        return Arrived(record_of(row), enrolment.token)


def by_person(db: Database, person_key: str) -> Participant | None:
    """Return who came before as the same person, or None."""
    with db.reading() as session:
        row = _person(session, person_key)
        return None if row is None else record_of(row)


def _unused_or_mine(session: Session, link: str | None) -> LinkRow | None:
    if link is None:
        return None
    row = session.scalar(
        select(LinkRow).where(LinkRow.token_hash == token_hash(link)).with_for_update()
    )
    if row is None or (row.is_used and row.participant_id is None):
        raise LinkUsedError("this personal link lets nobody in any more")
    return row


def _known(session: Session, person_key: str | None, link: LinkRow | None) -> ParticipantRow | None:
    if link is not None and link.participant_id is not None:
        row = session.get_one(ParticipantRow, link.participant_id)
        if row.outcome is not None:
            raise LinkUsedError("this personal link was used to the end")
        return row
    return None if person_key is None else _person(session, person_key)


def _person(session: Session, person_key: str) -> ParticipantRow | None:
    return session.scalar(select(ParticipantRow).where(ParticipantRow.person_key == person_key))


def _just_enrolled(session: Session, token: str) -> ParticipantRow | None:
    """Return whom a token has enrolled; a form is theirs only until they go on from it.

    At a shared computer the form of whoever sat there before may be a press on "Back" away.
    """
    row = session.scalar(
        select(ParticipantRow).where(ParticipantRow.token_hash == token_hash(token))
    )
    if row is not None and has_gone_on(session, row.id):
        raise FormUsedError("this form was used; whoever sent it has gone on since")
    return row


def _recruited_by(arrival: Mapping[str, str] | None, link: str | None) -> str:
    if link is not None:
        return "personal link"
    return "recruiter" if arrival else "link"
