"""Numbers and lists as they stand in sentences, captions and tables of the report."""

from __future__ import annotations

import math
from collections.abc import Sequence


def number(value: float, *, digits: int = 2) -> str:
    """Write a number with a true minus sign; an en dash where there is none."""
    if value is None or not math.isfinite(value):
        return "–"
    return f"{value:.{digits}f}".replace("-", "−")


def interval(low: float, high: float, *, digits: int = 2) -> str:
    """Write an interval as "0.10 to 0.90"; says so where there is none."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return "no interval"
    return f"{number(low, digits=digits)} to {number(high, digits=digits)}"


def percent(share: float) -> str:
    """Write a share as a whole percentage."""
    return f"{share:.0%}" if math.isfinite(share) else "–"


def listed(names: Sequence[str]) -> str:
    """Join as in a sentence: "a, b and c"."""
    if len(names) < 2:
        return "".join(names)
    return f"{', '.join(names[:-1])} and {names[-1]}"


def counted(count: int, one: str, many: str) -> str:
    """Write a count with its noun."""
    return f"{count} {one if count == 1 else many}"
