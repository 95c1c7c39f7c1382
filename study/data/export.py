"""Export: the tables of a study and the codebook that explains them, as files or data frames.

The columns are the analysis's own (``analysis.table``). Missing is empty, never zero. Who did not
consent or withdrew is in no table.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any, Final

import pandas as pd
from pandas.api.extensions import ExtensionDtype

from analysis import Column, codebook, column_names, columns_of
from renderer.detail import lod_rank
from renderer.manifest import write_atomically
from study.data import devices
from study.data.collection import Collected, CollectedTrial, collect
from study.data.database import Database
from study.data.devices import plausible
from study.data.progress import early_step
from study.data.studies import Study
from study.data.trials import ANSWERED, PLAYED
from study.data.views import is_certified
from study.design.definition import StudyDefinition
from study.design.parts import read_size
from study.design.pixels import median_iris_px
from study.design.questions import (
    STANDARD,
    ChoiceQuestion,
    NumberQuestion,
    Question,
    ScaleQuestion,
    accepted_values,
)

Row = dict[str, Any]
COMPLETED: Final = "completed"


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
                shared = _trial_row(study, person, collected)
                ratings += _rating_rows(definition, shared, collected)
                comparisons.append(_comparison_row(definition, shared, collected))
    participants = [_participant_row(study, person) for person in people]
    more = _own_columns(definition)
    return Tables(
        ratings=_frame("ratings", ratings),
        comparisons=_frame("comparisons", comparisons, more["comparisons"]),
        participants=_frame("participants", participants, more["participants"]),
        codebook=_codebook(study, more),
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
    """Write a table as CSV: true and false in lower case, missing empty, one line break per row."""
    plain = frame.copy()
    for name in plain.columns:
        if plain[name].dtype == "boolean":
            plain[name] = plain[name].map({True: "true", False: "false"}, na_action="ignore")
    return str(plain.to_csv(index=False, lineterminator="\n"))


def _is_in(person: Collected) -> bool:
    return person.row.consented_at is not None and person.row.withdrawn_at is None


def _who(study: Study, person: Collected) -> Row:
    return {
        "study": study.key,
        "study_version": study.version,
        "simulated": person.row.simulated,
        "participant": person.row.public_id,
    }


def _trial_row(study: Study, person: Collected, collected: CollectedTrial) -> Row:
    """Return what the two tables about trials share."""
    trial, row = collected.trial, person.row
    plays = [e.payload for e in collected.events if e.kind == PLAYED and e.payload["is_complete"]]
    clip = study.definition.clip(trial.clip)
    return {
        **_who(study, person),
        "session": f"{row.public_id}-{collected.sitting}" if collected.sitting else None,
        "trial": f"{row.public_id}-{trial.position:02d}",
        "position": trial.number,
        "clip": trial.clip,
        "distance": clip.distance,
        "shown_scale": _last(plays, "shown_scale"),
        "orbit_direction": row.orbit_direction,
        "is_practice": trial.is_practice,
        "is_catch": clip.is_catch,
        "certified": _certified(plays),
        "dropped_frames": _total(plays, "dropped_frames"),
        "views": trial.views,
        "response_ms": _response_ms(collected),
        "started_at": _iso(trial.started_at),
        "_iris_px": _iris_px(study.definition, person, collected),
    }


def _rating_rows(
    definition: StudyDefinition, shared: Row, collected: CollectedTrial
) -> Iterator[Row]:
    clip = definition.clip(collected.trial.clip)
    lods = {"left": clip.left, "right": clip.right}
    for eye, other, index in (("left", "right", 0), ("right", "left", 1)):
        yield {
            **shared,
            "iris_px": shared["_iris_px"][index],
            "eye": eye,
            "lod": lods[eye],
            "lod_rank": lod_rank(lods[eye]),
            "other_lod": lods[other],
            **definition.detail(lods[eye]).levels(),
            "rating": collected.trial.answers.get(f"rating_{eye}"),
        }


def _comparison_row(definition: StudyDefinition, shared: Row, collected: CollectedTrial) -> Row:
    clip = definition.clip(collected.trial.clip)
    return {
        **shared,
        "iris_px": round(sum(shared["_iris_px"]) / 2, 2),
        "left_lod": clip.left,
        "right_lod": clip.right,
        **collected.trial.answers,
    }


def _participant_row(study: Study, person: Collected) -> Row:
    row = person.row
    step = early_step(row, study.definition)
    done = sum(c.trial.is_complete and not c.trial.is_practice for c in person.trials)
    return {
        **_who(study, person),
        "started_at": _iso(row.consented_at),
        "completed_at": _iso(row.completed_at),
        "status": COMPLETED if row.completed_at else step or f"{done} trials",
        **person.about,
        **{name: person.device.get(name) for name in devices.COLUMNS},
        "arm": f"{row.size} {row.orbit_direction}" if row.size else None,
    }


def _iris_px(
    definition: StudyDefinition, person: Collected, collected: CollectedTrial
) -> tuple[float, float]:
    clip = definition.clip(collected.trial.clip)
    spec = definition.clip_spec(
        clip,
        size=read_size(person.row.size or ""),
        orbit_direction=person.row.orbit_direction or "",
    )
    return median_iris_px(spec)


def _response_ms(collected: CollectedTrial) -> int | None:
    finals = [e.payload for e in collected.events if e.kind == ANSWERED and e.payload["is_final"]]
    found = plausible(finals[-1].get("response_ms")) if finals else None
    return None if found is None else round(found)


def _certified(plays: Sequence[Mapping[str, Any]]) -> bool | None:
    """Return True if one play passed the rule, None if nobody counted the frames of any."""
    verdicts = [verdict for play in plays if (verdict := is_certified(play)) is not None]
    return any(verdicts) if verdicts else None


def _last(plays: Sequence[Mapping[str, Any]], name: str) -> float | None:
    values = [value for play in plays if (value := plausible(play.get(name))) is not None]
    return values[-1] if values else None


def _total(plays: Sequence[Mapping[str, Any]], name: str) -> int | None:
    values = [value for play in plays if (value := plausible(play.get(name))) is not None]
    return round(sum(values)) if values else None


def _iso(moment: datetime | None) -> str | None:
    return None if moment is None else moment.isoformat(timespec="milliseconds")


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


def _own_columns(definition: StudyDefinition) -> dict[str, list[Column]]:
    """Return the columns of questions that only this study asks."""
    return {
        "comparisons": [_column(q) for q in definition.questions if q.id not in STANDARD],
        "participants": [
            _column(q) for q in definition.about if q.id not in column_names("participants")
        ],
    }


def _column(question: Question) -> Column:
    if isinstance(question, ScaleQuestion):
        return Column(
            question.id, "integer", question.text, low=question.lowest, high=question.highest
        )
    if isinstance(question, NumberQuestion):
        return Column(
            question.id,
            "integer",
            question.text,
            question.unit,
            low=question.minimum,
            high=question.maximum,
        )
    if isinstance(question, ChoiceQuestion):
        choices = tuple(map(str, accepted_values(question)))
        return Column(question.id, "category", question.text, choices=choices)
    return Column(question.id, "text", question.text)


_LOD_COLUMNS: Final = ("lod", "other_lod", "left_lod", "right_lod")


def _codebook(study: Study, more: Mapping[str, Sequence[Column]]) -> dict[str, Any]:
    definition = study.definition
    accepted: dict[str, Any] = {
        "clip": [clip.id for clip in definition.every_clip],
        "distance": list(definition.distances),
        **{name: list(definition.lods) for name in _LOD_COLUMNS},
    }
    for question in (*definition.about, *definition.questions):
        if isinstance(question, ChoiceQuestion) and question.id not in STANDARD:
            accepted[question.id] = [str(value) for value in accepted_values(question)]
    about = {
        "study": study.key,
        "study_version": study.version,
        "title": study.title,
        "definition_hash": definition.definition_hash,
    }
    return {**about, **codebook(accepted, more=more)}
