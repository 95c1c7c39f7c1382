"""Events: what happened, added once and never changed. The truth about answers and plays.

Whoever sends an event names it with a key of their own making. The same key again, from a double
click, a reload or a repeated request, is the same event: it is acknowledged and not added.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final

from sqlalchemy import event, select
from sqlalchemy.orm import Mapper, Session

from study.data.database import Database
from study.data.participants import Participant, locked, touch
from study.data.refusals import NotReachedError, UnusablePayloadError
from study.data.schema import EventRow, ParticipantRow, TrialRow

MAX_KEY_CHARS: Final = 100
MAX_PAYLOAD_BYTES: Final = 200_000
Payload = Mapping[str, Any]


@dataclass(frozen=True)
class Recorded:
    """Whether an event was added now; False means that it was there already."""

    new: bool


@dataclass(frozen=True)
class Event:
    """One event as it was added; ``position`` is its trial's, if it belongs to one."""

    kind: str
    payload: Payload
    created_at: datetime
    position: int | None


def record(
    db: Database,
    participant: Participant,
    *,
    key: str,
    kind: str,
    payload: Payload | None = None,
    position: int | None = None,
) -> Recorded:
    """Add an event of any kind; it is on the disk when this returns.

    Raises UnusablePayloadError for a key or payload that cannot be stored, NotReachedError for a
    trial that does not exist.
    """
    with db.writing() as session:
        row = locked(session, participant)
        trial = None if position is None else trial_row(session, row.id, position)
        return Recorded(
            add(session, row, key=key, kind=kind, payload=payload or {}, trial=trial, now=db.now())
        )


def history(db: Database, participant: Participant) -> list[Event]:
    """Return everything recorded about a participant, oldest first."""
    query = (
        select(EventRow, TrialRow.position)
        .outerjoin(TrialRow, EventRow.trial_id == TrialRow.id)
        .where(EventRow.participant_id == participant.id)
        .order_by(EventRow.id)
    )
    with db.reading() as session:
        return [
            Event(row.kind, row.payload, row.created_at, position)
            for row, position in session.execute(query)
        ]


def add(
    session: Session,
    participant: ParticipantRow,
    *,
    key: str,
    kind: str,
    payload: Payload,
    trial: TrialRow | None = None,
    now: datetime,
) -> bool:
    """Add an event within a transaction that holds the participant; False if the key is known."""
    if is_known(session, participant, key):
        return False
    append(session, participant, key=key, kind=kind, payload=payload, trial=trial, now=now)
    return True


def append(
    session: Session,
    participant: ParticipantRow,
    *,
    key: str,
    kind: str,
    payload: Payload,
    trial: TrialRow | None = None,
    now: datetime,
) -> EventRow:
    """Add an event whose key is known to be new."""
    row = EventRow(
        participant_id=participant.id,
        session_id=touch(session, participant, now).id,
        trial_id=None if trial is None else trial.id,
        key=key,
        kind=kind,
        payload=plain(payload),
        created_at=now,
    )
    session.add(row)
    session.flush()
    return row


def is_known(session: Session, participant: ParticipantRow, key: str) -> bool:
    """Say whether an event with this key was added before.

    Raises UnusablePayloadError for a key that cannot be stored.
    """
    query = select(EventRow.id).where(
        EventRow.participant_id == participant.id, EventRow.key == checked_key(key)
    )
    return session.scalar(query) is not None


def checked_key(key: str) -> str:
    """Return a key that can be stored; raises UnusablePayloadError for any other."""
    if not 0 < len(key) <= MAX_KEY_CHARS or "\x00" in key:
        raise UnusablePayloadError(
            f"an event's key has 1 to {MAX_KEY_CHARS} characters; found {len(key)}"
        )
    return key


def trial_row(session: Session, participant_id: int, position: int) -> TrialRow:
    """Return a participant's trial at a position; raises NotReachedError when there is none."""
    row = session.scalar(
        select(TrialRow).where(
            TrialRow.participant_id == participant_id, TrialRow.position == position
        )
    )
    if row is None:
        raise NotReachedError(f"there is no trial {position} yet")
    return row


def plain(payload: Payload) -> dict[str, Any]:
    """Return the payload as plain JSON without what no database can store."""
    try:
        text = json.dumps(payload, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise UnusablePayloadError(f"an event's payload has to be plain JSON: {error}") from None
    if len(text) > MAX_PAYLOAD_BYTES:
        raise UnusablePayloadError(
            f"an event's payload has at most {MAX_PAYLOAD_BYTES} bytes; found {len(text)}"
        )
    if "\\u0000" not in text and "\\ud" not in text:
        return dict(payload)
    # PostgreSQL stores neither U+0000 nor lone surrogates.
    cleaned: dict[str, Any] = _clean(json.loads(text))
    return cleaned


def _clean(value: Any) -> Any:
    if isinstance(value, str):
        return value.replace("\x00", "").encode("utf-8", "replace").decode("utf-8")
    if isinstance(value, dict):
        return {_clean(name): _clean(inner) for name, inner in value.items()}
    return [_clean(inner) for inner in value] if isinstance(value, list) else value


def _refuse_change(_mapper: Mapper[EventRow], _connection: object, target: EventRow) -> None:
    raise RuntimeError(f"event {target.key} was recorded; events are added, never changed")


event.listen(EventRow, "before_update", _refuse_change)
