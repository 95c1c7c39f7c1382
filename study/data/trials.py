"""Trials: which clip a participant sees at which position, and what has come of it so far."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from functools import lru_cache
from typing import Any, Final

from sqlalchemy import Row, bindparam, insert, select
from sqlalchemy.orm import Session

from study.data.database import Database
from study.data.errands import Errand
from study.data.participants import Participant
from study.data.prepared import Prepared, table_of
from study.data.schema import EventRow, TrialRow
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
_ANY: Final = Prepared(select(_T.c.id).where(_T.c.participant_id == bindparam("who")).limit(1))
_LAID_OUT: Final = ("position", "number", "is_practice", "clip", "clip_id")
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


def laying_out(who: Any, definition: StudyDefinition) -> Errand[None]:
    """Write a participant's trials from their seed and arm; does nothing the second time."""
    if who.size is None or who.orbit_direction is None or (yield _ANY, {"who": who.id}):
        return
    files = definition.file_names(read_size(who.size), who.orbit_direction)
    laid_out = schedule(definition, who.seed, block=who.block, order_row=who.order_row)
    values: dict[str, Any] = {"who": who.id}
    for n, one in enumerate(laid_out):
        cells = (one.position, one.number, one.is_practice, one.clip.id, files[one.clip.id])
        values |= {f"{name}_{n}": cell for name, cell in zip(_LAID_OUT, cells, strict=True)}
    yield _laid_out(len(laid_out)), values


@lru_cache(maxsize=64)
def _laid_out(count: int) -> Prepared:
    """Return what writes so many trials at once."""
    rows: list[dict[str, Any]] = [
        {"participant_id": bindparam("who"), **{m: bindparam(f"{m}_{n}") for m in _LAID_OUT}}
        for n in range(count)
    ]
    return Prepared(insert(_T).values(rows).inline())


def clip_ids(db: Database, participant: Participant) -> tuple[str, ...]:
    """Return the clips that a participant with an arm will see, in order: what to preload."""
    return clips_to_come(participant, by_id(db, participant.study_id).definition)


def clips_to_come(participant: Participant, definition: StudyDefinition) -> tuple[str, ...]:
    """Return the same, given the study."""
    if participant.size is None or participant.orbit_direction is None:
        return ()
    files = definition.file_names(read_size(participant.size), participant.orbit_direction)
    places = {"block": participant.block, "order_row": participant.order_row}
    return tuple(files[t.clip.id] for t in schedule(definition, participant.seed, **places))
