"""What comes between trials: breaks, and questions that say themselves what to answer.

Pure. Each comes after a number of trials, gold trials included, as the participant counts them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field

from study.design.faults import Fault, dotted
from study.design.gold import check_expected
from study.design.parts import Part, Text, Whole
from study.design.questions import Question, Value
from study.design.raw import Data, rows_of, table_of
from study.design.texts import Page

After = Annotated[Whole, Field(ge=1)]


class Breaks(Page):
    """A page that offers a rest, after each of these numbers of trials."""

    after: Annotated[tuple[After, ...], Field(min_length=1)]


class Attention(Part):
    """A question between trials whose text says what to answer, ``expected``."""

    after: After
    question: Question
    expected: Whole | Text

    def is_passed(self, answers: Mapping[str, Value | None]) -> bool | None:
        """Say whether the answer is the expected one; None where it was skipped."""
        answer = answers.get(self.question.id)
        return None if answer is None else str(answer) == str(self.expected)


@dataclass(frozen=True)
class Pause:
    """One stop between trials; ``key`` names its event. A break has no attention question."""

    kind: Literal["break", "attention"]
    after: int
    key: str
    attention: Attention | None = None


def all_pauses(breaks: Breaks | None, attention: Iterable[Attention]) -> tuple[Pause, ...]:
    """Return every pause in the order in which they come; a question before a break."""
    asked = [
        Pause("attention", each.after, f"attention-{each.question.id}", each) for each in attention
    ]
    rests = [Pause("break", after, f"break-{after}") for after in (breaks.after if breaks else ())]
    return tuple(sorted([*asked, *rests], key=lambda pause: pause.after))


def check_pauses(data: Data) -> Iterator[Fault]:
    """Yield the faults of pauses: answers that cannot be given, and what is listed twice."""
    ids: dict[str, int] = {}
    for index, row in rows_of(data, "attention"):
        question = table_of(row, "question")
        yield from check_expected(question, row.get("expected"), ("attention", index, "expected"))
        if question.get("kind") in ("multiple", "matrix"):
            place = dotted(("attention", index, "question", "kind"))
            yield Fault(place, "such a question has one answer; use choice, scale, number or text")
        if question.get("shown_if") is not None:
            place = dotted(("attention", index, "question", "shown_if"))
            yield Fault(place, "such a question stands alone; leave this out")
        name = question.get("id")
        if isinstance(name, str) and ids.setdefault(name, index) != index:
            place = dotted(("attention", index, "question", "id"))
            yield Fault(place, f'id "{name}" is taken by attention.{ids[name]}; ids must differ')
    after = table_of(data, "breaks").get("after")
    listed = [n for n in after if isinstance(n, int)] if isinstance(after, list) else []
    for number in dict.fromkeys(n for n in listed if listed.count(n) > 1):
        yield Fault("breaks.after", f"{number} is listed twice")


def late_faults(
    trials: int, breaks: Breaks | None, attention: Iterable[Attention]
) -> Iterator[Fault]:
    """Yield a fault for each pause that would come after the last trial, or later."""
    for index, each in enumerate(attention):
        if each.after >= trials:
            yield Fault(f"attention.{index}.after", _late(each.after, trials))
    for after in breaks.after if breaks else ():
        if after >= trials:
            yield Fault("breaks.after", _late(after, trials))


def _late(after: int, trials: int) -> str:
    return f"{after} is no place between {trials} trials; use 1 to {trials - 1}"
