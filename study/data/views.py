"""Views: every play of a clip, finished or not, as the browser reports it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

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
        trial, is_reached = events.trial_and_reach(session, row.id, position)
        check_reached(trial, is_reached=is_reached)
        start(trial, db)
        return Recorded(
            events.add(session, row, key=key, kind=PLAYED, payload=play, trial=trial, now=db.now())
        )


def start(trial: TrialRow, db: Database) -> None:
    """Stamp the beginning of a trial at the first sign of it."""
    if trial.started_at is None:
        trial.started_at = db.now()


def check_reached(trial: TrialRow, *, is_reached: bool) -> None:
    """Raise NotReachedError for a trial behind one that is still open."""
    if not is_reached:
        raise NotReachedError(f"trial {trial.position} comes after the ones before it")
