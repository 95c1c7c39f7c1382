"""Outcomes: completed, screened out, failed checks; each with the code that the study gives it.

The outcome is written in the transaction that stores the last thing it needs, so that a code never
goes to somebody one of whose answers could still be lost.
"""

from __future__ import annotations

import secrets
from collections.abc import Mapping
from typing import Any, Final

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from study.data import events
from study.data.database import Database
from study.data.participants import Participant, locked
from study.data.progress import SCREENED_OUT
from study.data.refusals import NotReachedError
from study.data.schema import EventRow, ParticipantRow, TrialRow
from study.data.studies import by_id
from study.data.trials import ANSWERED
from study.data.validity import tally
from study.design.completion import GENERATED, NO_CODE
from study.design.definition import StudyDefinition

COMPLETED: Final = "completed"
FAILED: Final = "failed_checks"
_ALPHABET: Final = "ABCDEFGHJKMNPQRSTVWXYZ23456789"  # nothing that reads like something else


def code(db: Database, participant: Participant) -> str | None:
    """Return the participant's code; None while a trial is open, or where there is no code."""
    with db.reading() as session:
        row = session.get_one(ParticipantRow, participant.id)
        return code_of(row, by_id(db, participant.study_id).definition)


def code_of(row: Any, definition: StudyDefinition) -> str | None:
    """Return the same of a participant's row."""
    if row.outcome is None:
        return None
    own: str | None = row.completion_code
    given = definition.endings.code_of(row.outcome)
    return {GENERATED: own, NO_CODE: None}.get(given, given)


def complete(db: Database, session: Session, row: ParticipantRow) -> None:
    """Give an outcome if everything is stored, in the transaction that stored the last of it."""
    if row.outcome is not None or not _is_all_stored(session, row):
        return
    definition = by_id(db, row.study_id).definition
    row.completed_at = db.now()
    found = tally(session, row.id, definition)
    failed = {"attention": found.attention_failed, "gold": found.gold_failed}
    outcome = FAILED if definition.endings.rule.is_failed(**failed) else COMPLETED
    _end(session, row, definition, outcome=outcome)


def _is_all_stored(session: Session, row: ParticipantRow) -> bool:
    """Say whether every trial is complete and its finished questionnaire is among the events."""
    counts = select(func.count(), func.count(TrialRow.completed_at)).where(
        TrialRow.participant_id == row.id
    )
    total, done = session.execute(counts).one()
    if not total or total != done:
        return False
    answered = session.execute(
        select(EventRow.trial_id, EventRow.payload).where(
            EventRow.participant_id == row.id, EventRow.kind == ANSWERED
        )
    )
    return len({trial for trial, payload in answered if payload["is_final"]}) == total


def screen_out(
    db: Database, participant: Participant, *, reason: str, payload: Mapping[str, Any] | None = None
) -> None:
    """End the participation of somebody who cannot take part, such as for their screen.

    ``reason`` is one word for the tables. Asked again, it changes nothing. Raises NotReachedError
    for somebody who has begun the trials.
    """
    definition = by_id(db, participant.study_id).definition
    with db.writing() as session:
        row = locked(session, participant)
        if row.outcome == SCREENED_OUT:
            return
        if row.begun_at is not None:
            raise NotReachedError("nobody is screened out after the trials have begun")
        kept = {**(payload or {}), "reason": reason}
        events.add(session, row, key=SCREENED_OUT, kind=SCREENED_OUT, payload=kept, now=db.now())
        _end(session, row, definition, outcome=SCREENED_OUT)


def _end(
    session: Session, row: ParticipantRow, definition: StudyDefinition, *, outcome: str
) -> None:
    row.outcome = outcome
    row.lease_until = None
    if definition.endings.code_of(outcome) == GENERATED:
        row.completion_code = _free_code(session)


def _free_code(session: Session) -> str:
    while True:
        drawn = "".join(secrets.choice(_ALPHABET) for _ in range(8))
        code = f"{drawn[:4]}-{drawn[4:]}"
        taken = select(ParticipantRow.id).where(ParticipantRow.completion_code == code)
        if session.scalar(taken) is None:
            return code
