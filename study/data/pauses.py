"""Pauses between trials: which one is due, and that it is over. An event is all that is kept."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

from sqlalchemy import bindparam, or_, select
from sqlalchemy.orm import Session

from study.data import events
from study.data.database import Database
from study.data.errands import Errand
from study.data.events import Recorded
from study.data.participants import Participant, locked
from study.data.prepared import Prepared, table_of
from study.data.refusals import NotReachedError
from study.data.schema import EventRow
from study.data.studies import by_id
from study.data.trials import Trial, trials_of
from study.design.definition import StudyDefinition
from study.design.pauses import Pause
from study.design.questions import read_answers

RESTED: Final = "rested"
ATTENTION: Final = "attention"
_E: Final = table_of(EventRow)
_OVER: Final = Prepared(
    select(_E.c.payload).where(
        _E.c.participant_id == bindparam("who"),
        or_(_E.c.kind == RESTED, _E.c.kind == ATTENTION),
    )
)


def due_pause(
    session: Session, participant_id: int, definition: StudyDefinition, mine: Sequence[Trial]
) -> Pause | None:
    """Return the pause that a participant is at, given their trials, or None."""
    reached = reached_pauses(definition, mine)
    if not reached:
        return None
    query = select(EventRow.payload).where(
        EventRow.participant_id == participant_id, EventRow.kind.in_((RESTED, ATTENTION))
    )
    over = {payload["pause"] for payload in session.scalars(query)}
    return next((pause for pause in reached if pause.key not in over), None)


def pausing(who: Any, definition: StudyDefinition, mine: Sequence[Trial]) -> Errand[Pause | None]:
    """Return the same, as an errand."""
    reached = reached_pauses(definition, mine)
    if not reached:
        return None
    rows = yield _OVER, {"who": who.id}
    over = {row.payload["pause"] for row in rows}
    return next((pause for pause in reached if pause.key not in over), None)


def reached_pauses(definition: StudyDefinition, mine: Sequence[Trial]) -> list[Pause]:
    """Return the pauses that a participant has come to; none once all trials are complete."""
    if not definition.pauses or all(trial.is_complete for trial in mine):
        return []
    done = sum(trial.is_complete and not trial.is_practice for trial in mine)
    return [pause for pause in definition.pauses if pause.after <= done]


def finish(
    db: Database, participant: Participant, name: str, given: Mapping[str, object]
) -> Recorded:
    """Record that the pause called ``name`` (its ``key``) is over, with its question's answer.

    Asked again it changes nothing, however it is answered then. Raises AnswerError for an answer
    that cannot be stored, NotReachedError for a pause that is not due.
    """
    definition = by_id(db, participant.study_id).definition
    with db.writing() as session:
        row = locked(session, participant)
        key = f"pause-{name}"
        if events.is_known(session, row, key):
            return Recorded(False)
        pause = due_pause(session, row.id, definition, trials_of(session, row.id))
        if pause is None or pause.key != name:
            raise NotReachedError(f"the pause {name} is not due")
        payload: dict[str, Any] = {"pause": name}
        if pause.attention is not None:
            question = pause.attention.question
            payload["answers"] = read_answers([question], {question.id: given.get(question.id)})
        kind = RESTED if pause.attention is None else ATTENTION
        events.append(session, row, key=key, kind=kind, payload=payload, now=db.now())
        return Recorded(True)


def attention_answers(
    events: Iterable[tuple[str, Mapping[str, Any]]],
) -> dict[str, Mapping[str, Any]]:
    """Return pause key -> answers, from kinds and payloads of a participant's events."""
    return {given["pause"]: given["answers"] for kind, given in events if kind == ATTENTION}
