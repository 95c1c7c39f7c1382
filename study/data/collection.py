"""Everything collected in one study, read in a few queries: what export and dashboard work from."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import select

from study.data.checks import CHECKS, done_in
from study.data.database import Database
from study.data.pauses import attention_answers
from study.data.schema import EventRow, ParticipantRow, SessionRow, TrialRow
from study.data.steps import ABOUT
from study.data.stopping import STOPPED
from study.data.studies import Study
from study.data.trials import Trial, trial_of
from study.design.questions import Value


@dataclass(frozen=True)
class CollectedTrial:
    """One trial with its state and its raw events."""

    trial: Trial
    sitting: int | None
    events: Sequence[EventRow]


@dataclass(frozen=True)
class Collected:
    """One participant with everything stored about them; ``stopped_at`` if they ended early.

    ``checks`` holds report and facts of every check before the clips that is ``done``;
    ``attention`` the answers to the questions between trials, by their pause.
    """

    row: ParticipantRow
    device: dict[str, Any]
    done: frozenset[str]
    checks: dict[str, dict[str, Any]]
    sittings: int
    stopped_at: datetime | None
    about: dict[str, Value | None]
    attention: dict[str, Mapping[str, Any]]
    trials: Sequence[CollectedTrial]


def collect(db: Database, study: Study) -> list[Collected]:
    """Return a study's participants in order of arrival, those who withdrew included."""
    mine = select(ParticipantRow.id).where(ParticipantRow.study_id == study.id)
    with db.reading() as session:
        people = session.scalars(
            select(ParticipantRow)
            .where(ParticipantRow.study_id == study.id)
            .order_by(ParticipantRow.id)
        ).all()
        sittings = session.scalars(
            select(SessionRow)
            .where(SessionRow.participant_id.in_(mine))
            .order_by(SessionRow.participant_id, SessionRow.number)
        ).all()
        trials = session.scalars(
            select(TrialRow)
            .where(TrialRow.participant_id.in_(mine))
            .order_by(TrialRow.participant_id, TrialRow.position)
        ).all()
        events = session.scalars(
            select(EventRow).where(EventRow.participant_id.in_(mine)).order_by(EventRow.id)
        ).all()
    return _together(study, people, sittings, trials, events)


def _together(
    study: Study,
    people: Sequence[ParticipantRow],
    sittings: Sequence[SessionRow],
    trials: Sequence[TrialRow],
    events: Sequence[EventRow],
) -> list[Collected]:
    by_trial: dict[int, list[EventRow]] = defaultdict(list)
    about: dict[int, dict[str, Value | None]] = defaultdict(dict)
    others: dict[int, list[tuple[str, dict[str, Any]]]] = defaultdict(list)
    stopped: dict[int, datetime] = {}
    for event in events:
        if event.trial_id is None:
            others[event.participant_id].append((event.kind, event.payload))
        if event.trial_id is not None:
            by_trial[event.trial_id].append(event)
        elif event.kind == STOPPED:
            stopped[event.participant_id] = event.created_at
        elif event.kind == ABOUT:
            about[event.participant_id].update(event.payload["answers"])
    numbers = {sitting.id: sitting.number for sitting in sittings}
    by_person: dict[int, list[CollectedTrial]] = defaultdict(list)
    for row in trials:
        found = by_trial[row.id]
        sitting = row.session_id or next((e.session_id for e in reversed(found)), None)
        by_person[row.participant_id].append(
            CollectedTrial(trial_of(row, found), numbers.get(sitting or 0), found)
        )
    own: dict[int, list[SessionRow]] = defaultdict(list)
    for sitting_row in sittings:
        own[sitting_row.participant_id].append(sitting_row)
    return [
        Collected(
            row=person,
            device=own[person.id][-1].device if own[person.id] else {},
            done=done_in(others[person.id], study.definition),
            checks={kind: given for kind, given in others[person.id] if kind in CHECKS},
            sittings=len(own[person.id]),
            stopped_at=stopped.get(person.id),
            about=about[person.id],
            attention=attention_answers(others[person.id]),
            trials=by_person[person.id],
        )
        for person in people
    ]
