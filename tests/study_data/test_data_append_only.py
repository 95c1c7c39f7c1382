"""The database itself keeps events as they were added, whoever asks it to do otherwise."""

from __future__ import annotations

from typing import Any

import pytest
from sqlalchemy import text
from sqlalchemy.exc import IntegrityError

from study.data import erasure
from study.data.database import Database

UNCHANGED = "events are added, never changed"
KEPT = "events are deleted only when their participant withdraws"


def count(db: Database, table: str) -> int:
    with db.reading() as session:
        return int(session.execute(text(f"SELECT count(*) FROM {table}")).scalar_one())


def run(db: Database, statement: str) -> None:
    with db.writing() as session:
        session.execute(text(statement))


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        ("UPDATE events SET payload = '{}'", UNCHANGED),
        ("UPDATE events SET created_at = created_at", UNCHANGED),
        ("DELETE FROM events", KEPT),
        ("DELETE FROM events WHERE kind = 'consented'", KEPT),
    ],
)
def test_events_cannot_be_changed_or_deleted(
    db: Database, walk: Any, statement: str, message: str
) -> None:
    walk.begin()
    before = count(db, "events")
    with pytest.raises(IntegrityError, match=message):
        run(db, statement)
    assert count(db, "events") == before > 0


@pytest.mark.parametrize("database_kind", ["postgresql"])
def test_postgresql_does_not_empty_the_table_either(db: Database, walk: Any) -> None:
    walk.begin()
    with pytest.raises(IntegrityError, match=KEPT):
        run(db, "TRUNCATE events CASCADE")
    assert count(db, "events") > 0


def test_who_withdraws_is_erased_and_others_stay(db: Database, walk: Any, enrol_walk: Any) -> None:
    walk.begin()
    other = enrol_walk(2)
    other.begin()
    theirs = count(db, f"events WHERE participant_id = {other.participant.id}")
    erasure.withdraw(db, walk.participant)
    assert count(db, f"events WHERE participant_id = {walk.participant.id}") == 0
    assert count(db, f"events WHERE participant_id = {other.participant.id}") == theirs > 0
    # The leave to delete ends with the withdrawal.
    assert count(db, "erasures") == 0
    with pytest.raises(IntegrityError, match=KEPT):
        run(db, "DELETE FROM events")
