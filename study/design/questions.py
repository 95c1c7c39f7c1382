"""What counts as an answer to a question, and which questions the tables have columns for.

Pure. A question's ``id`` is its column: the ids in ``STANDARD`` are those that the tables and the
analysis know; answers to any other id are exported beside them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from study.design.answer_values import accepted_values, read_answer
from study.design.question_kinds import (
    AnalogueQuestion,
    Asked,
    ChoiceQuestion,
    MatrixQuestion,
    MultipleQuestion,
    NumberQuestion,
    Option,
    Question,
    ScaleQuestion,
    ShownIf,
    TextQuestion,
    Value,
    each_asked,
)
from study.design.reasons import Reason, UnfitError

__all__ = [
    "STANDARD",
    "AnalogueQuestion",
    "AnswerError",
    "Asked",
    "ChoiceQuestion",
    "MatrixQuestion",
    "MultipleQuestion",
    "NumberQuestion",
    "Option",
    "Question",
    "ScaleQuestion",
    "ShownIf",
    "Standard",
    "TextQuestion",
    "Value",
    "accepted_values",
    "each_asked",
    "is_shown",
    "read_answer",
    "read_answers",
]


@dataclass(frozen=True)
class Standard:
    """A question that the tables have a column for: its kind and the values of that column."""

    kind: str
    values: tuple[int | str, ...] = ()


STANDARD: Final[Mapping[str, Standard]] = {
    "rating_left": Standard("scale", (1, 2, 3, 4, 5)),
    "rating_right": Standard("scale", (1, 2, 3, 4, 5)),
    "comparison": Standard("choice", (-1, 0, 1)),
    "noticed": Standard("choice", ("yes", "unsure", "no")),
    "what_differed": Standard("text"),
    "comments": Standard("text"),
}


class AnswerError(ValueError):
    """Answers that cannot be stored; ``faults`` holds question id -> why."""

    def __init__(self, faults: Mapping[str, Reason]) -> None:
        self.faults = dict(faults)
        super().__init__("; ".join(f"{name}: {fault}" for name, fault in faults.items()))

    def said(self, text: Callable[..., str]) -> dict[str, str]:
        """Return question id -> sentence; ``text`` is that of a catalogue."""
        return {name: text(why.key, **why.values) for name, why in self.faults.items()}


def read_answers(
    questions: Sequence[Question], given: Mapping[str, object], *, is_final: bool = True
) -> dict[str, Value | None]:
    """Read a form's or a script's answers into what is stored.

    Only ids that ``given`` holds are returned; an empty string or None is a skipped question, kept
    as None. A question hidden by its rule keeps what it was given: the rule decides what is shown,
    never what is thrown away. With ``is_final`` required questions that are shown must be answered.
    Raises AnswerError with every fault at once.
    """
    by_id = {question.id: question for question in each_asked(questions)}
    faults = dict.fromkeys(given.keys() - by_id, Reason("answer.unknown"))
    answers: dict[str, Value | None] = {}
    for name, question in by_id.items():
        if name in given:
            try:
                answers[name] = read_answer(question, given[name])
            except UnfitError as error:
                faults[name] = error.reason
    if is_final:
        faults |= {
            question.id: Reason("answer.required")
            for question in by_id.values()
            if question.is_required
            and question.id not in faults
            and is_shown(question, answers)
            and answers.get(question.id) is None
        }
    if faults:
        raise AnswerError(faults)
    return answers


def is_shown(question: Question, answers: Mapping[str, Value | None]) -> bool:
    """Say whether a question's rule lets it be shown after these answers."""
    rule = question.shown_if
    if rule is None:
        return True
    answer = answers.get(rule.question)
    if isinstance(answer, list):
        return any(one in rule.values for one in answer)
    if answer in rule.values:
        return True
    if rule.values or answer is None or isinstance(answer, str):
        return False
    low, high = rule.at_least, rule.at_most
    return (low is None or answer >= low) and (high is None or answer <= high)
