"""Cells to typed columns: every fault of a table at once, each with row, column, found, accepted.

Rows are counted as a spreadsheet counts them: the header is row 1.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from typing import Final

import numpy as np
import pandas as pd

from analysis.tables.column import Column

_FIRST_ROW: Final = 2
_SHOWN_FAULTS: Final = 50
_ROWS_TOLD: Final = 3  # of rows with the same fault; of more the first alone
_DECIMAL_COMMA: Final = re.compile(r"^([+-]?\d+),(\d+)$")
_MOST_WHOLE: Final = 2.0**53  # beyond it two whole numbers may be read as one
_TRUTH: Final = {"true": True, "false": False, "1": True, "0": False}


class TableError(ValueError):
    """A table that cannot be analysed; ``faults`` holds every reason, the text the first fifty."""

    def __init__(self, faults: Iterable[str]) -> None:
        self.faults = tuple(faults)
        shown = list(self.faults[:_SHOWN_FAULTS])
        if len(self.faults) > len(shown):
            shown.append(f"and {len(self.faults) - len(shown)} more faults")
        super().__init__("\n".join(shown))


def check_header(names: Sequence[str], columns: Sequence[Column], *, source: str) -> list[str]:
    """Return the faults of a header: columns that are missing or occur twice."""
    faults = [
        f'{source}: row 1: column "{name}" occurs {names.count(name)} times; accepted: once'
        for name in dict.fromkeys(names)
        if names.count(name) > 1
    ]
    for column in columns:
        if column.required and column.name not in names:
            close = get_close_matches(column.name, names, n=1)
            hint = f'; did you mean it by "{close[0]}"?' if close else ""
            needed = ", ".join(c.name for c in columns if c.required)
            faults.append(
                f'{source}: row 1: column "{column.name}" is missing; found '
                f"{', '.join(names) or 'no columns'}; needed at least {needed}{hint}"
            )
    return faults


def parse_table(
    frame: pd.DataFrame, columns: Sequence[Column], *, source: str, decimal_commas: bool = False
) -> tuple[pd.DataFrame, list[str]]:
    """Give every column its type and return the table with all faults of its cells.

    Cells may be text or already typed. Missing columns are added, empty; unknown ones are left out.
    The frame's index plus two is the row that a fault names. With ``decimal_commas`` the number
    1,5 lies between 1 and 2.
    """
    parsed: dict[str, pd.Series] = {}
    faults: list[tuple[int, str]] = []
    for column in columns:
        if column.name in frame:
            text = _as_text(frame[column.name])
        else:
            text = pd.Series("", index=frame.index, dtype="string")
        is_number = decimal_commas and column.kind in ("integer", "number")
        read = text.str.replace(_DECIMAL_COMMA, r"\1.\2", regex=True) if is_number else text
        parsed[column.name], is_wrong = _parse(read, column)
        if column.name in frame:
            faults += _cell_faults(text[is_wrong], column)
    ordered = sorted(faults, key=lambda fault: fault[0])
    table = pd.DataFrame(parsed, index=frame.index)
    return table, [f"{source}: row {row + _FIRST_ROW}, {fault}" for row, fault in ordered]


def _cell_faults(wrong: pd.Series, column: Column) -> list[tuple[int, str]]:
    """Return row and words of each fault; one that many rows have is told once, at the first."""
    faults: list[tuple[int, str]] = []
    for found, own in wrong.groupby(wrong, sort=False):
        fault = f'{column.name}: found "{found}"; accepted {_accepted(column)}'
        rows = [int(row) for row in own.index]
        if len(rows) > _ROWS_TOLD:
            fault, rows = f"{fault} (and so in {len(rows) - 1} more rows)", rows[:1]
        faults += [(row, fault) for row in rows]
    return faults


def _as_text(series: pd.Series) -> pd.Series:
    cells = series.astype("string").fillna("")
    return pd.Series([cell.strip() for cell in cells.tolist()], index=cells.index, dtype="string")


def _parse(text: pd.Series, column: Column) -> tuple[pd.Series, np.ndarray]:
    is_empty = (text == "").to_numpy(dtype=bool)
    value, is_readable = _KINDS[column.kind](text, column)
    is_wrong = ~is_empty & ~is_readable
    if not column.may_be_empty:
        is_wrong |= is_empty
    return value, is_wrong


def _parse_number(text: pd.Series, column: Column) -> tuple[pd.Series, np.ndarray]:
    number = pd.to_numeric(text.astype(object), errors="coerce").astype("float64")
    values = number.to_numpy()
    is_readable = np.isfinite(values)
    if column.kind == "integer":
        is_readable &= values == np.floor(np.where(is_readable, values, 0.5))
        is_readable &= np.abs(np.where(is_readable, values, 0.0)) <= _MOST_WHOLE
    if column.low is not None:
        is_readable &= np.where(is_readable, values, -np.inf) >= column.low
    if column.high is not None:
        is_readable &= np.where(is_readable, values, np.inf) <= column.high
    number = number.where(is_readable)
    return number.astype("Int64") if column.kind == "integer" else number, is_readable


def _parse_boolean(text: pd.Series, _: Column) -> tuple[pd.Series, np.ndarray]:
    truth = text.str.lower().map(_TRUTH).astype("boolean")
    return truth, truth.notna().to_numpy(dtype=bool)


def _parse_category(text: pd.Series, column: Column) -> tuple[pd.Series, np.ndarray]:
    is_readable = text.isin(column.choices).to_numpy(dtype=bool)
    return text.where(is_readable, pd.NA), is_readable


def _parse_time(text: pd.Series, _: Column) -> tuple[pd.Series, np.ndarray]:
    time = pd.to_datetime(text.astype(object), errors="coerce", utc=True, format="ISO8601")
    return time, time.notna().to_numpy(dtype=bool)


def _parse_text(text: pd.Series, _: Column) -> tuple[pd.Series, np.ndarray]:
    return text.mask(text == "", pd.NA), np.ones(len(text), dtype=bool)


_KINDS: Final = {
    "integer": _parse_number,
    "number": _parse_number,
    "boolean": _parse_boolean,
    "category": _parse_category,
    "time": _parse_time,
    "text": _parse_text,
}


def _accepted(column: Column) -> str:
    empty = " or empty" if column.may_be_empty else ""
    if column.choices:
        return "one of " + ", ".join(column.choices) + empty
    if column.kind in ("integer", "number"):
        name = "whole number" if column.kind == "integer" else "number"
        low, high = (None if v is None else f"{v:g}" for v in (column.low, column.high))
        if low is not None and high is not None:
            return f"a {name} from {low} to {high}{empty}"
        few = " of at most 15 digits" if column.kind == "integer" else ""
        return f"a {name}{few}{'' if low is None else f' from {low} on'}{empty}"
    known = {"boolean": "true or false", "time": "a time like 2026-01-31T09:30:00+00:00"}
    return known.get(column.kind, "some text") + empty
