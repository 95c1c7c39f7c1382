"""Everything that is stored about one participant, for themselves to read and take away."""

from __future__ import annotations

import json
from datetime import datetime
from typing import Any, Final

from sqlalchemy import select
from sqlalchemy.orm import Session

from study.data.database import Database
from study.data.participants import Participant
from study.data.schema import EventRow, LinkRow, ParticipantRow, SessionRow, StudyRow, TrialRow

# Numbers of our own rows, and hashes that only this installation can make: nothing to read in them.
_INNER: Final = {"id", "study_id", "participant_id", "session_id", "trial_id", "seed"}
_KEYS: Final = {"token_hash", "person_key"}
# What a clip shows would tell somebody who has not yet rated it what to see.
_BLIND: Final = {"clip", "clip_id"}


def as_json(db: Database, participant: Participant) -> bytes:
    """Write what is stored about a participant as JSON, with a note on what each part is.

    The names of clips are told once taking part has ended.
    """
    with db.reading() as session:
        row = session.get_one(ParticipantRow, participant.id)
        told = _collected(session, row)
    return json.dumps(told, indent=2, ensure_ascii=False, default=_plain).encode()


def _collected(session: Session, row: ParticipantRow) -> dict[str, Any]:
    study = session.get_one(StudyRow, row.study_id)
    hidden = _INNER | _KEYS | (set() if row.outcome else _BLIND)
    link = session.scalar(select(LinkRow.number).where(LinkRow.participant_id == row.id))
    trials = session.scalars(
        select(TrialRow).where(TrialRow.participant_id == row.id).order_by(TrialRow.position)
    ).all()
    positions = {trial.id: trial.position for trial in trials}
    return {
        "about": "everything that is stored about you; times are in UTC, absent answers are null",
        "study": {"key": study.key, "version": study.version, "title": study.title},
        "participant": {**_columns(row, hidden), "personal_link_number": link},
        "sittings": [
            _columns(one, hidden)
            for one in session.scalars(
                select(SessionRow)
                .where(SessionRow.participant_id == row.id)
                .order_by(SessionRow.number)
            )
        ],
        "trials": [_columns(trial, hidden) for trial in trials],
        "events": [
            {**_columns(one, hidden), "trial_position": positions.get(one.trial_id or 0)}
            for one in session.scalars(
                select(EventRow).where(EventRow.participant_id == row.id).order_by(EventRow.id)
            )
        ],
    }


def _columns(row: Any, hidden: set[str]) -> dict[str, Any]:
    names = [column.key for column in row.__table__.columns]
    return {name: getattr(row, name) for name in names if name not in hidden}


def _plain(value: Any) -> str:
    if isinstance(value, datetime):
        return value.isoformat()
    raise TypeError(f"{value!r} is not plain data")
