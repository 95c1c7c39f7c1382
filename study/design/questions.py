"""Questions of a study: choice, scale, number, text; and what counts as an answer to each.

Pure. A question's ``id`` is its column: the ids in ``STANDARD`` are those that the tables and the
analysis know; answers to any other id are exported beside them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Final, Literal

from pydantic import Field

from study.design.parts import Flag, MaybeText, Name, Part, StoredText, Text, Whole
from study.design.reasons import Reason, UnfitError

Value = int | float | str
MAX_TEXT_CHARS: Final = 10_000


class Option(Part):
    """One answer of a choice: what is stored and what is read on the page."""

    value: Whole | StoredText
    label: Text


class ShownIf(Part):
    """Show a question only after another one was answered with one of these values."""

    question: Name
    values: Annotated[tuple[Whole | StoredText, ...], Field(min_length=1)]


class _Question(Part):
    """What all questions have. ``is_required`` is false unless the file says otherwise."""

    id: Name
    text: Text
    help: MaybeText = ""
    is_required: Flag = False
    shown_if: ShownIf | None = None


class ChoiceQuestion(_Question):
    """Pick one of a few."""

    kind: Literal["choice"]
    options: Annotated[tuple[Option, ...], Field(min_length=2)]


class ScaleQuestion(_Question):
    """Pick a whole number between two named ends."""

    kind: Literal["scale"]
    lowest: Whole = 1
    highest: Whole = 5
    lowest_label: Text
    highest_label: Text


class NumberQuestion(_Question):
    """Type a whole number within limits."""

    kind: Literal["number"]
    minimum: Whole
    maximum: Whole
    unit: MaybeText = ""


class TextQuestion(_Question):
    """Write in one's own words."""

    kind: Literal["text"]
    max_chars: Annotated[Whole, Field(ge=1, le=MAX_TEXT_CHARS)] = 2000
    is_long: Flag = True


Question = Annotated[
    ChoiceQuestion | ScaleQuestion | NumberQuestion | TextQuestion, Field(discriminator="kind")
]


@dataclass(frozen=True)
class Standard:
    """A question that the tables have a column for: its kind and the values of that column."""

    kind: str
    values: tuple[Value, ...] = ()


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


def accepted_values(question: Question) -> tuple[Value, ...]:
    """Return the values that a choice or scale can take; empty for number and text."""
    if isinstance(question, ChoiceQuestion):
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
    by_id = {question.id: question for question in questions}
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
            for question in questions
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
    return rule is None or answers.get(rule.question) in rule.values


def read_answer(question: Question, given: object) -> Value | None:
    """Read one answer; None when skipped. Raises UnfitError with the reason."""
    if given is None or (isinstance(given, str) and not given.strip()):
        return None
    text = str(given).strip()
    if isinstance(question, TextQuestion):
        return _read_text(question, text)
    if isinstance(question, NumberQuestion):
        return _read_number(question, text)
    for value in accepted_values(question):
        if text == str(value):
            return value
    raise UnfitError(Reason("answer.choose"))


def _read_text(question: TextQuestion, text: str) -> str | None:
    # U+0000 cannot be stored by PostgreSQL; lone surrogates cannot be encoded at all.
    cleaned = text.replace("\x00", "").replace("\r\n", "\n").strip()
    cleaned = cleaned.encode("utf-8", "replace").decode("utf-8")
    if len(cleaned) > question.max_chars:
        limits = {"most": question.max_chars, "count": len(cleaned)}
        raise UnfitError(Reason("answer.too_long", limits))
    return cleaned or None  # a text of nothing but such characters is a skipped question


def _read_number(question: NumberQuestion, text: str) -> int:
    limits = {"lowest": question.minimum, "highest": question.maximum}
    accepted = UnfitError(Reason("answer.whole_number", limits))
    try:
        value = int(text)
    except ValueError:
        raise accepted from None
    if not question.minimum <= value <= question.maximum:
        raise accepted
    return value
