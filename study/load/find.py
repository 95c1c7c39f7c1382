"""The largest crowd that a site carries: doubled until it is too large, then narrowed down."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from study.load.report import Figures

NEAR: Final = 1.15
"""Two crowds this near to each other are one: runs differ by as much."""


def largest(measure: Callable[[int], Figures], *, below_ms: float, most: int) -> int:
    """Return with how many people, ``most`` at the most, p95 stays below so many milliseconds.

    0 where not even one person is carried. Begins with an eighth of ``most``.
    """
    carried, too_many, people = 0, most + 1, max(1, most // 8)
    while carried < most and too_many > max(carried + 1, carried * NEAR):
        if is_carried(measure(people), below_ms=below_ms):
            carried = people
        else:
            too_many = people
        people = min(2 * carried, most) if too_many > most else (carried + too_many) // 2
    return carried


def is_carried(figures: Figures, *, below_ms: float) -> bool:
    """Say whether everybody of a crowd came, was answered in time, and nothing went wrong."""
    return (
        figures.there == figures.people
        and figures.p95_ms < below_ms
        and not (figures.errors or figures.lost)
    )
