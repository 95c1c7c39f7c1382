"""Answers to a trial's questions: stored when given, complete when the questionnaire is finished.

While a trial is open the last answer to each question counts. Once it is complete its answers are
fixed: what comes later is kept as an amendment, for the record, and does not count.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from study.data import completion
from study.data.at_trial import adding, check_reached, finishing, open_trial, reaching
from study.data.database import Database
from study.data.errands import Errand
from study.data.participants import Participant
from study.data.refusals import NotWatchedError
from study.data.schema import ParticipantRow
from study.data.senders import locking_again
from study.data.studies import by_id
from study.data.trials import AMENDED, ANSWERED, Trial, events_of, trial_of
from study.design.definition import StudyDefinition
from study.design.questions import Question, Value, each_asked, read_answers


@dataclass(frozen=True)
class Stored:
    """What became of an answer: added now, kept as a mere amendment, trial complete after it."""

    new: bool
    is_amendment: bool
    trial_complete: bool


def store(
    db: Database,
    participant: Participant,
    position: int,
    given: Mapping[str, object],
    *,
    key: str,
    is_final: bool = False,
    response_ms: int | None = None,
    clock_ms: float | None = None,
) -> Stored:
    """Store answers to the trial at ``position``, as a form or script gives them.

    ``is_final`` finishes the questionnaire: every question not answered is stored as missing, and
    the trial is complete. ``response_ms`` counts from the clip's first presented frame on a clock
    that moves in steps of ``clock_ms``.
    Raises AnswerError (nothing is stored then), NotReachedError for a trial that lies ahead,
    NotWatchedError if ``is_final`` comes before the clip was watched as often as the study asks.
    """
    definition = by_id(db, participant.study_id).definition

    def errand() -> Errand[Stored]:
        who = yield from locking_again(participant)
        return (
            yield from storing(
                db,
                definition,
                who,
                position,
                given,
                key=key,
                is_final=is_final,
                response_ms=response_ms,
                clock_ms=clock_ms,
            )
        )

    return db.run(errand)


def storing(
    db: Database,
    definition: StudyDefinition,
    who: Any,
    position: int,
    given: Mapping[str, object],
    *,
    key: str,
    is_final: bool = False,
    response_ms: int | None = None,
    clock_ms: float | None = None,
) -> Errand[Stored]:
    """Do the same among other errands; ``who`` is the row that holds the participant."""
    trial = yield from reaching(who, position, key=key)
    was_complete = trial.completed_at is not None
    if trial.is_known:
        return Stored(new=False, is_amendment=False, trial_complete=was_complete)
    check_reached(trial)
    # What was given before matters only now that all of it is put together.
    state = trial_of(trial, (yield from events_of(trial))) if is_final else None
    asked = definition.questions_at(trial.number, is_practice=trial.is_practice)
    answers = _read(definition, asked, state, given)
    is_final = is_final and not was_complete
    payload: dict[str, Any] = {
        "answers": answers,
        "is_final": is_final,
        "response_ms": response_ms,
        "clock_ms": clock_ms,
    }
    kind = AMENDED if was_complete else ANSWERED
    now = db.now()
    sitting = yield from adding(who, trial, key=key, kind=kind, payload=payload, now=now)
    if is_final:
        yield from finishing(trial, sitting=sitting, now=now)
        if (yield from open_trial(who)) is None:
            yield lambda session: completion.complete(
                db, session, session.get_one(ParticipantRow, who.id)
            )
    return Stored(new=True, is_amendment=was_complete, trial_complete=is_final or was_complete)


def _read(
    definition: StudyDefinition,
    asked: Sequence[Question],
    state: Trial | None,
    given: Mapping[str, object],
) -> dict[str, Value | None]:
    """Return the answers to store: those given, and with a ``state`` all others as they stand."""
    if state is None:
        return read_answers(asked, given, is_final=False)
    needed = definition.order.min_views
    if state.views < needed:
        raise NotWatchedError(
            f"the clip has to be watched to the end {needed} x first; so far {state.views} x"
        )
    every = dict.fromkeys(question.id for question in each_asked(asked))
    return read_answers(asked, {**every, **state.answers, **given})
