"""The checks before the clips as they are stored: a report, and the columns that follow from it.

Every event's payload holds the browser's ``report`` as it came, and ``facts``: what the tables
show. Facts are worked out once, when the report is stored, and can be worked out again from it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from sqlalchemy import func, select

from study.data import events
from study.data.checks import CheckName, doing
from study.data.database import Database
from study.data.errands import Errand
from study.data.events import Recorded
from study.data.notes import noting, told_before
from study.data.participants import Participant
from study.data.progress import early_step
from study.data.refusals import NotReachedError
from study.data.schema import EventRow
from study.data.senders import locking_again
from study.data.studies import by_id
from study.design.definition import StudyDefinition

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

    def errand() -> Errand[bool]:
        who = yield from locking_again(participant)
        return (
            yield from recording(db, who, definition, check, key=key, report=report, facts=facts)
        )

    return Recorded(db.run(errand))


def recording(
    db: Database,
    who: Any,
    definition: StudyDefinition,
    check: CheckName,
    *,
    key: str,
    report: Mapping[str, Any],
    facts: Mapping[str, Any],
) -> Errand[bool]:
    """Do the same among other errands; ``who`` is the participant's row, held for writing."""
    done = yield from doing(who, definition)
    state = yield from told_before(who, key)
    if check in done or state.is_known:
        return False
    if early_step(who, definition, done) != check:
        raise NotReachedError(f"{check} comes after what is still open, or not at all")
    payload = {"report": dict(report), "facts": dict(facts)}
    note = noting(who, state, key=key, kind=check, payload=payload, now=db.now())
    return (yield from note)


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
