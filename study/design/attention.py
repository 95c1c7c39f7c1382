"""Attention questions: they say themselves what to answer. On a page between trials, or in one.

Pure. ``after`` so many trials such a question has a page of its own; ``within`` a trial it stands
among the questions of that trial, as one of them. Trials are counted as the participant counts
them: gold trials included, practice not.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Annotated

from pydantic import Field

from study.design.faults import Fault, dotted, unknown
from study.design.gold import check_expected
from study.design.parts import Name, Part, Text, Whole
from study.design.question_checks import COLUMNS, check_question
from study.design.questions import Question, Value
from study.design.raw import Data, rows_of, table_of

Number = Annotated[Whole, Field(ge=1)]


class Attention(Part):
    """A question whose text says what to answer, ``expected``. ``before`` names the trial's
    question that it precedes; without it, it comes last.
    """

    after: Number | None = None
    within: Number | None = None
    before: Name | None = None
    question: Question
    expected: Whole | Text

    def is_passed(self, answers: Mapping[str, Value | None]) -> bool | None:
        """Say whether the answer is the expected one; None where it was skipped."""
        answer = answers.get(self.question.id)
        return None if answer is None else str(answer) == str(self.expected)


def with_attention(
    questions: Sequence[Question], attention: Iterable[Attention]
) -> tuple[Question, ...]:
    """Return a trial's questions with attention questions put among them."""
    asked = list(questions)
    for each in attention:
        ids = [question.id for question in asked]
        place = len(asked) if each.before is None else ids.index(each.before)
        asked.insert(place, each.question)
    return tuple(asked)


def check_attention(data: Data) -> Iterator[Fault]:
    """Yield the faults of attention questions that their tables alone show."""
    asked = {str(row.get("id")): f"questions.{i}" for i, row in rows_of(data, "questions")}
    ids: dict[str, str] = {}
    for index, row in rows_of(data, "attention"):
        question = table_of(row, "question")
        yield from check_expected(question, row.get("expected"), ("attention", index, "expected"))
        yield from check_question(question, ("attention", index, "question"))
        if question.get("kind") in ("multiple", "matrix"):
            place = dotted(("attention", index, "question", "kind"))
            yield Fault(place, "such a question has one answer; use choice, scale, number or text")
        if question.get("shown_if") is not None:
            place = dotted(("attention", index, "question", "shown_if"))
            yield Fault(place, "such a question stands alone; leave this out")
        yield from _check_place(data, row, index)
        name, here = question.get("id"), f"attention.{index}"
        if not isinstance(name, str):
            continue
        place = dotted(("attention", index, "question", "id"))
        taken = {**asked, **ids} if row.get("within") is not None else ids
        if name in taken:
            yield Fault(place, f'id "{name}" is taken by {taken[name]}; ids must differ')
        elif row.get("within") is not None and name in COLUMNS:
            yield Fault(place, f'"{name}" is a column of the tables already; rename it')
        ids.setdefault(name, here)


def _check_place(data: Data, row: Data, index: int) -> Iterator[Fault]:
    """One of ``after`` and ``within`` is given; ``before`` goes with the latter."""
    after, within, before = (row.get(key) for key in ("after", "within", "before"))
    if (after is None) == (within is None):
        found = "neither is given" if after is None else "both are given"
        yield Fault(
            dotted(("attention", index)),
            f"{found} of after, for a page between trials, and within, for a trial's own "
            "questions; give one",
        )
    if before is None:
        return
    place = dotted(("attention", index, "before"))
    asked = [str(question.get("id")) for _, question in rows_of(data, "questions")]
    if within is None:
        yield Fault(place, "a page between trials has no other question; leave this out")
    elif before not in asked:
        yield Fault(place, unknown("question", before, asked))
    elif str(before).endswith("_right") and f"{str(before).removesuffix('right')}left" in asked:
        left = f"{str(before).removesuffix('right')}left"
        yield Fault(place, f'"{before}" stands beside "{left}"; use "{left}"')


def late_attention(trials: int, attention: Iterable[Attention]) -> Iterator[Fault]:
    """Yield a fault for each question that would stand in or after a trial that never comes."""
    for index, each in enumerate(attention):
        if each.after is not None and each.after >= trials:
            yield Fault(f"attention.{index}.after", late(each.after, trials))
        if each.within is not None and each.within > trials:
            place = f"attention.{index}.within"
            yield Fault(place, f"{each.within} is none of {trials} trials; use 1 to {trials}")


def late(after: int, trials: int) -> str:
    """Say that nothing can come after so many of so few trials."""
    return f"{after} is no place between {trials} trials; use 1 to {trials - 1}"
