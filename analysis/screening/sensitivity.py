"""Does a verdict hang on one person? Verdicts with and without everyone who was flagged.

Knows no model: whoever asks passes in how tables and weights become decisions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final

import pandas as pd

from analysis.decision.verdicts import Decision
from analysis.tables.reading import Tables

Decide = Callable[[Tables, dict[str, float]], Sequence[Decision]]
WEIGHTED: Final = "everyone, flagged people weigh less"
UNWEIGHTED: Final = "everyone, all weigh the same"
NOBODY_FLAGGED: Final = "without all flagged people"
COLUMNS: Final = ("people", "flags", "distance", "lod", "verdict", "usual", "is_moved")


def verdict_sensitivity(
    tables: Tables,
    flags: Mapping[str, Sequence[str]],
    *,
    usual: Sequence[Decision],
    weights: Mapping[str, float],
    decide: Decide,
    most: int = 12,
) -> pd.DataFrame:
    """Return every verdict as usual, unweighted, without each flagged person, and without all.

    ``usual`` are the decisions of the weighted analysis and ``weights`` its weights; ``decide``
    repeats it for other tables and weights. Beyond ``most`` flagged people nobody is left out one
    by one, because every row takes a fit. Columns: people (who was counted), flags (of the
    person left out), distance, lod, verdict, usual (the verdict of the weighted analysis) and
    is_moved. A person without whom nothing is left to decide has an empty verdict.
    """
    known = _named(usual)
    rows = _rows(WEIGHTED, "", known, known)
    rows += _rows(UNWEIGHTED, "", _named(decide(tables, {})), known)
    alone = flags if len(flags) <= most else {}
    for who, own in alone.items():
        rest = without(tables, [who])
        found = _named(decide(rest, _present(weights, rest)))
        rows += _rows(f"without {who}", ", ".join(own), found, known)
    if len(flags) > 1:
        rest = without(tables, flags)
        rows += _rows(NOBODY_FLAGGED, "", _named(decide(rest, _present(weights, rest))), known)
    return pd.DataFrame(rows, columns=list(COLUMNS))


def without(tables: Tables, people: Iterable[str]) -> Tables:
    """Return the tables without some people's rows."""
    left_out = list(people)
    ratings, comparisons, participants = (
        frame[~frame["participant"].isin(left_out)].reset_index(drop=True)
        for frame in (tables.ratings, tables.comparisons, tables.participants)
    )
    return replace(tables, ratings=ratings, comparisons=comparisons, participants=participants)


Verdicts = dict[tuple[str, str], str]


def _present(weights: Mapping[str, float], tables: Tables) -> dict[str, float]:
    here = set(tables.ratings["participant"].astype(str))
    return {who: weight for who, weight in weights.items() if who in here}


def _named(decisions: Sequence[Decision]) -> Verdicts:
    return {
        (decision.distance, verdict.lod): verdict.outcome
        for decision in decisions
        for verdict in decision.verdicts
    }


def _rows(people: str, flags: str, found: Verdicts, usual: Verdicts) -> list[tuple[object, ...]]:
    return [
        (
            people,
            flags,
            *cell,
            found.get(cell, ""),
            usual.get(cell, ""),
            found.get(cell) != usual.get(cell),
        )
        for cell in dict.fromkeys([*usual, *found])
    ]
