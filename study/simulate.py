"""Simulated participants in bulk: they go through a study on the same functions as real ones.

Their answers come from ``analysis.simulation.observers`` and are marked as simulated wherever they
appear.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from analysis.simulation.observers import Answer, Observer, draw_observer
from study.answering import about_answers, attention_answer, stimulus, trial_answers
from study.checking import pass_checks
from study.data import answers, arms, consents, pauses, steps, studies, trials, views
from study.data.database import Database
from study.data.enrolment import enrol
from study.data.participants import Participant
from study.data.studies import Study
from study.data.trials import Trial
from study.design.arms import all_arms
from study.design.definition import StudyDefinition


def simulate(
    db: Database,
    definition: StudyDefinition,
    *,
    participants: int,
    seed: int,
    progress: Callable[[int], None] = lambda _done: None,
) -> Study:
    """Let simulated people take a study from consent to completion code; returns the study.

    No clip has to be rendered. The same seed gives the same people and answers in an empty
    database. ``progress`` hears how many are done.
    """
    study = studies.register(db, definition)
    for number in range(participants):
        rng = np.random.default_rng([seed, number])
        # One transaction per person: on the disk as a whole or not at all.
        with db.writing():
            _take_part(db, study, rng)
        progress(number + 1)
    return study


def _take_part(db: Database, study: Study, rng: np.random.Generator) -> None:
    definition, observer = study.definition, draw_observer(rng)
    person = enrol(
        db, study, simulated=True, rng=rng, recruited_by="simulation", device=_DEVICE
    ).participant
    consents.give_consent(db, person, key="consent", payload={"health": True})
    if definition.about:
        steps.store_about(db, person, about_answers(definition, observer, rng), key="about")
    pass_checks(db, person, definition, rng)
    steps.finish_instructions(db, person, key="instructions")
    leased = arms.assign(db, person, available=all_arms(definition))
    if leased is None:
        raise RuntimeError("a study without arms cannot be simulated")
    steps.begin(db, leased, key="begin")
    for trial in trials.all_trials(db, leased):
        seen = stimulus(
            definition, trial.clip, size=leased.size or "", orbit=leased.orbit_direction or ""
        )
        answer = observer.answer(seen, rng, position=trial.number)
        given = trial_answers(
            definition,
            answer,
            number=0 if trial.is_practice else trial.number,
            observer=observer,
            rng=rng,
        )
        _store(db, leased, definition, trial=trial, answer=answer, given=given)
        if not trial.is_practice:
            _pause(db, leased, observer, after=trial.number, rng=rng)


def _pause(
    db: Database, person: Participant, observer: Observer, *, after: int, rng: np.random.Generator
) -> None:
    """Rest, or answer the question between trials, where the study has one after so many."""
    for pause in studies.by_id(db, person.study_id).definition.pauses:
        if pause.after == after:
            given = attention_answer(pause.attention, observer, rng)
            pauses.finish(db, person, pause.key, given)


def _store(
    db: Database,
    person: Participant,
    definition: StudyDefinition,
    *,
    trial: Trial,
    answer: Answer,
    given: Mapping[str, object],
) -> None:
    frames = round(definition.orbit.duration_s * definition.orbit.fps)
    for view in range(max(answer.views, definition.order.min_views)):
        play = {
            "is_complete": True,
            "expected_frames": frames,
            "presented_frames": frames,
            "dropped_frames": 0,
            "shown_scale": 1.0,
        }
        views.record(db, person, trial.position, key=f"play-{trial.position}-{view}", play=play)
    answers.store(
        db,
        person,
        trial.position,
        given,
        key=f"answers-{trial.position}",
        is_final=True,
        response_ms=answer.response_ms,
    )


_DEVICE = {
    "screen_width": 1920,
    "screen_height": 1080,
    "pixel_ratio": 1.0,
    "user_agent_family": "simulated",
}
