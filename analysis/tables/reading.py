"""Tables from a ratings file, an export's folder or data frames, checked and completed.

The edge of the package: it touches files, the statistics behind it do not. A database is no source
here; whoever has one hands its tables to ``tables_from``.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

import pandas as pd

from analysis.decision.margins import DEFAULT, Margins, declared_margins
from analysis.tables.codebook import accepted_in, columns_of
from analysis.tables.columns import COLUMNS, SCALE
from analysis.tables.completing import (
    complete_comparisons,
    complete_ratings,
    drop_repeated_rows,
    rank_faults,
)
from analysis.tables.csv_text import CsvText, read_csv_text
from analysis.tables.parsing import TableError, check_header, parse_table

_FILES: Final = {table: f"{table}.csv" for table in COLUMNS}
_CODEBOOK: Final = "codebook.json"
_MOST_STEPS: Final = 101  # 0 to 100: an ordinal model has a threshold between any two


@dataclass(frozen=True)
class Tables:
    """One study's answers, typed and complete in columns, as the statistics take them.

    ``notes`` say in sentences what was left out or added on the way; ``scale`` is the lowest and
    the highest rating that could be given; ``margins`` are what the study declared beforehand.
    """

    ratings: pd.DataFrame
    comparisons: pd.DataFrame
    participants: pd.DataFrame
    source: str = "tables"
    notes: tuple[str, ...] = ()
    scale: tuple[int, int] = SCALE
    is_simulated: bool = field(default=False)
    margins: Margins = DEFAULT


def read_source(source: str | Path) -> Tables:
    """Read a ratings file, or an export's folder with ratings.csv and what lies beside it.

    Raises TableError with every fault of every file: file, row, column, found, accepted.
    """
    path = Path(source)
    if not path.exists():
        raise TableError([f"{path}: not found; accepted: a ratings file or an export's folder"])
    if not path.is_dir():
        return tables_from({"ratings": path}, source=str(path))
    files = {table: path / name for table, name in _FILES.items() if (path / name).is_file()}
    if "ratings" not in files:
        found = ", ".join(sorted(p.name for p in path.iterdir())[:20]) or "nothing"
        raise TableError([f"{path}: found {found}; needed at least ratings.csv"])
    book = _read_codebook(path / _CODEBOOK) if (path / _CODEBOOK).is_file() else None
    return tables_from(files, source=str(path), codebook=book)


def tables_from(
    frames: Mapping[str, pd.DataFrame | Path],
    *,
    source: str = "tables",
    codebook: Mapping[str, Any] | None = None,
) -> Tables:
    """Check and complete tables given by name: ratings, and optionally comparisons, participants.

    Each is a data frame with text or typed cells, or the path of a CSV file. A study's ``codebook``
    narrows what is accepted. Raises TableError with every fault of every table.
    """
    faults: list[str] = []
    notes: list[str] = []
    parsed: dict[str, pd.DataFrame] = {}
    scale = _scale_of(codebook)
    for table in COLUMNS:
        frame = frames.get(table)
        accepted = accepted_in(codebook, table) if codebook else {}
        name = frame.name if isinstance(frame, Path) else _FILES[table]
        columns = columns_of(table, accepted)
        loaded = _load(frame, name, {column.name for column in columns})
        raw = loaded.cells
        faults += loaded.faults
        notes += loaded.notes
        if frame is not None and not (loaded.faults and raw.empty):
            faults += check_header(list(raw.columns), columns, source=name)
        raw = raw.loc[:, ~raw.columns.duplicated()]
        typed, cell_faults = parse_table(
            raw, columns, source=name, decimal_commas=loaded.has_decimal_commas
        )
        faults += cell_faults
        faults += rank_faults(typed, name) if table == "ratings" else []
        notes += _unknown_columns(raw, {c.name for c in columns}, name)
        parsed[table] = drop_repeated_rows(typed, table, name, faults=faults, notes=notes)
    if faults:
        raise TableError(faults)
    made = _assemble(parsed, source=source, notes=notes, scale=scale)
    return replace(made, margins=declared_margins(codebook)) if codebook else made


def _scale_of(codebook: Mapping[str, Any] | None) -> tuple[int, int]:
    """Return the lowest and highest rating; raises TableError for what no one can rate on."""
    accepted = accepted_in(codebook, "ratings") if codebook else {}
    low, high = (float(end) for end in accepted.get("rating", SCALE))
    if not (low.is_integer() and high.is_integer() and 1 <= high - low < _MOST_STEPS):
        raise TableError(
            [
                f"{_CODEBOOK}: rating: found {low:g} to {high:g}; accepted: whole numbers, the "
                f"highest 1 to {_MOST_STEPS - 1} above the lowest"
            ]
        )
    return int(low), int(high)


def _assemble(
    parsed: Mapping[str, pd.DataFrame], *, source: str, notes: list[str], scale: tuple[int, int]
) -> Tables:
    people = parsed["participants"]
    ratings = complete_ratings(parsed["ratings"], people)
    comparisons = complete_comparisons(parsed["comparisons"], people)
    is_fake = {"ratings": ratings["simulated"], "comparisons": comparisons["simulated"]}
    has_people = any((~fake).any() for fake in is_fake.values())
    has_fakes = any(fake.any() for fake in is_fake.values())
    if has_people and has_fakes:
        count = int(ratings["simulated"].sum())
        notes.append(
            f"People and simulated observers stand in one table: {count} simulated ratings were "
            "left out."
        )
        ratings = ratings[~ratings["simulated"]].reset_index(drop=True)
        comparisons = comparisons[~comparisons["simulated"]].reset_index(drop=True)
        people = people[~people["simulated"].fillna(False)].reset_index(drop=True)
    return Tables(
        ratings=ratings,
        comparisons=comparisons,
        participants=people,
        source=source,
        notes=tuple(notes),
        scale=scale,
        is_simulated=has_fakes and not has_people,
    )


def _load(frame: pd.DataFrame | Path | None, name: str, known: Collection[str]) -> CsvText:
    if frame is None:
        return CsvText()
    if isinstance(frame, Path):
        return read_csv_text(frame, name, known)
    return CsvText(frame.reset_index(drop=True))


def _unknown_columns(frame: pd.DataFrame, known: set[str], name: str) -> list[str]:
    unknown = [str(column) or '""' for column in frame.columns if column not in known]
    return [f"{name}: not analysed: {', '.join(unknown)}."] if unknown else []


def _read_codebook(path: Path) -> dict[str, Any]:
    try:
        book = json.loads(path.read_text(encoding="utf-8"))
        accepted_in(book, "ratings")
        declared_margins(book)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise TableError(
            [f"{path.name}: not a codebook ({error}); accepted: the file that export writes"]
        ) from None
    return dict(book)
