"""Numbers and lists as they stand in sentences, captions and tables of the report."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence


def number(value: float, *, digits: int = 2) -> str:
    """Write a number with a true minus sign; an en dash where there is none."""
    if value is None or not math.isfinite(value):
        return "–"
    return _signed(f"{value:.{digits}f}")


def _signed(text: str) -> str:
    """Give a number a true minus sign, and none if it is zero as written."""
    return text.replace("-", "−" if float(text) else "")


def interval(low: float, high: float, *, digits: int = 2) -> str:
    """Write an interval as "0.10 to 0.90"; says so where there is none."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return "no interval"
    return f"{number(low, digits=digits)} to {number(high, digits=digits)}"


def percent(share: float) -> str:
    """Write a share as a whole percentage."""
    return f"{_signed(f'{100 * share:.0f}')}\N{NO-BREAK SPACE}%" if math.isfinite(share) else "–"


def p_value(p: float) -> str:
    """Write a p value as in "p = 0.03"; very small ones as a bound."""
    return "p < 0.001" if p < 0.001 else f"p = {number(p, digits=3 if p < 0.1 else 2)}"


def milliseconds(value: float) -> str:
    """Write a duration in milliseconds, with decimals only where they matter."""
    return f"{value:.{0 if value >= 100 else 1}f}\N{NO-BREAK SPACE}ms"


def listed(names: Sequence[str]) -> str:
    """Join as in a sentence: "a, b and c"."""
    if len(names) < 2:
        return "".join(names)
    return f"{', '.join(names[:-1])} and {names[-1]}"


def counted(count: int, one: str, many: str) -> str:
    """Write a count with its noun."""
    return f"{count} {one if count == 1 else many}"


def people(count: int) -> str:
    """Write a number of people (or answers) as in "n = 10", kept on one line."""
    return f"n\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}{count}"


def place(distance: str, lods: Collection[str]) -> str:
    """Name a distance where LoDs are named, too: "medium distance" if "medium" is also a LoD."""
    return f"{distance} distance" if distance in lods else distance
