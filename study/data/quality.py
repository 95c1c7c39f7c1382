"""How good the data are so far: what was skipped, how clips were played, what stopped people."""

from __future__ import annotations

import statistics
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from datetime import datetime

from study.data.collection import Collected, CollectedTrial, collect
from study.data.database import Database
from study.data.studies import Study
from study.data.trials import PLAYED, complete_plays
from study.data.validity import Tally, tally_of
from study.design.certificate import Certificate, Verdict, judge_trial
from study.design.definition import StudyDefinition
from study.design.questions import TextQuestion, each_asked, is_shown

PROBLEM = "problem"


@dataclass(frozen=True)
class Problem:
    """Something that stopped a participant, by the code that they saw."""

    public_id: str
    position: int
    code: str
    created_at: datetime


@dataclass(frozen=True)
class Quality:
    """Complete trials without practice. Text questions may stay empty and do not count as missing.

    ``certified`` of the ``counted`` trials had a play that passed the study's rule; of the others
    nobody could count the frames. ``reasons`` says why trials were not certified, the commonest
    first. ``median_views`` is None while there is no trial. ``checks`` adds up everybody's gold
    trials and attention questions.
    """

    trials: int
    asked: int
    missing: int
    counted: int
    certified: int
    reasons: Sequence[tuple[str, int]]
    with_drops: int
    interrupted_plays: int
    median_views: float | None
    checks: Tally
    problems: Sequence[Problem]


@dataclass(frozen=True)
class Qualities:
    """Real and simulated participants apart."""

    real: Quality
    simulated: Quality


def quality(db: Database, study: Study) -> Qualities:
    """Return how good the data are that were collected so far."""
    people = collect(db, study)
    return Qualities(
        real=_quality(study, [one for one in people if not one.row.simulated]),
        simulated=_quality(study, [one for one in people if one.row.simulated]),
    )


def _quality(study: Study, people: Sequence[Collected]) -> Quality:
    done = [
        trial
        for person in people
        for trial in person.trials
        if trial.trial.is_complete and not trial.trial.is_practice
    ]
    rule = study.definition.certificate
    verdicts = [_verdict(trial, rule) for trial in done]
    reasons = Counter(reason for verdict in verdicts for reason in verdict.reasons)
    asked, missing = _asked_and_missing(study.definition, done)
    return Quality(
        trials=len(done),
        asked=asked,
        missing=missing,
        counted=sum(verdict.certified is not None for verdict in verdicts),
        certified=sum(verdict.certified is True for verdict in verdicts),
        reasons=reasons.most_common(),
        with_drops=sum(any(p.get("dropped_frames") for p in _plays(trial)) for trial in done),
        interrupted_plays=sum(
            not play.get("is_complete") for trial in done for play in _plays(trial)
        ),
        median_views=statistics.median(t.trial.views for t in done) if done else None,
        checks=_checks(study.definition, people),
        problems=_problems(people),
    )


def _checks(definition: StudyDefinition, people: Sequence[Collected]) -> Tally:
    own = [
        asdict(tally_of(definition, (c.trial for c in person.trials), person.attention))
        for person in people
    ]
    return Tally(**{field.name: sum(one[field.name] for one in own) for field in fields(Tally)})


def _plays(trial: CollectedTrial) -> list[dict[str, object]]:
    return [event.payload for event in trial.events if event.kind == PLAYED]


def _verdict(trial: CollectedTrial, rule: Certificate) -> Verdict:
    return judge_trial(complete_plays(trial.trial.completed_at, trial.events), rule)


def _asked_and_missing(
    definition: StudyDefinition, done: Sequence[CollectedTrial]
) -> tuple[int, int]:
    asked = missing = 0
    for trial in done:
        for question in each_asked(definition.questions):
            answers = trial.trial.answers
            if isinstance(question, TextQuestion) or not is_shown(question, answers):
                continue
            asked += 1
            missing += answers.get(question.id) is None
    return asked, missing


def _problems(people: Sequence[Collected]) -> list[Problem]:
    """Return what stopped people, newest first."""
    found = [
        Problem(
            public_id=person.row.public_id,
            position=trial.trial.position,
            code=str(event.payload.get("code", "")),
            created_at=event.created_at,
        )
        for person in people
        for trial in person.trials
        for event in trial.events
        if event.kind == PROBLEM
    ]
    return sorted(found, key=lambda problem: problem.created_at, reverse=True)
