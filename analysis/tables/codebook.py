"""``codebook.json``: what every column of a study's tables means and accepts, written and read."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from analysis.tables.column import Accepted, Column
from analysis.tables.columns import COLUMNS


def columns_of(
    table: str,
    accepted: Mapping[str, Accepted] | None = None,
    *,
    more: Iterable[Column] = (),
) -> tuple[Column, ...]:
    """Return a table's columns with a study's own accepted values and additional columns."""
    accepted = accepted or {}
    columns = (*COLUMNS[table], *more)
    return tuple(
        column.accepting(accepted[column.name]) if column.name in accepted else column
        for column in columns
    )


def codebook(
    accepted: Mapping[str, Accepted] | None = None,
    *,
    more: Mapping[str, Iterable[Column]] | None = None,
) -> dict[str, Any]:
    """Describe every column of every table: the content of ``codebook.json``.

    ``accepted`` narrows columns to what one study uses, as in ``{"lod": ["low", "ultra"],
    "rating": (1, 7)}``; ``more`` adds a study's own columns to a table.
    """
    more = more or {}
    return {
        "missing": "an empty cell",
        "tables": {
            table: [c.to_dict() for c in columns_of(table, accepted, more=more.get(table, ()))]
            for table in COLUMNS
        },
    }


def accepted_in(book: Mapping[str, Any], table: str) -> dict[str, Accepted]:
    """Read from a codebook what one table's columns accept: the reverse of ``codebook``."""
    accepted: dict[str, Accepted] = {}
    known = {column.name: column for column in COLUMNS[table]}
    for entry in book["tables"].get(table, ()):
        found = entry.get("accepted")
        column = known.get(entry["name"])
        if found is None or column is None:
            continue
        if isinstance(found, list):
            accepted[column.name] = found
        elif found["lowest"] is not None and found["highest"] is not None:
            accepted[column.name] = (found["lowest"], found["highest"])
    return accepted
