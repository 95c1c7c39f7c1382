"""Views: every play of a clip, finished or not, as the browser reports it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from study.data import events
from study.data.database import Database
from study.data.events import Recorded
from study.data.participants import Participant, locked
from study.data.refusals import NotReachedError
from study.data.schema import TrialRow
from study.data.trials import PLAYED


def record(
    db: Database, participant: Participant, position: int, *, key: str, play: Mapping[str, Any]
) -> Recorded:
    """Add one play of a trial's clip.

    ``play`` is the player's raw record (``static/certificate.js``), kept as it came; whether the
    play counts is ``study.design.certificate``'s to say, whenever somebody asks.
    Raises NotReachedError for a trial that lies ahead.
    """
    with db.writing() as session:
        row = locked(session, participant)
        trial = events.trial_row(session, row.id, position)
        check_reached(session, trial)
        start(trial, db)
        return Recorded(
            events.add(session, row, key=key, kind=PLAYED, payload=play, trial=trial, now=db.now())
        )


def start(trial: TrialRow, db: Database) -> None:
    """Stamp the beginning of a trial at the first sign of it."""
    if trial.started_at is None:
        trial.started_at = db.now()


def check_reached(session: Session, trial: TrialRow) -> None:
    """Raise NotReachedError for a trial behind one that is still open."""
    open_before = select(TrialRow.id).where(
        TrialRow.participant_id == trial.participant_id,
        TrialRow.position < trial.position,
        TrialRow.completed_at.is_(None),
    )
    if session.scalar(open_before.limit(1)) is not None:
        raise NotReachedError(f"trial {trial.position} comes after the ones before it")
