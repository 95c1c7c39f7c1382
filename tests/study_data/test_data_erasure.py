"""Withdrawing: nothing of the person is left, in no table, no export and no byte of the file."""

from __future__ import annotations

from collections.abc import Callable
from datetime import date
from pathlib import Path
from typing import Any

import pytest
from alembic import command
from alembic.config import Config
from sqlalchemy import make_url, text

from study import data
from study.data import answers, consents, erasure, events, export, links, participants, progress
from study.data.database import Database, open_database
from study.data.engines import make_engine
from study.data.entrance import enter
from study.data.refusals import LinkUsedError, WithdrawnError
from study.data.studies import Study

WORDS = "the-left-one-looked-like-my-late-uncle"


def stored(db: Database) -> dict[str, list[Any]]:
    tables = ("participants", "sessions", "trials", "events", "links", "withdrawals")
    with db.reading() as session:
        return {
            table: [dict(row) for row in session.execute(text(f"SELECT * FROM {table}")).mappings()]
            for table in tables
        }


def test_only_the_day_and_the_step_of_a_withdrawal_stay(
    db: Database, study: Study, walk: Any, clock: Any
) -> None:
    walk.begin()
    walk.answer(1, comments=WORDS, rating_left="1")
    clock.move(minutes=1)
    erasure.withdraw(db, walk.participant)
    erasure.withdraw(db, walk.participant)
    left = stored(db)
    [withdrawal] = left.pop("withdrawals")
    assert not any(left.values())
    assert set(withdrawal) == {"id", "study_id", "simulated", "withdrawn_on", "step"}
    assert erasure.withdrawals(db, study) == [
        erasure.Withdrawal(date(2026, 11, 22), "trial", simulated=False)
    ]
    assert participants.by_token(db, walk.token) is None
    assert progress.current_step(db, walk.participant).name == "withdrawn"


def test_no_byte_of_the_file_keeps_the_words_of_who_withdrew(
    db: Database, walk: Any, enrol_walk: Any, tmp_path: Path
) -> None:
    other = enrol_walk(2)
    for one, words in ((walk, WORDS), (other, "the-words-of-who-stays")):
        one.begin()
        one.answer(1, comments=words)
        for number in range(40):  # enough for pages of their own, some of them split in between
            payload = {"code": f"{words} {number} " + "x" * 900}
            events.record(db, one.participant, key=f"k{number}", kind="problem", payload=payload)
    if db.engine.dialect.name == "sqlite":
        assert in_files(tmp_path, WORDS)
    name = walk.participant.public_id
    erasure.withdraw(db, walk.participant)
    assert WORDS not in str(stored(db))
    assert name not in str(stored(db))
    if db.engine.dialect.name == "sqlite":
        assert not in_files(tmp_path, WORDS)
        assert not in_files(tmp_path, name)
        assert in_files(tmp_path, "the-words-of-who-stays")


def in_files(folder: Path, words: str) -> bool:
    """Say whether the database's file or its log holds these words, as bytes."""
    files = [path for path in folder.glob("study.sqlite3*") if path.is_file()]
    assert files
    return any(words.encode() in path.read_bytes() for path in files)


def test_no_export_shows_who_withdrew(
    db: Database, study: Study, walk: Any, tmp_path: Path
) -> None:
    walk.begin()
    walk.answer(1, comments=WORDS)
    erasure.withdraw(db, walk.participant)
    for path in export.write(db, study, tmp_path / "out"):
        written = path.read_text(encoding="utf-8")
        assert WORDS not in written
        assert walk.participant.public_id not in written


def test_nothing_is_stored_about_somebody_who_withdrew(db: Database, walk: Any) -> None:
    walk.begin()
    erasure.withdraw(db, walk.participant)
    attempts: list[Callable[[], object]] = [
        lambda: events.record(db, walk.participant, key="x", kind="problem"),
        lambda: answers.store(db, walk.participant, 1, {}, key="x"),
        lambda: consents.give_consent(db, walk.participant, key="x"),
        lambda: participants.seen(db, walk.participant, device={}),
    ]
    for attempt in attempts:
        with pytest.raises(WithdrawnError, match="nothing more is stored"):
            attempt()


def test_what_comes_late_goes_to_nobody_who_came_after(
    db: Database, walk: Any, enrol_walk: Any
) -> None:
    walk.begin()
    erasure.withdraw(db, walk.participant)
    after = enrol_walk(2)  # SQLite gives the number of an erased row anew
    with pytest.raises(WithdrawnError):
        events.record(db, walk.participant, key="late", kind="problem", payload={"code": WORDS})
    assert progress.current_step(db, walk.participant).name == "withdrawn"
    assert events.history(db, after.participant) == []


def test_a_personal_link_is_spent_even_if_its_person_withdrew(db: Database, study: Study) -> None:
    [link] = links.make(db, study, 1)
    arrived = enter(db, study, link=link.token, arrival={"PROLIFIC_PID": WORDS}, person_key="k")
    erasure.withdraw(db, arrived.participant)
    found = links.find(db, link.token)
    assert found is not None
    assert (found.is_used, found.participant) == (True, None)
    with pytest.raises(LinkUsedError, match="lets nobody in any more"):
        enter(db, study, link=link.token)
    assert enter(db, study, person_key="k").token is not None  # known no more


def test_consent_to_health_data_goes_too(db: Database, walk: Any) -> None:
    consents.give_consent(db, walk.participant, key="consent", payload={"health": True})
    assert consents.allows_health(db, walk.participant)
    erasure.withdraw(db, walk.participant)
    assert not consents.allows_health(db, walk.participant)


def test_old_tombstones_become_withdrawals_without_a_person(tmp_path: Path) -> None:
    path = tmp_path / "old.sqlite3"
    make_old_tables(path)
    again = open_database(str(path))
    left = stored(again)
    again.close()
    assert [row["public_id"] for row in left["participants"]] == ["p-stays"]
    assert left["participants"][0]["outcome"] == "completed"
    assert [(row["withdrawn_on"], row["step"]) for row in left["withdrawals"]] == [
        ("2026-01-02", "")
    ]


MOMENT = "2026-01-02 03:04:05.000000"
COLUMNS = (
    "study_id, public_id, token_hash, simulated, language, seed, recruited_by, created_at, "
    "last_seen_at, completed_at, withdrawn_at"
)


def make_old_tables(path: Path) -> None:
    """Make the tables as they were before, with one who completed and one who withdrew."""
    engine = make_engine(make_url(f"sqlite:///{path}"))
    with engine.begin() as connection:
        config = Config()
        config.set_main_option("script_location", str(Path(data.__file__).parent / "migrations"))
        config.attributes["connection"] = connection
        command.upgrade(config, "0001")
        connection.execute(
            text(f"INSERT INTO studies VALUES (1, 'k', '1', 't', '{{}}', '0', '{MOMENT}')")
        )
        for name, completed, withdrawn in (("p-stays", MOMENT, None), ("p-gone", None, MOMENT)):
            connection.execute(
                text(
                    f"INSERT INTO participants ({COLUMNS}) VALUES (1, :name, :name, 0, 'en', 1, "
                    "'link', :now, :now, :completed, :withdrawn)"
                ),
                {"name": name, "now": MOMENT, "completed": completed, "withdrawn": withdrawn},
            )
    engine.dispose()
