"""Trials: which clip a participant sees at which position, and what has come of it so far."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any, Final

from sqlalchemy import Row, bindparam, insert, select
from sqlalchemy.orm import Session

from study.data.database import Database
from study.data.errands import Errand
from study.data.participants import Participant
from study.data.prepared import Prepared, table_of
from study.data.schema import EventRow, ParticipantRow, TrialRow
from study.data.studies import by_id
from study.design.definition import StudyDefinition
from study.design.parts import read_size
from study.design.questions import Value
from study.design.schedule import schedule

ANSWERED = "answered"
AMENDED = "amended"
PLAYED = "played"


@dataclass(frozen=True)
class Trial:
    """One trial. ``clip_id`` names the video's file; ``clip`` is the study file's word for it.

    ``views`` counts plays to the end. ``answers`` holds the questions answered so far; a question
    that was skipped or cleared is None, one never touched is absent.
    """

    id: int
    position: int
    number: int
    is_practice: bool
    clip: str
    clip_id: str
    started_at: datetime | None
    completed_at: datetime | None
    views: int = 0
    answers: dict[str, Value | None] = field(default_factory=dict)

    @property
    def is_complete(self) -> bool:
        """True once its questionnaire was finished."""
        return self.completed_at is not None


def all_trials(
    db: Database, participant: Participant, *, open_only: bool = False
) -> tuple[Trial, ...]:
    """Return a participant's trials in order; empty until they have begun.

    ``open_only`` leaves views and answers of complete trials unread: quicker, page by page.
    """
    with db.reading() as session:
        return trials_of(session, participant.id, open_only=open_only)


def at(db: Database, participant: Participant, position: int) -> Trial | None:
    """Return the trial at a position, or None."""
    found = [trial for trial in all_trials(db, participant) if trial.position == position]
    return found[0] if found else None


def trials_of(
    session: Session, participant_id: int, *, open_only: bool = False
) -> tuple[Trial, ...]:
    """Read a participant's trials with plays counted and answers folded."""
    rows = session.execute(
        select(*_TRIAL).where(TrialRow.participant_id == participant_id).order_by(TrialRow.position)
    ).all()
    wanted = (
        # Trials are done in order: of those that are open only the first has events.
        EventRow.trial_id.in_([row.id for row in rows if row.completed_at is None][:1])
        if open_only
        else EventRow.trial_id.is_not(None)
    )
    events = session.execute(
        select(*_EVENT)
        .where(EventRow.participant_id == participant_id, wanted)
        .order_by(EventRow.id)
    ).all()
    by_trial: dict[int, list[Any]] = {row.id: [] for row in rows}
    for event in events:
        by_trial[event.trial_id or 0].append(event)
    return tuple(trial_of(row, by_trial[row.id]) for row in rows)


def reading(who: Any) -> Errand[tuple[Trial, ...]]:
    """Return the same as an errand: all trials in order, with what has come of the open one."""
    rows = yield _ALL, {"who": who.id}
    now = next((row for row in rows if row.completed_at is None), None)
    events = (yield _EVENTS, {"trial": now.id}) if now is not None else ()
    return tuple(trial_of(row, events if row is now else ()) for row in rows)


# Columns and not objects that can be changed: these are read with every page, and it is quicker.
_TRIAL: Final = TrialRow.__table__.columns
_EVENT: Final = (EventRow.trial_id, EventRow.kind, EventRow.payload, EventRow.created_at)
_T: Final = table_of(TrialRow)
_E: Final = table_of(EventRow)
_ALL: Final = Prepared(
    select(*_T.c).where(_T.c.participant_id == bindparam("who")).order_by(_T.c.position)
)
_EVENTS: Final = Prepared(
    select(_E.c.kind, _E.c.payload, _E.c.created_at)
    .where(_E.c.trial_id == bindparam("trial"))
    .order_by(_E.c.id)
)


def events_of(trial: Any) -> Errand[list[Any]]:
    """Return what is recorded about a trial, oldest first."""
    found: list[Any] = yield _EVENTS, {"trial": trial.id}
    return found


def trial_of(row: TrialRow | Row[Any], events: Iterable[EventRow | Row[Any]]) -> Trial:
    """Fold a trial's events into its state: the last answer to each question counts.

    Amendments, which came after the trial was complete, are kept as events and do not count.
    """
    kept = list(events)
    answers: dict[str, Value | None] = {}
    for event in kept:
        if event.kind == ANSWERED:
            answers.update(event.payload["answers"])
    return Trial(
        id=row.id,
        position=row.position,
        number=row.number,
        is_practice=row.is_practice,
        clip=row.clip,
        clip_id=row.clip_id,
        started_at=row.started_at,
        completed_at=row.completed_at,
        views=len(complete_plays(row.completed_at, kept)),
        answers=answers,
    )


def complete_plays(
    completed_at: datetime | None, events: Iterable[EventRow | Row[Any]]
) -> list[Mapping[str, Any]]:
    """Return the reports of a trial's plays to the end, those after its completion left out."""
    return [
        event.payload
        for event in events
        if event.kind == PLAYED
        and event.payload.get("is_complete")
        and (completed_at is None or event.created_at <= completed_at)
    ]


def lay_out(session: Session, row: ParticipantRow, definition: StudyDefinition) -> None:
    """Write a participant's trials from their seed and arm; does nothing the second time."""
    has_trials = session.scalar(
        select(TrialRow.id).where(TrialRow.participant_id == row.id).limit(1)
    )
    if has_trials is not None or row.size is None or row.orbit_direction is None:
        return
    files = definition.file_names(read_size(row.size), row.orbit_direction)
    laid_out = [
        {
            "participant_id": row.id,
            "position": trial.position,
            "number": trial.number,
            "is_practice": trial.is_practice,
            "clip": trial.clip.id,
            "clip_id": files[trial.clip.id],
        }
        for trial in schedule(definition, row.seed, block=row.block, order_row=row.order_row)
    ]
    session.flush()
    session.execute(insert(_T), laid_out)


def clip_ids(db: Database, participant: Participant) -> tuple[str, ...]:
    """Return the clips that a participant with an arm will see, in order: what to preload."""
    if participant.size is None or participant.orbit_direction is None:
        return ()
    definition = by_id(db, participant.study_id).definition
    files = definition.file_names(read_size(participant.size), participant.orbit_direction)
    places = {"block": participant.block, "order_row": participant.order_row}
    return tuple(files[t.clip.id] for t in schedule(definition, participant.seed, **places))
