"""Completion: a code for those all of whose trials are stored complete, and for nobody else."""

from __future__ import annotations

import secrets
from typing import Final

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from study.data.database import Database
from study.data.participants import Participant
from study.data.schema import ParticipantRow, TrialRow

_ALPHABET: Final = "ABCDEFGHJKMNPQRSTVWXYZ23456789"  # nothing that reads like something else


def code(db: Database, participant: Participant) -> str | None:
    """Return the participant's completion code, or None while a trial is open."""
    with db.reading() as session:
        return session.get_one(ParticipantRow, participant.id).completion_code


def complete(db: Database, session: Session, row: ParticipantRow) -> None:
    """Issue the code if every trial is complete, in the transaction that stored the last one."""
    trials = select(func.count(), func.count(TrialRow.completed_at)).where(
        TrialRow.participant_id == row.id
    )
    total, done = session.execute(trials).one()
    if total and total == done and row.completed_at is None:
        row.completed_at = db.now()
        row.completion_code = _free_code(session)
        row.lease_until = None


def _free_code(session: Session) -> str:
    while True:
        drawn = "".join(secrets.choice(_ALPHABET) for _ in range(8))
        code = f"{drawn[:4]}-{drawn[4:]}"
        taken = select(ParticipantRow.id).where(ParticipantRow.completion_code == code)
        if session.scalar(taken) is None:
            return code
