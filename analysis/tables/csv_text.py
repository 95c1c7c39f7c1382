"""CSV files of any origin as rows of text: encodings, separators, quotes, line ends, blank rows.

Knows no columns beyond the names that a header may hold. Rows are counted as a spreadsheet counts
them: the header is row 1, and a cell of several lines stands in one row.
"""

from __future__ import annotations

import codecs
import csv
import io
import re
from collections.abc import Collection
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import pandas as pd

FIRST_ROW: Final = 2
_SEPARATORS: Final = ",;\t"
_BLANK: Final = f"{_SEPARATORS} \r\n"
_UTF16: Final = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
_ZIP: Final = b"PK\x03\x04"  # what .xlsx and .ods begin with
_SAVING: Final = 'in a spreadsheet, save as "CSV UTF-8"'
_MISSING: Final = "NA"  # what R writes for a missing cell
_LONGEST_CELL: Final = 10_000_000


@dataclass
class CsvText:
    """A file's cells as text, with its faults and what a reader should know of how it was read.

    ``has_decimal_commas`` says that a comma inside a cell can only be a decimal one.
    """

    cells: pd.DataFrame = field(default_factory=pd.DataFrame)
    faults: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    has_decimal_commas: bool = False


def read_csv_text(path: Path, name: str, known: Collection[str]) -> CsvText:
    """Read a CSV file; ``known`` are the columns that tell its separator. Raises OSError.

    The frame's index plus FIRST_ROW is a row's number. ``name`` is what faults call the file.
    """
    found = CsvText()
    text = _decoded(path.read_bytes(), name, found.faults)
    if text is None:
        return found
    separator, text = _separator(text, known)
    found.has_decimal_commas = separator != ","
    rows = _rows(text, separator, name, found.faults)
    start = next((number for number, row in enumerate(rows) if any(row)), 0)
    header = _header(rows[start] if rows else [], known, name, found.notes)
    kept: dict[int, list[str]] = {}
    for number, row in enumerate(rows[start + 1 :], start=start):
        own, more = row[: len(header)], row[len(header) :]
        if not any(row):
            continue  # nothing is in it
        if len(row) < len(header) or any(more):
            found.faults.append(
                f"{name}: row {number + FIRST_ROW}: found {len(row)} cells; accepted "
                f"{len(header)}, as many as the header has"
            )
        else:
            kept[number] = own
    missing = sum(row.count(_MISSING) for row in kept.values())
    if missing:
        cells = "1 cell" if missing == 1 else f"{missing} cells"
        found.notes.append(f'{name}: "{_MISSING}" in {cells} was read as missing.')
        kept = {n: ["" if c == _MISSING else c for c in row] for n, row in kept.items()}
    index = pd.Index(list(kept), dtype="int64")
    table = pd.DataFrame(list(kept.values()), index=index, columns=header, dtype="string")
    is_used = [bool(own) or (table.iloc[:, i] != "").any() for i, own in enumerate(header)]
    found.cells = table.loc[:, is_used]
    return found


def _decoded(content: bytes, name: str, faults: list[str]) -> str | None:
    if content.startswith(_ZIP):
        faults.append(f"{name}: a spreadsheet's own file; accepted: CSV text ({_SAVING})")
        return None
    is_wide = content.startswith(_UTF16)
    encoding, called = ("utf-16", "UTF-16") if is_wide else ("utf-8-sig", "UTF-8")
    try:
        text = content.decode(encoding)
        wrong = text.find("\0")
        row, found, called = text[: max(wrong, 0)].count("\n") + 1, 0, "text"
    except UnicodeDecodeError as error:
        text, wrong = "", error.start
        row, found = content[:wrong].count(b"\n") + 1, content[wrong]
    if wrong < 0:
        return text
    faults.append(
        f"{name}: row {row}: byte {found:#04x} is not {called}; accepted: CSV text in UTF-8, "
        f"or in UTF-16 with a byte order mark ({_SAVING})"
    )
    return None


def _separator(text: str, known: Collection[str]) -> tuple[str, str]:
    """Return what separates cells, and the text without a line that only says so."""
    told = re.match(r"\ufeff?sep=(.)\r?\n?", text)
    if told and told[1] in _SEPARATORS:
        return told[1], text[told.end() :]
    lines = io.StringIO(text, newline="")
    first = next((line for line in lines if line.strip(_BLANK)), "")

    def fit(separator: str) -> tuple[int, int]:
        names = next(csv.reader([first], delimiter=separator), [])
        return sum(_plain(own) in known for own in names), len(names)

    return max(_SEPARATORS, key=fit), text


def _rows(text: str, separator: str, name: str, faults: list[str]) -> list[list[str]]:
    csv.field_size_limit(_LONGEST_CELL)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    rows: list[list[str]] = []
    try:
        rows.extend([cell.strip() for cell in row] for row in reader)
    except csv.Error as error:
        faults.append(
            f"{name}: row {len(rows) + 1}: {error}; accepted: a quote opens a cell, another closes "
            'it, and "" inside stands for one quote'
        )
    return rows


def _header(names: list[str], known: Collection[str], name: str, notes: list[str]) -> list[str]:
    """Return the columns' names; those that differ from a known one in spelling alone get its."""
    header: list[str] = []
    for own in names:
        plain = _plain(own)
        is_meant = own not in known and plain in known and plain not in (*names, *header)
        if is_meant:
            notes.append(f'{name}: column "{own}" was read as {plain}.')
        header.append(plain if is_meant else own)
    return header


def _plain(name: str) -> str:
    return re.sub(r"[\s-]+", "_", name.strip().lower())
