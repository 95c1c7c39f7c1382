"""The languages of a study: its words in its own, and in those that it is translated into."""

from __future__ import annotations

from study.design.definition import StudyDefinition


def languages_of(definition: StudyDefinition) -> tuple[str, ...]:
    """Return the languages that a study's words are written in, its own first."""
    return (definition.language,)


def in_language(definition: StudyDefinition, language: str) -> StudyDefinition:
    """Return a study with its words in one of its languages; as it is for any other."""
    del language  # every study has one language so far
    return definition
