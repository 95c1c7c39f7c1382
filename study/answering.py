"""How simulated people answer a study's own questions: observers know eyes, not questionnaires."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from analysis.observers import Answer, Observer, Stimulus
from study.design.definition import StudyDefinition
from study.design.parts import read_size
from study.design.pauses import Attention
from study.design.pixels import median_iris_px
from study.design.questions import (
    NumberQuestion,
    Question,
    TextQuestion,
    Value,
    accepted_values,
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


def attention_answer(
    asked: Attention | None, observer: Observer, rng: np.random.Generator
) -> dict[str, Value | None]:
    """Answer a question that says what to answer; who lapses answers at random."""
    if asked is None:
        return {}
    has_read = rng.random() >= observer.population.lapse
    return {asked.question.id: _fitting(asked.question, asked.expected if has_read else None, rng)}
