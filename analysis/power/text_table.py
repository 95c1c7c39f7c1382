"""The table that ``ocularist power`` prints: how many studies come to the right verdict."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import pandas as pd

from analysis.power.outcome import Outcome
from analysis.tables.records import records
from analysis.words.wording import number, percent

Row = Mapping[str, Any]


def table_lines(outcome: Outcome) -> Iterator[str]:
    """Yield the share of right verdicts for each distance, LoD and number of people.

    LoDs that nobody sees at a distance are left to the sentences.
    """
    head = [f"{n} people" for n in sorted(set(outcome.verdicts["participants"].astype(int)))]
    lines = [["distance", "LoD", "assumed", "right verdict", *head]]
    shown = outcome.verdicts[outcome.verdicts["true_loss"].notna()]
    for _, rows in shown.groupby(["distance", "lod"], sort=False):
        own = by_people(rows)
        name = str(own[0]["right_verdict"])
        start = [own[0]["distance"], own[0]["lod"], _assumed(own[0]), name or "–"]
        lines.append([*start, *(_cell(row, name) for row in own)])
    yield from _aligned(lines)
    rows = outcome.cheapest[outcome.cheapest["best"] != ""]
    if rows.empty:  # no LoD has a place in an order
        return
    yield ""
    lines = [["distance", "cheapest that is enough", *(f"named by {words}" for words in head)]]
    for _, each in rows.groupby("distance", sort=False):
        own = by_people(each)
        start = [own[0]["distance"], own[0]["right_lod"] or "–"]
        lines.append([*start, *(_cell(row, "right") for row in own)])
    yield from _aligned(lines, left=2)


def by_people(rows: pd.DataFrame) -> list[dict[str, Any]]:
    """Return rows by rising number of people."""
    return records(rows.sort_values("participants"))


def _cell(row: Row, name: str) -> str:
    """Write the share of the right verdict; of "equivalent" where there is no right one."""
    shown = name or "equivalent"
    return "cannot" if pd.isna(row[shown]) else percent(float(row[shown]))


def _assumed(row: Row) -> str:
    seen: str = "?" if pd.isna(row["true_noticed"]) else percent(row["true_noticed"])
    return f"{number(-row['true_loss'])} points, {seen}"


def _aligned(lines: list[list[str]], *, left: int = 4) -> Iterator[str]:
    """Yield rows with their columns under each other, the first ones to the left."""
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    for line in lines:
        cells = [
            f"{cell:<{width}}" if i < left else f"{cell:>{width}}"
            for i, (cell, width) in enumerate(zip(line, widths, strict=True))
        ]
        yield "  ".join(cells).rstrip()
