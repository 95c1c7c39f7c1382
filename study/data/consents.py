"""What a participant agreed to, read back from the events."""

from __future__ import annotations

from sqlalchemy import select
from sqlalchemy.orm import Session

from study.data.database import Database
from study.data.participants import Participant
from study.data.schema import EventRow

CONSENTED = "consented"


def allows_health(db: Database, participant: Participant) -> bool:
    """Say whether a participant lets us ask about their eyesight and colour vision."""
    with db.reading() as session:
        return has_health_consent(session, participant.id)


def has_health_consent(session: Session, participant_id: int) -> bool:
    """Say the same within a transaction."""
    payloads = session.scalars(
        select(EventRow.payload).where(
            EventRow.participant_id == participant_id, EventRow.kind == CONSENTED
        )
    )
    return any(payload.get("health") is True for payload in payloads)
