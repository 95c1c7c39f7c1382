"""What counts as an answer to a question, and which questions the tables have columns for.

Pure. A question's ``id`` is its column: the ids in ``STANDARD`` are those that the tables and the
analysis know; answers to any other id are exported beside them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

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


def accepted_values(question: Question) -> tuple[int | str, ...]:
    """Return the values that a choice or scale can take; empty for all else."""
    if isinstance(question, ChoiceQuestion | MultipleQuestion):
        return tuple(option.value for option in question.options)
    if isinstance(question, ScaleQuestion):
        return tuple(range(question.lowest, question.highest + 1))
    return ()


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


def read_answer(question: Asked, given: object) -> Value | None:
    """Read one answer; None when skipped. Raises UnfitError with the reason."""
    if isinstance(question, MultipleQuestion):
        return _read_ticks(question, given if isinstance(given, list | tuple) else [given])
    if given is None or (isinstance(given, str) and not given.strip()):
        return None
    text = str(given).strip()
    if isinstance(question, TextQuestion):
        return _read_text(question, text)
    if isinstance(question, NumberQuestion):
        return _read_number(question, text)
    if isinstance(question, AnalogueQuestion):
        return _read_place(question, text)
    for value in accepted_values(question):
        if text == str(value):
            return value
    raise UnfitError(Reason("answer.choose"))


def _read_ticks(question: MultipleQuestion, given: Sequence[object]) -> list[str] | None:
    """Return the ticked values in the file's order; nothing ticked is a skipped question."""
    ticked = {str(value).strip() for value in given if value is not None} - {""}
    chosen = [option for option in question.options if option.value in ticked]
    if len(chosen) < len(ticked):
        raise UnfitError(Reason("answer.choose"))
    if not chosen:
        return None
    alone = next((option for option in chosen if option.is_exclusive), None)
    if alone is not None and len(chosen) > 1:
        raise UnfitError(Reason("answer.alone", {"option": alone.label}))
    if question.most is not None and len(chosen) > question.most:
        raise UnfitError(Reason("answer.at_most", {"count": question.most}))
    if len(chosen) < question.fewest and alone is None:
        raise UnfitError(Reason("answer.at_least", {"count": question.fewest}))
    return [option.value for option in chosen]


def _read_text(question: TextQuestion, text: str) -> str | None:
    # U+0000 cannot be stored by PostgreSQL; lone surrogates cannot be encoded at all.
    cleaned = text.replace("\x00", "").replace("\r\n", "\n").strip()
    cleaned = cleaned.encode("utf-8", "replace").decode("utf-8")
    if len(cleaned) > question.max_chars:
        limits = {"most": question.max_chars, "count": len(cleaned)}
        raise UnfitError(Reason("answer.too_long", limits))
    return cleaned or None  # a text of nothing but such characters is a skipped question


# Digits of any script; a point, a comma or the Arabic decimal mark before decimals.
_NUMBER: Final = re.compile(r"([+-]?\d{1,15})(?:[.,٫](\d{1,15}))?")


def _read_number(question: NumberQuestion, text: str) -> int | float:
    limits: dict[str, object] = {"lowest": question.minimum, "highest": question.maximum}
    key = "answer.number" if question.decimals else "answer.whole_number"
    refusal = UnfitError(Reason(key, {**limits, **_places(question)}))
    found = _NUMBER.fullmatch(text.replace("−", "-"))
    if found is None or len(found[2] or "") > question.decimals:
        raise refusal
    value = float(f"{found[1]}.{found[2] or 0}")
    if not question.minimum <= value <= question.maximum:
        raise refusal
    return value if question.decimals else int(value)


def _places(question: NumberQuestion) -> dict[str, object]:
    return {"count": question.decimals} if question.decimals else {}


def _read_place(question: AnalogueQuestion, text: str) -> int:
    found = _NUMBER.fullmatch(text)
    value = None if found is None or found[2] else int(found[1])
    if value is None or not question.minimum <= value <= question.maximum:
        raise UnfitError(Reason("answer.choose"))
    return value
