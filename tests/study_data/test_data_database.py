"""Opening a database: migrations, durability, transactions, clear refusals."""

from __future__ import annotations

import stat
import threading
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import text
from sqlalchemy.dialects import postgresql
from sqlalchemy.schema import CreateTable

from study.data.database import Database, DatabaseError, open_database
from study.data.schema import Base, StudyRow


def row(db: Database, key: str) -> StudyRow:
    return StudyRow(
        key=key, version="1", title="t", definition="{}", definition_hash="0", created_at=db.now()
    )


def count(db: Database) -> int:
    with db.reading() as session:
        return int(session.execute(text("SELECT count(*) FROM studies")).scalar_one())


def test_migrations_make_exactly_the_tables_of_the_schema(db: Database) -> None:
    with db.engine.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        assert compare_metadata(context, Base.metadata) == []
        assert context.get_current_revision() == "0001"


def test_opening_again_keeps_what_is_there(db: Database, tmp_path: Path) -> None:
    with db.writing() as session:
        session.add(row(db, "kept"))
    again = open_database(str(tmp_path / "study.sqlite3"))
    assert count(again) == 1
    again.close()


def test_sqlite_is_durable_and_checks_references(db: Database) -> None:
    with db.reading() as session:
        pragmas = {
            name: session.execute(text(f"PRAGMA {name}")).scalar_one()
            for name in ("journal_mode", "synchronous", "foreign_keys", "busy_timeout")
        }
    assert pragmas == {
        "journal_mode": "wal",
        "synchronous": 2,  # FULL
        "foreign_keys": 1,
        "busy_timeout": 30_000,
    }


def test_nobody_else_on_the_machine_can_read_the_answers(tmp_path: Path) -> None:
    database = open_database(f"sqlite:///{tmp_path}/deep/down/study.sqlite3")
    database.close()
    mode = (tmp_path / "deep" / "down" / "study.sqlite3").stat().st_mode
    assert stat.S_IMODE(mode) == 0o600


def test_a_failed_transaction_leaves_nothing_behind(db: Database) -> None:
    def fail() -> None:
        with db.writing() as session:
            session.add(row(db, "a"))
            session.flush()
            raise KeyError("broken")

    with pytest.raises(KeyError, match="broken"):
        fail()
    assert count(db) == 0


def test_inner_transactions_join_the_outer_one(db: Database) -> None:
    with db.writing() as outer:
        with db.writing() as inner:
            inner.add(row(db, "a"))
        assert inner is outer
        assert count(db) == 1
        outer.rollback()
    assert count(db) == 0


def test_a_reading_transaction_cannot_write(db: Database) -> None:
    with db.reading(), pytest.raises(RuntimeError, match="open it with writing"), db.writing():
        pass


def test_writers_in_many_threads_wait_for_each_other(db: Database) -> None:
    def add(number: int) -> None:
        for step in range(5):
            with db.writing() as session:
                before = session.execute(text("SELECT count(*) FROM studies")).scalar_one()
                session.add(row(db, f"{number}-{step}-{before}"))

    threads = [threading.Thread(target=add, args=(number,)) for number in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    with db.reading() as session:
        keys = session.execute(text("SELECT key FROM studies")).scalars().all()
    # Every writer saw all rows before its own: no two of them read the same number.
    assert sorted(int(key.rsplit("-", 1)[1]) for key in keys) == list(range(30))


def test_many_may_open_a_new_database_at_once(tmp_path: Path) -> None:
    opened: list[Database] = []
    gate = threading.Barrier(4)

    def open_it() -> None:
        gate.wait()
        opened.append(open_database(str(tmp_path / "new.sqlite3")))

    threads = [threading.Thread(target=open_it) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [count(database) for database in opened] == [0] * 4
    for database in opened:
        database.close()


@pytest.mark.parametrize(
    ("url", "message"),
    [
        ("sqlite://", "an SQLite database has to be a file: sqlite:///study.sqlite3"),
        ("nonsense://x y@:z", "not a database URL"),
        ("nonsense://host/name", "nonsense://host/name: not a database that can be used"),
    ],
)
def test_a_database_that_cannot_be_used_is_refused(url: str, message: str) -> None:
    with pytest.raises(DatabaseError, match=message):
        open_database(url)


def test_a_file_that_is_no_database_is_refused(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("These are only notes. " * 200)
    message = r"notes\.txt: cannot be opened \(file is not a database"
    with pytest.raises(DatabaseError, match=message):
        open_database(str(tmp_path / "notes.txt"))


def test_a_database_of_a_newer_version_is_left_alone(db: Database, tmp_path: Path) -> None:
    with db.writing() as session:
        session.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    with pytest.raises(DatabaseError, match="made by another version of Ocularist"):
        open_database(str(tmp_path / "study.sqlite3"))


def test_the_tables_can_be_made_on_postgresql() -> None:
    tables = [CreateTable(table) for table in Base.metadata.sorted_tables]
    made = "\n".join(str(table.compile(dialect=postgresql.dialect())) for table in tables)
    assert "created_at TIMESTAMP WITH TIME ZONE NOT NULL" in made
    assert made.count("CREATE TABLE") == 9
