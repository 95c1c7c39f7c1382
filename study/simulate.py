"""Simulated participants in bulk: they go through a study on the same functions as real ones.

Their answers come from ``analysis.observers`` and are marked as simulated wherever they appear.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from analysis.observers import Answer, Observer, Stimulus, draw_observer
from study.data import answers, arms, studies, trials, views
from study.data import progress as steps
from study.data.database import Database
from study.data.participants import Participant, enrol
from study.data.studies import Study
from study.data.trials import Trial
from study.design.definition import StudyDefinition
from study.design.parts import read_size
from study.design.pixels import median_iris_px
from study.design.questions import (
    NumberQuestion,
    Question,
    TextQuestion,
    Value,
    accepted_values,
)
from study.design.arms import all_arms


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
    steps.give_consent(db, person, key="consent")
    if definition.about:
        steps.store_about(db, person, about_answers(definition, observer, rng), key="about")
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
        _store(db, leased, definition, trial=trial, answer=answer, rng=rng)


def _store(
    db: Database,
    person: Participant,
    definition: StudyDefinition,
    *,
    trial: Trial,
    answer: Answer,
    rng: np.random.Generator,
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
        trial_answers(definition.questions, answer, rng),
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


def stimulus(definition: StudyDefinition, clip_id: str, *, size: str, orbit: str) -> Stimulus:
    """Return what an observer sees in a clip at a size such as "1280x720"."""
    clip = definition.clip(clip_id)
    spec = definition.clip_spec(clip, size=read_size(size), orbit_direction=orbit)
    return Stimulus(
        distance=clip.distance,
        iris_px=sum(median_iris_px(spec)) / 2,
        left_lod=clip.left,
        right_lod=clip.right,
        left_levels=definition.detail(clip.left).levels(),
        right_levels=definition.detail(clip.right).levels(),
    )


def about_answers(
    definition: StudyDefinition, observer: Observer, rng: np.random.Generator
) -> dict[str, Value | None]:
    """Answer a study's questions about the participant."""
    choices = {q.id: [str(v) for v in accepted_values(q)] for q in definition.about}
    known = observer.about_you(rng, {name: values for name, values in choices.items() if values})
    return {q.id: _fitting(q, known.get(q.id), rng) for q in definition.about}


def trial_answers(
    questions: Sequence[Question], answer: Answer, rng: np.random.Generator
) -> dict[str, Value | None]:
    """Put an observer's answer into a study's questions; of other questions answers are drawn."""
    known: dict[str, Value | None] = {
        "rating_left": answer.left_rating,
        "rating_right": answer.right_rating,
        "comparison": answer.comparison,
        "noticed": answer.noticed,
        "what_differed": answer.what_differed,
        "comments": answer.comments,
    }
    return {
        q.id: known[q.id]
        if q.id in known and not (q.is_required and known[q.id] is None)
        else _fitting(q, None, rng)
        for q in questions
    }


def _fitting(question: Question, known: Value | None, rng: np.random.Generator) -> Value | None:
    """Return ``known`` if the question takes it, else an answer drawn from what it takes."""
    values = accepted_values(question)
    if values:
        return known if known in values else values[int(rng.integers(len(values)))]
    if isinstance(question, NumberQuestion):
        low, high = question.minimum, question.maximum
        return (
            min(high, max(low, int(known)))
            if isinstance(known, int)
            else int(rng.integers(low, high + 1))
        )
    return str(known) if isinstance(question, TextQuestion) and known is not None else None
