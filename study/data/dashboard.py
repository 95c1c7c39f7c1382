"""What a dashboard shows at a glance: who is where, how far rendering is, how full the arms are."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from study.data import arms, erasure, jobs, links
from study.data.collection import Collected, collect
from study.data.database import Database
from study.data.erasure import Withdrawal
from study.data.participants import IDLE
from study.data.progress import STEPS, StepName, early_step
from study.data.studies import Study
from study.design.arms import Arm
from study.design.completion import OUTCOMES


@dataclass(frozen=True)
class Person:
    """One participant's line. ``is_here`` is True while their sitting lives.

    ``ended_early`` is True for somebody who broke off, kept their answers and did not come back.
    """

    public_id: str
    simulated: bool
    step: StepName
    number: int
    total: int
    size: str | None
    orbit_direction: str | None
    sittings: int
    recruited_by: str
    outcome: str | None
    created_at: datetime
    last_seen_at: datetime
    completed_at: datetime | None
    is_here: bool
    ended_early: bool


@dataclass(frozen=True)
class Counts:
    """How many people there are of one kind, real or simulated, those who withdrew included.

    ``steps`` counts everybody by their present step; ``trials`` are complete ones without practice.
    """

    arrived: int
    here: int
    completed: int
    outcomes: dict[str, int]
    ended_early: int
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
    links: links.LinkCounts
    withdrawals: Sequence[Withdrawal]


def summary(db: Database, study: Study) -> Overview:
    """Return where everybody is and how far rendering is, as of one moment."""
    wanted = {clip.spec.clip_id for clip in study.definition.wanted_specs()}
    with db.reading():
        collected = collect(db, study)
        filled = arms.counts(db, study)
        rendering = jobs.summary(db, wanted)
        gone = erasure.withdrawals(db, study)
        invited = links.counts(db, study)
    now = db.now()
    people = [_person(study, one, now) for one in collected]
    return Overview(
        at=now,
        people=people,
        real=_counts(people, collected, gone, simulated=False),
        simulated=_counts(people, collected, gone, simulated=True),
        arms=filled,
        jobs=rendering,
        links=invited,
        withdrawals=gone,
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
    ended_early = (
        row.outcome is None and one.stopped_at is not None and row.last_seen_at <= one.stopped_at
    )
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
        outcome=row.outcome,
        created_at=row.created_at,
        last_seen_at=row.last_seen_at,
        completed_at=row.completed_at,
        is_here=row.outcome is None and not ended_early and now - row.last_seen_at < IDLE,
        ended_early=ended_early,
    )


def _counts(
    people: Sequence[Person],
    collected: Sequence[Collected],
    gone: Sequence[Withdrawal],
    *,
    simulated: bool,
) -> Counts:
    mine = [
        (person, one)
        for person, one in zip(people, collected, strict=True)
        if person.simulated == simulated
    ]
    steps = Counter(person.step for person, _ in mine)
    steps["withdrawn"] = sum(one.simulated == simulated for one in gone)
    outcomes = Counter(person.outcome for person, _ in mine)
    return Counts(
        arrived=len(mine) + steps["withdrawn"],
        here=sum(person.is_here for person, _ in mine),
        completed=sum(person.completed_at is not None for person, _ in mine),
        outcomes={outcome: outcomes[outcome] for outcome in OUTCOMES},
        ended_early=sum(person.ended_early for person, _ in mine),
        withdrawn=steps["withdrawn"],
        trials=sum(
            c.trial.is_complete and not c.trial.is_practice for _, one in mine for c in one.trials
        ),
        steps={step: steps[step] for step in STEPS},
    )
