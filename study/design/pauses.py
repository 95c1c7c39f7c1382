"""What comes between trials: breaks, and attention questions on pages of their own.

Pure. Each comes after a number of trials, gold trials included, as the participant counts them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field

from study.design.attention import Attention, Number, late
from study.design.faults import Fault
from study.design.raw import Data, table_of
from study.design.texts import Page


class Breaks(Page):
    """A page that offers a rest, after each of these numbers of trials."""

    after: Annotated[tuple[Number, ...], Field(min_length=1)]


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
        Pause("attention", each.after, f"attention-{each.question.id}", each)
        for each in attention
        if each.after is not None
    ]
    rests = [Pause("break", after, f"break-{after}") for after in (breaks.after if breaks else ())]
    return tuple(sorted([*asked, *rests], key=lambda pause: pause.after))


def check_breaks(data: Data) -> Iterator[Fault]:
    """Yield a fault for each break that is listed twice."""
    after = table_of(data, "breaks").get("after")
    listed = [n for n in after if isinstance(n, int)] if isinstance(after, list) else []
    for number in dict.fromkeys(n for n in listed if listed.count(n) > 1):
        yield Fault("breaks.after", f"{number} is listed twice")


def late_breaks(trials: int, breaks: Breaks | None) -> Iterator[Fault]:
    """Yield a fault for each break that would come after the last trial, or later."""
    for after in breaks.after if breaks else ():
        if after >= trials:
            yield Fault("breaks.after", late(after, trials))
