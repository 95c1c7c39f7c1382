"""The codebook: every column of a study's tables, with the study's own values and questions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

from analysis import Column, codebook, column_names
from study.data import own_answers
from study.data.studies import Study
from study.design.attention import Attention
from study.design.definition import StudyDefinition
from study.design.questions import STANDARD, ChoiceQuestion, accepted_values, each_asked
from study.design.recruiting import Parameter


def own_columns(definition: StudyDefinition) -> dict[str, list[Column]]:
    """Return the columns of questions that only this study asks."""
    return {
        "ratings": own_answers.eye_columns(definition.questions),
        "comparisons": [
            *own_answers.own_columns(
                definition.questions, own_answers.ids_of_eyes(definition.questions) | set(STANDARD)
            ),
            *(column for each in definition.attention_within for column in _attention(each)),
        ],
        "participants": [
            *own_answers.own_columns(definition.about, column_names("participants")),
            *(_parameter(p) for p in definition.entrance.parameters if p.is_exported),
        ],
    }


def _attention(asked: Attention) -> list[Column]:
    """Return the columns of an attention question, which say what it should have been answered."""
    told = f" (an attention question in trial {asked.within}; expected: {asked.expected})"
    columns = own_answers.own_columns([asked.question], ())
    return [replace(column, meaning=column.meaning + told) for column in columns]


def _parameter(parameter: Parameter) -> Column:
    told = "" if parameter.store == "plain" else ", as a keyed hash"
    return Column(parameter.name, "text", f"{parameter.name} of the address they came by{told}")


_LOD_COLUMNS: Final = ("lod", "other_lod", "left_lod", "right_lod")


def codebook_of(study: Study, more: Mapping[str, Sequence[Column]]) -> dict[str, Any]:
    definition = study.definition
    accepted: dict[str, Any] = {
        "clip": [clip.id for clip in definition.every_clip],
        "distance": list(definition.distances),
        "language": list(definition.languages),
        **({"iris": list(definition.irises)} if definition.irises else {}),
        **{name: list(definition.lods) for name in _LOD_COLUMNS},
    }
    for question in each_asked((*definition.about, *definition.questions_of_all_trials)):
        if isinstance(question, ChoiceQuestion) and question.id not in STANDARD:
            accepted[question.id] = [str(value) for value in accepted_values(question)]
    about = {
        "study": study.key,
        "study_version": study.version,
        "title": study.title,
        "definition_hash": definition.definition_hash,
    }
    rule = definition.decision
    declared = {} if rule is None else {"decision": rule.model_dump(mode="json")}
    return {**about, **declared, **codebook(accepted, more=more)}
