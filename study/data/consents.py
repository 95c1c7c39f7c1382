"""What a participant agreed to, kept and read back as events.

Somebody whose answer was lost agrees twice, and may tick something else the second time: as long
as they have not gone on, the last one counts.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Final

from sqlalchemy import bindparam, select

from study.data.database import Database
from study.data.errands import Errand
from study.data.events import Recorded
from study.data.notes import noting, told_before
from study.data.participants import Participant
from study.data.prepared import Prepared, table_of
from study.data.schema import EventRow
from study.data.senders import locking_again
from study.data.studies import by_id
from study.design.definition import StudyDefinition

CONSENTED: Final = "consented"
_E: Final = table_of(EventRow)
_GIVEN: Final = Prepared(
    select(_E.c.payload)
    .where(_E.c.participant_id == bindparam("who"), _E.c.kind == CONSENTED)
    .order_by(_E.c.id)
)
_MORE: Final = Prepared(
    select(_E.c.id).where(_E.c.participant_id == bindparam("who"), _E.c.kind != CONSENTED).limit(1)
)


def give_consent(
    db: Database, participant: Participant, *, key: str, payload: Mapping[str, Any] | None = None
) -> Recorded:
    """Record that the participant agrees to the consent text of their study's version."""
    definition = by_id(db, participant.study_id).definition

    def errand() -> Errand[bool]:
        who = yield from locking_again(participant)
        return (yield from _consenting(db, who, definition, payload or {}, key=key))

    return Recorded(db.run(errand))


def agreeing(
    db: Database, who: Any, definition: StudyDefinition, payload: Mapping[str, Any]
) -> Errand[bool]:
    """Record what was agreed to by the form; sent again, only what it changes.

    ``who`` is the participant's row. Nothing changes for somebody who has gone on.
    """
    given = yield from _giving(who.id)
    if given and (_is_same(given[-1], payload) or (yield from going_on(who.id))):
        return False
    key = "consent" if not given else f"consent-{len(given) + 1}"
    return (yield from _consenting(db, who, definition, payload, key=key))


def _consenting(
    db: Database, who: Any, definition: StudyDefinition, payload: Mapping[str, Any], *, key: str
) -> Errand[bool]:
    kept = {**payload, "consent_version": definition.consent.version}
    state = yield from told_before(who, key)
    return (
        yield from noting(
            who,
            state,
            key=key,
            kind=CONSENTED,
            payload=kept,
            now=db.now(),
            stamp="consented_at",
        )
    )


def going_on(participant_id: int) -> Errand[bool]:
    """Say whether anything is recorded about a participant besides that they agreed."""
    return bool((yield _MORE, {"who": participant_id}))


def allows_health(db: Database, participant: Participant) -> bool:
    """Say whether a participant lets us ask about their eyesight and colour vision."""
    return db.look(lambda: allowing_health(participant.id))


def allowing_health(participant_id: int) -> Errand[bool]:
    """Say the same as an errand."""
    return agrees_to_health((yield from _giving(participant_id)))


def agrees_to_health(given: Iterable[Mapping[str, Any]]) -> bool:
    """Say whether consents, oldest first, let us ask about health: the last one counts."""
    *_, last = ({}, *given)
    return last.get("health") is True


def _giving(participant_id: int) -> Errand[list[dict[str, Any]]]:
    rows = yield _GIVEN, {"who": participant_id}
    return [row.payload for row in rows]


def _is_same(given: Mapping[str, Any], payload: Mapping[str, Any]) -> bool:
    return all(given.get(name) == value for name, value in payload.items())
