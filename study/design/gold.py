"""Gold trials: an obvious pair whose answer is known beforehand. They look like any other trial.

Pure. What came of one is data; it is told to nobody who takes part.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated

from pydantic import Field

from study.design.faults import Fault, dotted, unknown
from study.design.pairings import Clip
from study.design.parts import Name, Part, Real, Text, Whole
from study.design.questions import Value
from study.design.raw import Data, rows_of


class Expected(Part):
    """An answer that somebody who looks is bound to give; numbers may miss it by ``tolerance``."""

    question: Name
    value: Whole | Text
    tolerance: Annotated[Real, Field(ge=0)] = 0.0

    def is_met(self, answer: Value) -> bool:
        """Say whether an answer is the expected one."""
        if isinstance(answer, list):
            return str(self.value) in answer
        if isinstance(answer, str) or isinstance(self.value, str):
            return str(answer) == str(self.value)
        return abs(answer - self.value) <= self.tolerance


class Gold(Clip):
    """A clip shown after ``after`` other trials, with all the answers that it should get."""

    after: Annotated[Whole, Field(ge=0)]
    expected: Annotated[tuple[Expected, ...], Field(min_length=1)]


def is_passed(gold: Gold, answers: Mapping[str, Value | None]) -> bool | None:
    """Say whether the answers to a gold trial are as expected; None where one was skipped."""
    given = [(expected, answers.get(expected.question)) for expected in gold.expected]
    if any(answer is None for _, answer in given):
        return None
    return all(expected.is_met(answer) for expected, answer in given if answer is not None)


def check_gold(data: Data) -> Iterator[Fault]:
    """Yield the faults of expected answers: questions that nobody asks, values that none takes."""
    asked = {str(row.get("id")): row for _, row in rows_of(data, "questions")}
    for index, row in rows_of(data, "gold"):
        for number, expected in rows_of(row, "expected"):
            place = ("gold", index, "expected", number)
            question = expected.get("question")
            if not isinstance(question, str):
                continue
            if question not in asked:
                yield Fault(
                    dotted((*place, "question")), unknown("question", question, list(asked))
                )
                continue
            yield from check_expected(asked[question], expected.get("value"), (*place, "value"))


def check_expected(question: Data, value: object, place: tuple[str | int, ...]) -> Iterator[Fault]:
    """Yield a fault if a choice or scale cannot be answered with ``value``."""
    accepted = _accepted(question)
    if accepted and value is not None and value not in accepted:
        yield Fault(dotted(place), unknown("answer", value, map(str, accepted)))


def _accepted(question: Data) -> list[object]:
    if question.get("kind") == "choice":
        return [option.get("value") for _, option in rows_of(question, "options")]
    low, high = question.get("lowest", 1), question.get("highest", 5)
    if question.get("kind") == "scale" and isinstance(low, int) and isinstance(high, int):
        return list(range(low, min(high, low + 1000) + 1))
    return []
