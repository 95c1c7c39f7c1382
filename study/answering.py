"""How simulated people answer a study's own questions: observers know eyes, not questionnaires."""

from __future__ import annotations

import math

import numpy as np

from analysis.simulation.observers import Answer, Observer, Stimulus
from study.design.attention import Attention
from study.design.definition import StudyDefinition
from study.design.parts import read_size
from study.design.pixels import median_iris_px
from study.design.questions import (
    AnalogueQuestion,
    Asked,
    MultipleQuestion,
    NumberQuestion,
    TextQuestion,
    Value,
    accepted_values,
    each_asked,
)


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
    asked = each_asked(definition.about)
    choices = {q.id: [str(v) for v in accepted_values(q)] for q in asked}
    known = observer.about_you(rng, {name: values for name, values in choices.items() if values})
    return {q.id: _fitting(q, known.get(q.id), rng) for q in asked}


def trial_answers(
    definition: StudyDefinition,
    answer: Answer,
    *,
    number: int,
    observer: Observer,
    rng: np.random.Generator,
) -> dict[str, Value | None]:
    """Answer the questions of a trial, whose ``number`` is below 1 in practice.

    An observer's answer is put where the study asks for it, and of other questions answers are
    drawn.
    """
    asked = each_asked(definition.questions_at(number, is_practice=number < 1))
    told = {
        name: value
        for each in definition.attention_within
        if each.within == number
        for name, value in attention_answer(each, observer, rng).items()
    }
    known: dict[str, Value | None] = {
        "rating_left": answer.left_rating,
        "rating_right": answer.right_rating,
        "comparison": answer.comparison,
        "noticed": answer.noticed,
        "what_differed": answer.what_differed,
        "comments": answer.comments,
    }
    known |= told
    return {
        q.id: known[q.id]
        if q.id in known and not (q.is_required and known[q.id] is None)
        else _fitting(q, None, rng)
        for q in asked
    }


def _fitting(question: Asked, known: Value | None, rng: np.random.Generator) -> Value | None:
    """Return ``known`` if the question takes it, else an answer drawn from what it takes."""
    values = accepted_values(question)
    if isinstance(question, MultipleQuestion):
        return _ticked(question, rng)
    if values:
        return known if known in values else values[int(rng.integers(len(values)))]
    if isinstance(question, NumberQuestion | AnalogueQuestion):
        return _number(question, known, rng)
    return str(known) if isinstance(question, TextQuestion) and known is not None else None


def _ticked(question: MultipleQuestion, rng: np.random.Generator) -> list[str]:
    """Tick as many as the question asks for, in the file's order."""
    free = [option.value for option in question.options if not option.is_exclusive]
    chosen = rng.choice(len(free), size=min(question.fewest, len(free)), replace=False)
    return [free[int(index)] for index in sorted(chosen)] or [question.options[0].value]


def _number(
    question: NumberQuestion | AnalogueQuestion, known: Value | None, rng: np.random.Generator
) -> int | float:
    low, high = question.minimum, question.maximum
    if isinstance(known, int):
        return min(high, max(low, known))
    if isinstance(question, NumberQuestion) and question.decimals:
        return round(float(rng.uniform(low, high)), question.decimals)
    return int(rng.integers(math.ceil(low), math.floor(high) + 1))


def attention_answer(
    asked: Attention | None, observer: Observer, rng: np.random.Generator
) -> dict[str, Value | None]:
    """Answer a question that says what to answer; who lapses answers at random."""
    if asked is None:
        return {}
    has_read = rng.random() >= observer.population.lapse
    known = asked.expected if has_read else None
    return {one.id: _fitting(one, known, rng) for one in each_asked([asked.question])}
