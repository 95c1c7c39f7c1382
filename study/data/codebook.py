"""The codebook: every column of a study's tables, with the study's own values and questions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

from analysis import Column, codebook, column_names
from study.data.studies import Study
from study.design.definition import StudyDefinition
from study.design.questions import (
    STANDARD,
    ChoiceQuestion,
    NumberQuestion,
    Question,
    ScaleQuestion,
    accepted_values,
)


def own_columns(definition: StudyDefinition) -> dict[str, list[Column]]:
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


def codebook_of(study: Study, more: Mapping[str, Sequence[Column]]) -> dict[str, Any]:
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
