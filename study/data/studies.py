"""Studies in the database: a version of a definition, kept whole and never changed under people."""

from __future__ import annotations

import json
import math
import time
from dataclasses import dataclass, field, replace
from typing import Final

from sqlalchemy import ColumnElement, func, select
from sqlalchemy.orm import Session

from study.data.database import Database
from study.data.refusals import StudyConflictError
from study.data.schema import ParticipantRow, StudyRow
from study.design.definition import StudyDefinition, parse_definition

FRESH_S: Final = 1.0


@dataclass(frozen=True)
class Study:
    """One version of a study as the database has it.

    ``source`` is the definition in its own language where ``definition`` is a translation.
    """

    id: int
    key: str
    version: str
    title: str
    definition: StudyDefinition
    source: StudyDefinition | None = None
    _spoken: dict[str, Study] = field(default_factory=dict, compare=False, repr=False)

    @property
    def languages(self) -> tuple[str, ...]:
        """The languages that the study's words are written in, its own first."""
        return (self.source or self.definition).languages

    def spoken(self, language: str) -> Study:
        """Return the study with the words of one of its languages; of its own for any other."""
        if language not in self._spoken:
            source = self.source or self.definition
            definition = source.in_language(language)
            self._spoken[language] = replace(
                self, title=definition.title, definition=definition, source=source
            )
        return self._spoken[language]


def register(db: Database, definition: StudyDefinition) -> Study:
    """Put a definition into the database, or find it there.

    A definition that changed under the same version replaces the old one only while nobody takes
    part; after that it raises StudyConflictError, because people agreed to and saw the old one.
    """
    with db.writing() as session:
        row = session.scalar(
            select(StudyRow)
            .where(StudyRow.key == definition.key, StudyRow.version == definition.version)
            .with_for_update()
        )
        if row is None:
            row = StudyRow(
                key=definition.key,
                version=definition.version,
                created_at=db.now(),
                **_columns(definition),
            )
            session.add(row)
        elif row.definition_hash != definition.definition_hash:
            _check_unused(session, row)
            for name, value in _columns(definition).items():
                setattr(row, name, value)
        session.flush()
        db.recent.pop(row.id, None)
        return study_of(db, row)


def _columns(definition: StudyDefinition) -> dict[str, str]:
    return {
        "title": definition.title,
        "definition": definition.to_json(),
        "definition_hash": definition.definition_hash,
    }


def _check_unused(session: Session, row: StudyRow) -> None:
    people = session.scalar(
        select(func.count()).select_from(ParticipantRow).where(ParticipantRow.study_id == row.id)
    )
    if people:
        raise StudyConflictError(
            f'study {row.key}, version "{row.version}": the file has changed, and {people} '
            "participants belong to the stored one; give the file a new version, or use another "
            "database"
        )


def latest(db: Database, key: str | None = None) -> Study | None:
    """Return the study that was registered last, of all or of one key."""
    query = select(StudyRow).order_by(StudyRow.id.desc()).limit(1)
    with db.reading() as session:
        row = session.scalar(query if key is None else query.where(StudyRow.key == key))
        return None if row is None else study_of(db, row)


def all_studies(db: Database) -> list[Study]:
    """Return every study and version, oldest first."""
    with db.reading() as session:
        return [
            study_of(db, row) for row in session.scalars(select(StudyRow).order_by(StudyRow.id))
        ]


def by_id(db: Database, study_id: int) -> Study:
    """Return one study, as of at most FRESH_S ago; raises LookupError when there is none.

    Every page asks for it several times, and it stays the same from its first participant on.
    """
    read_at, known = db.recent.get(study_id, (-math.inf, None))
    if known is not None and time.monotonic() - read_at < FRESH_S:
        found: Study = known
        return found
    with db.reading() as session:
        row = session.get(StudyRow, study_id)
        if row is None:
            raise LookupError(f"no study {study_id} in this database")
        found = study_of(db, row)
    db.recent[study_id] = (time.monotonic(), found)
    return found


def gate(session: Session, *which: ColumnElement[bool]) -> None:
    """Let one transaction after the other pass that changes who takes part in these studies.

    Those who only refer to them go on: whoever holds a participant's row and waited here would wait
    for ever for somebody who has passed and waits for that row (PostgreSQL, FOR NO KEY UPDATE).
    """
    rows = select(StudyRow.id).where(*which).order_by(StudyRow.id)
    session.scalars(rows.with_for_update(key_share=True)).all()


def study_of(db: Database, row: StudyRow) -> Study:
    """Read a row's definition; it is kept in memory, as every page asks for it."""
    cached = db.cache.get(row.id)
    if cached is None or cached[0] != row.definition_hash:
        source = f"study {row.key} in the database"
        definition = parse_definition(json.loads(row.definition), source=source)
        cached = (row.definition_hash, definition)
        db.cache[row.id] = cached
    return Study(row.id, row.key, row.version, row.title, cached[1])
