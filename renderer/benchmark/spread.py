"""What shots of a variant say together: medians, and how far the rounds lie from them. Pure."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from renderer.benchmark.clock import Shot


@dataclass(frozen=True)
class Spread:
    """Median and median absolute deviation of ``n`` milliseconds.

    ``gaps`` of them count a GPU's waiting for commands.
    """

    median: float
    mad: float
    n: int
    gaps: int = 0


def spread_of(shots: Sequence[Shot]) -> Spread:
    """Return the median of some frames' milliseconds and how far they lie from it."""
    return _spread([shot.ms for shot in shots], [shot.has_gaps for shot in shots])


def difference(with_it: Sequence[Shot], without: Sequence[Shot]) -> Spread:
    """Return the spread of the rounds' differences: with minus without."""
    pairs = list(zip(with_it, without, strict=True))
    return _spread([a.ms - b.ms for a, b in pairs], [a.has_gaps or b.has_gaps for a, b in pairs])


def asked_of(shots: Sequence[Shot]) -> dict[str, Any]:
    """Return what frames asked of the processor, as a row of ``bench.json`` names it: medians."""
    rows = [shot.row for shot in shots if shot.row]
    found: dict[str, Any] = {
        "processor_ms": _median([shot.asked.processor_ms for shot in shots]),
        "draw_calls": round(statistics.median(shot.asked.draw_calls for shot in shots)),
        "reads": round(statistics.median(shot.asked.reads for shot in shots)),
    }
    if rows:
        found |= {
            "row_ms": _median([row.ms for row in rows]),
            "wait_ms": _median([row.wait_ms for row in rows]),
        }
    return found


def _spread(values: Sequence[float], gaps: Sequence[bool]) -> Spread:
    median = statistics.median(values)
    deviation = statistics.median(abs(value - median) for value in values)
    return Spread(round(median, 3), round(deviation, 3), len(values), sum(gaps))


def _median(values: Sequence[float]) -> float:
    return round(statistics.median(values), 3)
