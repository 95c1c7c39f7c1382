"""Participants: known by their token or pseudonym, here as long as they give a sign of life."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, Final, Literal

from sqlalchemy import bindparam, select
from sqlalchemy.orm import Session

from study.data.database import Database
from study.data.devices import read_device
from study.data.errands import Errand
from study.data.prepared import Prepared, table_of
from study.data.refusals import WithdrawnError
from study.data.schema import ParticipantRow, SessionRow
from study.data.studies import Study

IDLE: Final = timedelta(minutes=30)
"""A sitting ends, and an arm's lease runs out, after this long without a sign of life."""
SEEN_AGAIN: Final = timedelta(seconds=15)  # do not write "still here" more often than this


By = Literal["id", "token_hash", "public_id"]
_P: Final = table_of(ParticipantRow)
_FIND: Final = {
    name: Prepared(select(*_P.c).where(_P.c[name] == bindparam("value")))
    for name in ("id", "token_hash", "public_id")
}


@dataclass(frozen=True)
class Participant:
    """A participant as of the moment they were read."""

    id: int
    public_id: str
    study_id: int
    simulated: bool
    language: str
    seed: int
    recruited_by: str
    size: str | None
    orbit_direction: str | None
    block: int | None
    order_row: int | None
    created_at: datetime
    last_seen_at: datetime
    completed_at: datetime | None
    outcome: str | None
    arrival: dict[str, Any] | None


def by_token(db: Database, token: str) -> Participant | None:
    """Return whom a token belongs to, or None; those who withdrew are nobody's any more."""
    return db.look(lambda: _reading("token_hash", token_hash(token)))


def by_public_id(db: Database, study: Study, public_id: str) -> Participant | None:
    """Return a participant of a study by pseudonym, or None."""
    found = by_name(db, public_id)
    return found if found is not None and found.study_id == study.id else None


def by_name(db: Database, public_id: str) -> Participant | None:
    """Return a participant of any study by pseudonym, or None."""
    return db.look(lambda: _reading("public_id", public_id))


def finding(by: By, value: object) -> Errand[Any | None]:
    """Find somebody's row to read; None for nobody."""
    rows = yield _FIND[by], {"value": value}
    return rows[0] if rows else None


def _reading(by: By, value: object) -> Errand[Participant | None]:
    row = yield from finding(by, value)
    return None if row is None else record_of(row)


def by_code(db: Database, code: str) -> Participant | None:
    """Return who has a completion code of their own, or None; one that many share names nobody."""
    with db.reading() as session:
        row = session.scalar(select(ParticipantRow).where(ParticipantRow.completion_code == code))
        return None if row is None else record_of(row)


def seen(
    db: Database, participant: Participant, *, device: Mapping[str, Any] | None = None
) -> Participant:
    """Note that the participant is here: keeps sitting and lease alive, or opens a new sitting.

    Cheap to call with every request: it writes at most every 15 seconds unless ``device`` is given.
    """
    now = db.now()
    if device is None and now - participant.last_seen_at < SEEN_AGAIN:
        return participant
    with db.writing() as session:
        row = locked(session, participant)
        sitting = touch(session, row, now)
        if device is not None:
            sitting.device = {**sitting.device, **read_device(device)}
        return record_of(row)


def locked(session: Session, participant: Participant) -> ParticipantRow:
    """Return a participant's row for writing; others who write about them wait.

    Raises WithdrawnError for someone who has withdrawn.
    """
    row = session.get(ParticipantRow, participant.id, with_for_update=True)
    # A number of somebody erased may be given anew: the pseudonym says whether it is them.
    if row is None or row.public_id != participant.public_id:
        raise WithdrawnError("this participant has withdrawn; nothing more is stored")
    return row


def touch(session: Session, row: ParticipantRow, now: datetime) -> SessionRow:
    """Keep the participant's sitting and lease alive; open a new sitting after a pause."""
    sitting = session.scalars(
        select(SessionRow)
        .where(SessionRow.participant_id == row.id)
        .order_by(SessionRow.number.desc())
        .limit(1)
    ).one()
    if now - sitting.last_seen_at > IDLE:
        sitting = open_sitting(session, row, now, sitting.device, number=sitting.number + 1)
    elif now - sitting.last_seen_at < SEEN_AGAIN:
        return sitting
    sitting.last_seen_at = row.last_seen_at = now
    if row.size is not None and row.completed_at is None:
        row.lease_until = now + IDLE
    return sitting


def record_of(row: Any) -> Participant:
    """Return a row as the record that pages work with."""
    return Participant(**{name: getattr(row, name) for name in Participant.__dataclass_fields__})


def open_sitting(
    session: Session, row: ParticipantRow, now: datetime, device: Mapping[str, Any], *, number: int
) -> SessionRow:
    """Add a sitting."""
    sitting = SessionRow(
        participant_id=row.id, number=number, device=dict(device), started_at=now, last_seen_at=now
    )
    session.add(sitting)
    session.flush()
    return sitting


def token_hash(token: str) -> str:
    """Return what is stored of a token."""
    # A token has 256 random bits: a plain hash cannot be reversed, and it can be looked up.
    return hashlib.sha256(token.encode("utf-8", "replace")).hexdigest()


def anyone_has_begun(db: Database) -> bool:
    """Say whether a participant who is not simulated has begun the trials of any study."""
    query = select(ParticipantRow.id).where(
        ParticipantRow.simulated.is_(False), ParticipantRow.begun_at.is_not(None)
    )
    with db.reading() as session:
        return session.scalar(query.limit(1)) is not None
