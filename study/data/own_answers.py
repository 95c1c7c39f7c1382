"""The columns of questions that only one study asks, and the cells of their answers.

Pure. What was ticked of several is one true-or-false column per option. A question about the left
eye and its twin about the right one are one column of ratings, where every row is one eye; all
other answers stand beside the comparison, or with the participant.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, Final

from analysis import Column, column_names
from study.design.question_kinds import EYES
from study.design.questions import (
    STANDARD,
    AnalogueQuestion,
    Asked,
    ChoiceQuestion,
    MultipleQuestion,
    NumberQuestion,
    Question,
    ScaleQuestion,
    Value,
    accepted_values,
    each_asked,
)

Cells = dict[str, Any]
LEFT, RIGHT = (f"_{eye}" for eye in EYES)


def own_columns(questions: Sequence[Question], taken: Collection[str]) -> list[Column]:
    """Return the columns of all questions but those that are ``taken`` care of elsewhere."""
    return [
        column
        for asked in each_asked(questions)
        for column in _columns(asked, asked.id)
        if column.name not in taken
    ]


def ids_of_eyes(questions: Sequence[Question]) -> set[str]:
    """Return the ids of questions whose answers are columns of ratings."""
    return {asked.id for pair in _twins(questions) for asked in pair}


def eye_columns(questions: Sequence[Question]) -> list[Column]:
    """Return the columns of questions that were asked about each eye."""
    return [
        column
        for left, _ in _twins(questions)
        for column in _columns(left, left.id.removesuffix(LEFT))
    ]


def cells(questions: Sequence[Question], answers: Mapping[str, Value | None]) -> Cells:
    """Return column -> value of the answers, each ticked option in its own column."""
    return {
        name: value
        for asked in each_asked(questions)
        for name, value in _cells(asked, asked.id, answers.get(asked.id))
    }


def eye_cells(
    questions: Sequence[Question], answers: Mapping[str, Value | None], eye: str
) -> Cells:
    """Return column -> value of the answers about one eye, "left" or "right"."""
    pairs = [dict(zip(EYES, pair, strict=True))[eye] for pair in _twins(questions)]
    return {
        name: value
        for asked in pairs
        for name, value in _cells(asked, asked.id.removesuffix(f"_{eye}"), answers.get(asked.id))
    }


_RATING_COLUMNS: Final = frozenset(column_names("ratings"))


def _twins(questions: Sequence[Question]) -> Iterator[tuple[Asked, Asked]]:
    """Yield questions that differ in the eye alone, left and right; none of the tables' own."""
    by_id = {asked.id: asked for asked in each_asked(questions)}
    for name, left in by_id.items():
        stem = name.removesuffix(LEFT)
        right = by_id.get(stem + RIGHT)
        if stem == name or right is None or name in STANDARD or stem in _RATING_COLUMNS:
            continue
        if left.kind == right.kind and accepted_values(left) == accepted_values(right):
            yield left, right


def _columns(asked: Asked, name: str) -> Iterator[Column]:
    if isinstance(asked, MultipleQuestion):
        for option in asked.options:
            meaning = f"{asked.text} {option.label}"
            yield Column(f"{name}_{option.value}", "boolean", meaning)
    elif isinstance(asked, ScaleQuestion):
        yield Column(name, "integer", asked.text, low=asked.lowest, high=asked.highest)
    elif isinstance(asked, AnalogueQuestion):
        yield Column(name, "integer", asked.text, low=asked.minimum, high=asked.maximum)
    elif isinstance(asked, NumberQuestion):
        kind, ends = "number" if asked.decimals else "integer", (asked.minimum, asked.maximum)
        yield Column(name, kind, asked.text, asked.unit, low=ends[0], high=ends[1])
    elif isinstance(asked, ChoiceQuestion):
        choices = tuple(map(str, accepted_values(asked)))
        yield Column(name, "category", asked.text, choices=choices)
    else:
        yield Column(name, "text", asked.text)


def _cells(asked: Asked, name: str, answer: Value | None) -> Iterator[tuple[str, Value | None]]:
    if not isinstance(asked, MultipleQuestion):
        yield name, answer
        return
    for option in asked.options:
        ticked = option.value in answer if isinstance(answer, list) else None
        yield f"{name}_{option.value}", ticked
