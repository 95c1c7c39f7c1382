"""Does a verdict hang on one person? Verdicts with and without everyone who was flagged.

Knows no model: whoever asks passes in how tables and weights become decisions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final

import pandas as pd

from analysis.decision.verdicts import Decision, verdict_table
from analysis.reading import Tables

Decide = Callable[[Tables, dict[str, float]], Sequence[Decision]]
WEIGHTED: Final = "everyone, flagged people weigh less"
UNWEIGHTED: Final = "everyone, all weigh the same"
NOBODY_FLAGGED: Final = "without all flagged people"
COLUMNS: Final = ("people", "flags", "distance", "lod", "verdict", "usual", "is_moved")


def verdict_sensitivity(
    tables: Tables,
    flags: Mapping[str, Sequence[str]],
    *,
    weights: Mapping[str, float],
    decide: Decide,
) -> pd.DataFrame:
    """Return every verdict as usual, unweighted, without each flagged person, and without all.

    ``weights`` are those of the usual analysis. Columns: people (who was counted), flags (of the
    person left out), distance, lod, verdict, usual (the verdict of the weighted analysis) and
    is_moved. A person without whom nothing is left to decide has an empty verdict.
    """
    usual = _verdicts(tables, weights, decide)
    rows = _rows(WEIGHTED, "", usual, usual) + _rows(
        UNWEIGHTED, "", _verdicts(tables, {}, decide), usual
    )
    for who, own in flags.items():
        found = _verdicts(without(tables, [who]), weights, decide)
        rows += _rows(f"without {who}", ", ".join(own), found, usual)
    if len(flags) > 1:
        found = _verdicts(without(tables, flags), weights, decide)
        rows += _rows(NOBODY_FLAGGED, "", found, usual)
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


def _verdicts(tables: Tables, weights: Mapping[str, float], decide: Decide) -> Verdicts:
    present = set(tables.ratings["participant"].astype(str))
    own = {who: weight for who, weight in weights.items() if who in present}
    table = verdict_table(list(decide(tables, own)))
    if table.empty:
        return {}
    return {
        (str(distance), str(lod)): str(verdict)
        for distance, lod, verdict in zip(
            table["distance"], table["lod"], table["verdict"], strict=True
        )
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
