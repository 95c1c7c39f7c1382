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

    ``play`` is the player's report: ``is_complete`` (watched to the end), and where known
    ``expected_frames``, ``presented_frames``, ``dropped_frames``, ``was_hidden``, ``shown_scale``,
    ``started_at``, ``duration_ms`` and facts about the screen.
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


def is_certified(play: Mapping[str, Any]) -> bool | None:
    """Say whether a play showed its clip as it should be seen; None where nobody counted frames.

    Rule: watched to the end, never hidden, every frame but one accounted for, at most 1 % dropped.
    """
    expected, presented = play.get("expected_frames"), play.get("presented_frames")
    dropped = play.get("dropped_frames")
    if not isinstance(expected, int) or not isinstance(presented, int) or expected <= 0:
        return None
    lost = dropped if isinstance(dropped, int) else 0
    return (
        bool(play.get("is_complete"))
        and not play.get("was_hidden")
        and presented + lost >= expected - 1
        and lost <= 0.01 * expected
    )
