"""The checks before the clips as they are stored: a report, and the columns that follow from it.

Every event's payload holds the browser's ``report`` as it came, and ``facts``: what the tables
show. Facts are worked out once, when the report is stored, and can be worked out again from it.
"""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import Any, Final

from sqlalchemy import bindparam, func, select

from study.data import events
from study.data.checks import CheckName, doing
from study.data.database import Database
from study.data.errands import Errand
from study.data.events import Recorded
from study.data.notes import noting, told_before
from study.data.participants import Participant
from study.data.prepared import Prepared, table_of
from study.data.progress import early_step
from study.data.refusals import NotReachedError
from study.data.schema import EventRow
from study.data.senders import locking_again
from study.data.studies import by_id
from study.design.definition import StudyDefinition

DEVICE_FAILED: Final = "device_check_failed"
EYESIGHT_AGREED: Final = "eyesight_agreed"
_E: Final = table_of(EventRow)
_OF_KIND: Final = (_E.c.participant_id == bindparam("who"), _E.c.kind == bindparam("what"))
_FIRST: Final = Prepared(select(_E.c.payload).where(*_OF_KIND).order_by(_E.c.id).limit(1))
_COUNT: Final = Prepared(select(func.count().label("times")).where(*_OF_KIND))


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
    return db.look(lambda: finding_facts(participant.id, check))


def finding_facts(participant_id: int, check: CheckName) -> Errand[dict[str, Any]]:
    """Do the same as an errand."""
    rows = yield _FIRST, {"who": participant_id, "what": check}
    return dict(rows[0].payload.get("facts", {})) if rows else {}


def note(db: Database, participant: Participant, kind: str, *, key: str, payload: Any) -> Recorded:
    """Record something that happened on the way to a check: a failed try, an agreement."""
    return events.record(db, participant, key=key, kind=kind, payload=payload)


def jotting(who: Any, kind: str, *, key: str, payload: Any, now: datetime) -> Errand[bool]:
    """Do the same as an errand; ``who`` is the participant's row, held for writing."""
    state = yield from told_before(who, key)
    return (yield from noting(who, state, key=key, kind=kind, payload=payload, now=now))


def times(db: Database, participant: Participant, kind: str) -> int:
    """Return how often something was noted about a participant."""
    return db.look(lambda: counting(participant.id, kind))


def counting(participant_id: int, kind: str) -> Errand[int]:
    """Do the same as an errand."""
    rows = yield _COUNT, {"who": participant_id, "what": kind}
    return int(rows[0].times)
