"""What a participant agreed to, kept and read back as events.

Somebody whose answer was lost agrees twice, and may tick something else the second time: as long
as they have not gone on, the last one counts.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Final

from sqlalchemy import select
from sqlalchemy.orm import Session

from study.data import events
from study.data.database import Database
from study.data.events import Recorded
from study.data.participants import Participant, locked
from study.data.schema import EventRow
from study.data.studies import by_id

CONSENTED: Final = "consented"


def give_consent(
    db: Database, participant: Participant, *, key: str, payload: Mapping[str, Any] | None = None
) -> Recorded:
    """Record that the participant agrees to the consent text of their study's version."""
    consent = by_id(db, participant.study_id).definition.consent
    kept = {**(payload or {}), "consent_version": consent.version}
    with db.writing() as session:
        row = locked(session, participant)
        now = db.now()
        row.consented_at = row.consented_at or now
        return Recorded(events.add(session, row, key=key, kind=CONSENTED, payload=kept, now=now))


def agree(db: Database, participant: Participant, payload: Mapping[str, Any]) -> Recorded:
    """Record what was agreed to by the form; sent again, only what it changes.

    Nothing changes for somebody who has gone on.
    """
    with db.writing() as session:
        given = _given(session, locked(session, participant).id)
        if given and (has_gone_on(session, participant.id) or _is_same(given[-1], payload)):
            return Recorded(False)
        key = "consent" if not given else f"consent-{len(given) + 1}"
        return give_consent(db, participant, key=key, payload=payload)


def has_gone_on(session: Session, participant_id: int) -> bool:
    """Say whether anything is recorded about a participant besides that they agreed."""
    query = select(EventRow.id).where(
        EventRow.participant_id == participant_id, EventRow.kind != CONSENTED
    )
    return session.scalar(query.limit(1)) is not None


def allows_health(db: Database, participant: Participant) -> bool:
    """Say whether a participant lets us ask about their eyesight and colour vision."""
    with db.reading() as session:
        return has_health_consent(session, participant.id)


def has_health_consent(session: Session, participant_id: int) -> bool:
    """Say the same within a transaction."""
    return agrees_to_health(_given(session, participant_id))


def agrees_to_health(given: Iterable[Mapping[str, Any]]) -> bool:
    """Say whether consents, oldest first, let us ask about health: the last one counts."""
    *_, last = ({}, *given)
    return last.get("health") is True


def _given(session: Session, participant_id: int) -> list[dict[str, Any]]:
    query = (
        select(EventRow.payload)
        .where(EventRow.participant_id == participant_id, EventRow.kind == CONSENTED)
        .order_by(EventRow.id)
    )
    return list(session.scalars(query))


def _is_same(given: Mapping[str, Any], payload: Mapping[str, Any]) -> bool:
    return all(given.get(name) == value for name, value in payload.items())
