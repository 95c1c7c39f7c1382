"""What this very study could have shown: the margins that its own standard errors reach.

A verdict "not shown" says little unless a reader knows what the design could have shown at all. For
a LoD that truly is as real as the best one, and is noticed no more than equal eyes, the smallest
margin is told within which 80 % of such studies show it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import ndtri, stdtrit

from analysis.decision.margins import Margins
from analysis.decision.verdicts import excess_of
from analysis.estimates.noticing import Noticing
from analysis.estimates.realism import Realism
from analysis.power.needed import POWER

Floats = NDArray[np.float64]
COLUMNS: Final = (
    *("distance", "lod", "best", "people", "realism_error", "smallest_realism_margin"),
    *("realism_margin", "people_for_realism", "noticed_error", "smallest_noticed_margin"),
    *("noticed_margin", "people_for_noticed"),
)
_MOST_PEOPLE: Final = 100_000


def smallest_margin(error: float, people: int, *, confidence: float, power: float = POWER) -> float:
    """Return the margin that a true difference of 0 is shown to be within, with ``power``.

    ``error`` is the estimate's standard error: its one-sided bound lies t(n - 1) of them above it,
    and the estimate itself falls z of them too high in a share of 1 - ``power`` of studies.
    """
    return float((stdtrit(max(people - 1, 1), confidence) + ndtri(power)) * error)


def people_for(margin: float, error: float, people: int, *, confidence: float) -> int | None:
    """Return how many people like these the margin takes: errors fall with the root of people.

    None where it takes more than 100 000, or nothing at all is known.
    """
    if not (error > 0 and margin > 0 and np.isfinite(error)):
        return None
    if not _reaches(margin, error, people, _MOST_PEOPLE, confidence):
        return None
    low, high = 1, _MOST_PEOPLE
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (
            (low, middle) if _reaches(margin, error, people, middle, confidence) else (middle, high)
        )
    return high


def detectable(
    realism: Realism | None,
    noticing: Noticing | None,
    best: Mapping[str, str],
    *,
    margins: Margins,
) -> pd.DataFrame:
    """Return a row for every LoD beside the best at its distance; columns are COLUMNS.

    ``best`` names each distance's best LoD. Errors are half the width from the estimate to its
    one-sided upper bound, in standard errors. What was not asked stays empty.
    """
    if realism is None:
        return pd.DataFrame(columns=list(COLUMNS))
    rating, draws = realism.expected()
    place = {cell: i for i, cell in enumerate(realism.cells)}
    people = len(realism.stimuli.people)
    rows = []
    for distance, lod in realism.cells:
        top = place.get((distance, best.get(distance, "")))
        own = place[distance, lod]
        if top is None or top == own:
            continue
        row: dict[str, Any] = {"distance": distance, "lod": lod, "best": best[distance]}
        gap = float(rating[top] - rating[own]), draws[:, top] - draws[:, own]
        row |= {"people": people, **_reach("realism", gap, margins.realism_points, people, margins)}
        seen = excess_of(noticing, (distance, lod, best[distance]))
        if seen is not None:
            row |= _reach("noticed", seen, margins.noticed_share, people, margins)
        rows.append(row)
    table = pd.DataFrame(rows).reindex(columns=list(COLUMNS))
    return table.astype({name: "Int64" for name in COLUMNS if name.startswith("people")})


def _reach(
    name: str, found: tuple[float, Floats], margin: float, people: int, margins: Margins
) -> dict[str, Any]:
    value, draws = found
    confidence = margins.confidence
    bound = float(np.quantile(draws, confidence))
    error = max(bound - value, 0.0) / float(stdtrit(max(people - 1, 1), confidence))
    return {
        f"{name}_error": error,
        f"smallest_{name}_margin": smallest_margin(error, people, confidence=confidence),
        f"{name}_margin": margin,
        f"people_for_{name}": people_for(margin, error, people, confidence=confidence),
    }


def _reaches(margin: float, error: float, people: int, other: int, confidence: float) -> bool:
    there = error * float(np.sqrt(people / other))
    return smallest_margin(there, other, confidence=confidence) <= margin
