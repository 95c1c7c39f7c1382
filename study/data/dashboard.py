"""What a dashboard shows at a glance: who is where, how far rendering is, how full the arms are."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from study.data import arms, jobs
from study.data.collection import Collected, collect
from study.data.database import Database
from study.data.participants import IDLE
from study.data.progress import STEPS, StepName, early_step
from study.data.studies import Study
from study.design.schedule import Arm


@dataclass(frozen=True)
class Person:
    """One participant's line. ``is_here`` is True while their sitting lives."""

    public_id: str
    simulated: bool
    step: StepName
    number: int
    total: int
    size: str | None
    orbit_direction: str | None
    sittings: int
    recruited_by: str
    created_at: datetime
    last_seen_at: datetime
    completed_at: datetime | None
    is_here: bool


@dataclass(frozen=True)
class Counts:
    """How many people there are of one kind, real or simulated.

    ``steps`` counts everybody by their present step; ``trials`` are complete ones without practice.
    """

    arrived: int
    here: int
    completed: int
    withdrawn: int
    trials: int
    steps: dict[StepName, int]


@dataclass(frozen=True)
class Overview:
    """A study at one moment."""

    at: datetime
    people: Sequence[Person]
    real: Counts
    simulated: Counts
    arms: dict[Arm, int]
    jobs: jobs.Summary


def summary(db: Database, study: Study) -> Overview:
    """Return where everybody is and how far rendering is, as of one moment."""
    wanted = {clip.spec.clip_id for clip in study.definition.wanted_specs()}
    with db.reading():
        collected = collect(db, study)
        filled = arms.counts(db, study)
        rendering = jobs.summary(db, wanted)
    now = db.now()
    people = [_person(study, one, now) for one in collected]
    return Overview(
        at=now,
        people=people,
        real=_counts(people, collected, simulated=False),
        simulated=_counts(people, collected, simulated=True),
        arms=filled,
        jobs=rendering,
    )


def _person(study: Study, one: Collected, now: datetime) -> Person:
    row = one.row
    step, number, total = early_step(row, study.definition, one.done), 0, 0
    if step is None:
        open_trial = next((c.trial for c in one.trials if not c.trial.is_complete), None)
        if open_trial is None:
            step = "thanks"
        else:
            step = "practice" if open_trial.is_practice else "trial"
            number = open_trial.number
            total = sum(c.trial.is_practice == open_trial.is_practice for c in one.trials)
    return Person(
        public_id=row.public_id,
        simulated=row.simulated,
        step=step,
        number=number,
        total=total,
        size=row.size,
        orbit_direction=row.orbit_direction,
        sittings=one.sittings,
        recruited_by=row.recruited_by,
        created_at=row.created_at,
        last_seen_at=row.last_seen_at,
        completed_at=row.completed_at,
        is_here=step not in ("thanks", "withdrawn") and now - row.last_seen_at < IDLE,
    )


def _counts(people: Sequence[Person], collected: Sequence[Collected], *, simulated: bool) -> Counts:
    mine = [
        (person, one)
        for person, one in zip(people, collected, strict=True)
        if person.simulated == simulated
    ]
    steps = Counter(person.step for person, _ in mine)
    return Counts(
        arrived=len(mine),
        here=sum(person.is_here for person, _ in mine),
        completed=sum(person.completed_at is not None for person, _ in mine),
        withdrawn=steps["withdrawn"],
        trials=sum(
            c.trial.is_complete and not c.trial.is_practice for _, one in mine for c in one.trials
        ),
        steps={step: steps[step] for step in STEPS},
    )
