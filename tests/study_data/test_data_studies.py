"""A study is registered once; it cannot change under the people who take part."""

from __future__ import annotations

from typing import Any

import pytest

from study.data import studies
from study.data.database import Database
from study.data.refusals import StudyConflictError
from study.data.studies import Study
from study.design.definition import StudyDefinition, parse_definition


def test_registering_twice_is_registering_once(
    db: Database, study: Study, definition: StudyDefinition
) -> None:
    assert studies.register(db, definition) == study
    assert studies.all_studies(db) == [study]
    assert studies.by_id(db, study.id).definition == definition


def test_a_file_may_change_until_somebody_takes_part(
    db: Database, study: Study, raw: dict[str, Any]
) -> None:
    changed = studies.register(db, parse_definition({**raw, "title": "A better title"}))
    assert changed.id == study.id
    assert studies.by_id(db, study.id).title == "A better title"
    assert studies.by_id(db, study.id).definition.title == "A better title"


@pytest.mark.usefixtures("walk")
def test_a_changed_file_needs_a_new_version_once_people_took_part(
    db: Database, raw: dict[str, Any]
) -> None:
    with pytest.raises(StudyConflictError) as caught:
        studies.register(db, parse_definition({**raw, "title": "A better title"}))
    assert str(caught.value) == (
        'study small, version "1": the file has changed, and 1 participants belong to the stored '
        "one; give the file a new version, or use another database"
    )
    newer = studies.register(db, parse_definition({**raw, "title": "Better", "version": "2"}))
    assert studies.latest(db) == studies.latest(db, "small") == newer
    assert studies.latest(db, "other") is None
    assert [each.version for each in studies.all_studies(db)] == ["1", "2"]


def test_an_unknown_study_is_named(db: Database) -> None:
    with pytest.raises(LookupError, match="no study 5 in this database"):
        studies.by_id(db, 5)
