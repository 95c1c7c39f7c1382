"""Export: the tables of a study and the codebook that explains them, as files or data frames.

The columns are the analysis's own (``analysis.tables.columns``). Missing is empty, never zero. Who
did not consent or withdrew is in no table.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import pandas as pd
from pandas.api.extensions import ExtensionDtype

from analysis import Column, columns_of
from renderer.atomic_file import write_atomically
from study.data.codebook import codebook_of, own_columns
from study.data.collection import Collected, collect
from study.data.database import Database
from study.data.rows import Row, comparison_row, participant_row, rating_rows, trial_row
from study.data.studies import Study


@dataclass(frozen=True)
class Tables:
    """One study's tables and their codebook."""

    ratings: pd.DataFrame
    comparisons: pd.DataFrame
    participants: pd.DataFrame
    codebook: dict[str, Any]


def tables(db: Database, study: Study) -> Tables:
    """Return a study's tables with the analysis's columns, the study's own questions after them."""
    definition = study.definition
    people = [person for person in collect(db, study) if _is_in(person)]
    ratings: list[Row] = []
    comparisons: list[Row] = []
    for person in people:
        for collected in person.trials:
            if collected.trial.started_at is not None:
                shared = trial_row(study, person, collected)
                ratings += rating_rows(definition, shared, collected)
                comparisons.append(comparison_row(definition, shared, collected))
    participants = [participant_row(study, person) for person in people]
    more = own_columns(definition)
    return Tables(
        ratings=_frame("ratings", ratings, more["ratings"]),
        comparisons=_frame("comparisons", comparisons, more["comparisons"]),
        participants=_frame("participants", participants, more["participants"]),
        codebook=codebook_of(study, more),
    )


def write(db: Database, study: Study, folder: Path) -> list[Path]:
    """Write ratings.csv, comparisons.csv, participants.csv, codebook.json and the study itself.

    Each file appears whole or not at all. Returns the paths.
    """
    found = tables(db, study)
    files = {
        "ratings.csv": csv_of(found.ratings),
        "comparisons.csv": csv_of(found.comparisons),
        "participants.csv": csv_of(found.participants),
        "codebook.json": json.dumps(found.codebook, indent=2, ensure_ascii=False),
        "study.json": json.dumps(json.loads(study.definition.to_json()), indent=2),
    }
    for name, text in files.items():
        write_atomically(folder / name, text.encode())
    return [folder / name for name in files]


def csv_of(frame: pd.DataFrame) -> str:
    """Write a table as CSV: true and false in lower case, missing empty, one line break per row.

    Words that a spreadsheet would run as a formula get an apostrophe before them.
    """
    plain = frame.copy()
    for name in plain.columns:
        if plain[name].dtype == "boolean":
            plain[name] = plain[name].map({True: "true", False: "false"}, na_action="ignore")
        elif plain[name].dtype == "string":
            plain[name] = plain[name].map(_harmless, na_action="ignore")
    return str(plain.to_csv(index=False, lineterminator="\n"))


_FORMULA: Final = re.compile(r"[=+\-@\t\r](?![0-9.]+$)")  # how a formula begins; numbers may


def _harmless(text: str) -> str:
    """Return words that no spreadsheet takes for a formula (OWASP, "CSV Injection")."""
    return f"'{text}" if _FORMULA.match(text) else text


def _is_in(person: Collected) -> bool:
    return person.row.consented_at is not None


_DTYPES: Final[Mapping[str, ExtensionDtype]] = {
    "integer": pd.Int64Dtype(),
    "number": pd.Float64Dtype(),
    "boolean": pd.BooleanDtype(),
}


def _frame(table: str, rows: Iterable[Row], more: Sequence[Column] = ()) -> pd.DataFrame:
    columns = columns_of(table, more=more)
    listed = list(rows)
    data = {
        column.name: pd.Series([row.get(column.name) for row in listed], dtype="object").astype(
            _DTYPES.get(column.kind, pd.StringDtype())
        )
        for column in columns
    }
    return pd.DataFrame(data)
