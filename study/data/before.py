"""The checks before the clips as they are stored: a report, and the columns that follow from it.

Every event's payload holds the browser's ``report`` as it came, and ``facts``: what the tables
show. Facts are worked out once, when the report is stored, and can be worked out again from it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from sqlalchemy import func, select

from study.data import events
from study.data.checks import CheckName, done_checks
from study.data.database import Database
from study.data.events import Recorded
from study.data.participants import Participant, locked
from study.data.progress import early_step
from study.data.refusals import NotReachedError
from study.data.schema import EventRow
from study.data.studies import by_id

DEVICE_FAILED: Final = "device_check_failed"
EYESIGHT_AGREED: Final = "eyesight_agreed"


def record(
    db: Database,
    participant: Participant,
    check: CheckName,
    *,
    key: str,
    report: Mapping[str, Any],
    facts: Mapping[str, Any],
) -> Recorded:
    """Store what came of a check, which is done with it; the first report counts.

    Raises NotReachedError for a check that comes later, or not at all.
    """
    definition = by_id(db, participant.study_id).definition
    with db.writing() as session:
        row = locked(session, participant)
        done = done_checks(session, row.id, definition)
        if check in done or events.is_known(session, row, key):
            return Recorded(False)
        if early_step(row, definition, done) != check:
            raise NotReachedError(f"{check} comes after what is still open, or not at all")
        payload = {"report": dict(report), "facts": dict(facts)}
        return Recorded(
            events.add(session, row, key=key, kind=check, payload=payload, now=db.now())
        )


def facts_of(db: Database, participant: Participant, check: CheckName) -> dict[str, Any]:
    """Return the facts that a check has brought; empty before it is done."""
    query = (
        select(EventRow.payload)
        .where(EventRow.participant_id == participant.id, EventRow.kind == check)
        .order_by(EventRow.id)
    )
    with db.reading() as session:
        payload = session.scalars(query).first()
    return {} if payload is None else dict(payload.get("facts", {}))


def note(db: Database, participant: Participant, kind: str, *, key: str, payload: Any) -> Recorded:
    """Record something that happened on the way to a check: a failed try, an agreement."""
    return events.record(db, participant, key=key, kind=kind, payload=payload)


def times(db: Database, participant: Participant, kind: str) -> int:
    """Return how often something was noted about a participant."""
    query = select(func.count()).where(
        EventRow.participant_id == participant.id, EventRow.kind == kind
    )
    with db.reading() as session:
        return int(session.scalar(query) or 0)
