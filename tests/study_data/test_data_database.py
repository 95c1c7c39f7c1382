"""Opening a database: migrations, durability, transactions, clear refusals."""

from __future__ import annotations

import stat
import threading
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import text

from study.data import database as database_module
from study.data.database import Database, DatabaseError, open_database
from study.data.schema import Base, StudyRow

VERSIONS = Path(database_module.__file__).parent / "migrations" / "versions"
ON_SQLITE = pytest.mark.parametrize("database_kind", ["sqlite"])
ON_POSTGRESQL = pytest.mark.parametrize("database_kind", ["postgresql"])


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
        assert context.get_current_revision() == max(
            path.name[:4] for path in VERSIONS.glob("[0-9]*.py")
        )


def test_opening_again_keeps_what_is_there(db: Database, database_url: str) -> None:
    with db.writing() as session:
        session.add(row(db, "kept"))
    again = open_database(database_url)
    assert count(again) == 1
    again.close()


@ON_SQLITE
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


@ON_POSTGRESQL
def test_postgresql_waits_for_the_disk_whatever_its_default_says(db: Database) -> None:
    # The tests' server has synchronous_commit off: it is the connection that asks for it.
    with db.writing() as session:
        assert session.execute(text("SHOW synchronous_commit")).scalar_one() == "on"


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


@ON_SQLITE
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


def test_a_database_of_a_newer_version_is_left_alone(db: Database, database_url: str) -> None:
    with db.writing() as session:
        session.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    with pytest.raises(DatabaseError, match="made by another version of Ocularist"):
        open_database(database_url)


def test_a_plain_postgresql_address_uses_the_driver_that_is_installed(
    db: Database, database_url: str
) -> None:
    with db.writing() as session:
        session.add(row(db, "kept"))
    again = open_database(database_url.replace("postgresql+psycopg://", "postgresql://"))
    assert count(again) == 1
    again.close()


@ON_POSTGRESQL
def test_a_server_that_does_not_answer_is_named_without_its_password(database_url: str) -> None:
    del database_url
    with pytest.raises(
        DatabaseError, match=r"postgresql.*\*\*\*@127\.0\.0\.1:9/x: cannot be opened"
    ):
        open_database("postgresql://me:secret@127.0.0.1:9/x")
