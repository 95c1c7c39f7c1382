"""The steps between the consent and the first trial: answers about oneself, instructions, begin.

Each is an errand, and a function that runs it by itself. ``who`` is the participant's row, held for
writing; the checks among these steps are in ``study.data.before``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from sqlalchemy import bindparam, select

from study.data import consents, trials
from study.data.checks import CHECKS, doing
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
from study.design.questions import Question, read_answers

ABOUT: Final = "about"
INSTRUCTED: Final = "instructed"
BEGUN: Final = "begun"
DRAFTED: Final = "drafted"
"""The kind of what was typed into the page about the participant before it was sent."""
_E: Final = table_of(EventRow)
_DRAFTS: Final = Prepared(
    select(_E.c.payload)
    .where(_E.c.participant_id == bindparam("who"), _E.c.kind == DRAFTED)
    .order_by(_E.c.id)
)


def store_about(
    db: Database, participant: Participant, given: Mapping[str, object], *, key: str
) -> Recorded:
    """Store the answers about the participant; sent again with another key, the later ones count.

    Raises AnswerError naming every answer that cannot be stored, NotReachedError before consent.
    """
    definition = by_id(db, participant.study_id).definition

    def errand() -> Errand[bool]:
        who = yield from locking_again(participant)
        return (yield from storing_about(db, who, definition, given, key=key))

    return Recorded(db.run(errand))


def storing_about(
    db: Database, who: Any, definition: StudyDefinition, given: Mapping[str, object], *, key: str
) -> Errand[bool]:
    """Do the same among other errands."""
    if who.consented_at is None:
        raise NotReachedError("the questions about you come after the consent")
    state = yield from told_before(who, key)
    if state.is_known:
        return False
    answers = read_answers((yield from asking_about(who, definition)), given)
    told = {"answers": answers}
    note = noting(who, state, key=key, kind=ABOUT, payload=told, now=db.now(), stamp="about_at")
    return (yield from note)


def asking_about(who: Any, definition: StudyDefinition) -> Errand[tuple[Question, ...]]:
    """Return the questions about a participant that they let us ask."""
    with_health = definition.consent.health is None or (yield from consents.allowing_health(who.id))
    return asked_about(definition, with_health=with_health)


def asked_about(definition: StudyDefinition, *, with_health: bool) -> tuple[Question, ...]:
    """Return the questions about a participant, given whether health may be asked about."""
    return tuple(
        question
        for question in definition.about
        if definition.consent.asks(question.id, with_health=with_health)
    )


def drafting(participant_id: int) -> Errand[dict[str, object]]:
    """Return question -> what was typed last, of somebody who left that page in the middle."""
    rows = yield _DRAFTS, {"who": participant_id}
    return {str(row.payload["question"]): row.payload["value"] for row in rows}


def finish_instructions(db: Database, participant: Participant, *, key: str) -> Recorded:
    """Record that the participant has read the instructions."""
    definition = by_id(db, participant.study_id).definition

    def errand() -> Errand[bool]:
        who = yield from locking_again(participant)
        return (yield from finishing_instructions(db, who, definition, key=key))

    return Recorded(db.run(errand))


def finishing_instructions(
    db: Database, who: Any, definition: StudyDefinition, *, key: str
) -> Errand[bool]:
    """Do the same among other errands."""
    done = yield from doing(who, definition)
    if early_step(who, definition, done) in ("consent", "about", *CHECKS):
        raise NotReachedError(
            "the instructions come after the consent, the questions about you and the checks"
        )
    state = yield from told_before(who, key)
    note = noting(
        who, state, key=key, kind=INSTRUCTED, payload={}, now=db.now(), stamp="instructed_at"
    )
    return (yield from note)


def begin(
    db: Database, participant: Participant, *, key: str, payload: Mapping[str, Any] | None = None
) -> Recorded:
    """Start the trials: lays them out from the participant's seed and arm (``arms.assign``).

    Raises NotReachedError while there is no arm or an earlier step is open.
    """
    definition = by_id(db, participant.study_id).definition

    def errand() -> Errand[bool]:
        who = yield from locking_again(participant)
        return (yield from beginning(db, who, definition, payload or {}, key=key))

    return Recorded(db.run(errand))


def beginning(
    db: Database, who: Any, definition: StudyDefinition, payload: Mapping[str, Any], *, key: str
) -> Errand[bool]:
    """Do the same among other errands."""
    done = yield from doing(who, definition)
    if early_step(who, definition, done) not in ("preparing", None) or who.size is None:
        raise NotReachedError("the clips come after the instructions, once they are ready")
    state = yield from told_before(who, key)
    yield from trials.laying_out(who, definition)
    note = noting(who, state, key=key, kind=BEGUN, payload=payload, now=db.now(), stamp="begun_at")
    return (yield from note)
