"""Group commit on SQLite: writers share the wait for the disk, and each answers for its own."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

import pytest
from sqlalchemy import event, text
from sqlalchemy.exc import OperationalError

from study.data.commits import BETWEEN, LARGEST
from study.data.database import Database
from study.data.schema import StudyRow

pytestmark = pytest.mark.parametrize("database_kind", ["sqlite"])


def add(db: Database, key: str) -> None:
    with db.writing() as session:
        session.add(
            StudyRow(
                key=key,
                version="1",
                title="t",
                definition="{}",
                definition_hash="0",
                created_at=db.now(),
            )
        )


def keys(db: Database) -> set[str]:
    with db.reading() as session:
        return set(session.execute(text("SELECT key FROM studies")).scalars())


def commits(db: Database) -> list[int]:
    """Return a list that grows with every commit of a transaction that may write."""
    made: list[int] = []

    def note(connection: Any) -> None:
        if not connection.get_execution_options().get("is_reading"):
            made.append(1)

    event.listen(db.engine, "commit", note)
    return made


def at_once(db: Database, *jobs: Callable[[], None]) -> list[Future[None]]:
    """Run writers that all come while the first one writes."""
    assert db.group is not None
    running: list[Future[None]] = []
    with ThreadPoolExecutor(len(jobs)) as pool:
        with db.writing():
            running += [pool.submit(job) for job in jobs]
            everybody = threading.Event()
            while db.group.waiting < len(jobs):
                everybody.wait(0.001)
        return running


def test_those_who_wait_share_one_commit(db: Database) -> None:
    made = commits(db)
    done = at_once(db, *(lambda n=n: add(db, f"s{n}") for n in range(12)))
    assert [one.exception() for one in done] == [None] * 12
    assert keys(db) == {f"s{n}" for n in range(12)}
    assert len(made) == 1


def test_one_who_fails_takes_back_only_their_own(db: Database) -> None:
    def fail() -> None:
        with db.writing() as session:
            session.execute(text("INSERT INTO erasures VALUES (7)"))
            raise KeyError("mine")

    done = at_once(db, lambda: add(db, "a"), fail, lambda: add(db, "b"))
    assert isinstance(done[1].exception(), KeyError)
    assert done[0].exception() is done[2].exception() is None
    assert keys(db) == {"a", "b"}
    with db.reading() as session:
        assert session.execute(text("SELECT count(*) FROM erasures")).scalar_one() == 0


def test_when_the_disk_refuses_everybody_is_told(db: Database) -> None:
    def refuse(_connection: Any) -> None:
        raise OSError("the disk is full")

    event.listen(db.engine, "commit", refuse)
    told: list[BaseException | None] = []

    def write(key: str) -> None:
        try:
            add(db, key)
        except OperationalError as error:
            told.append(error)

    with pytest.raises(OperationalError, match="the disk is full"):
        at_once(db, lambda: write("a"), lambda: write("b"))
    assert len(told) == 2
    event.remove(db.engine, "commit", refuse)
    assert keys(db) == set()
    add(db, "later")
    assert keys(db) == {"later"}


def test_a_group_ends_before_it_grows_without_end(db: Database) -> None:
    made = commits(db)
    at_once(db, *(lambda n=n: add(db, f"s{n}") for n in range(LARGEST + 5)))
    assert len(keys(db)) == LARGEST + 5
    assert len(made) >= 2


def test_who_writes_for_many_waits_for_few_and_for_nobody_after_them(db: Database) -> None:
    order: list[str] = []
    made = commits(db)

    def one() -> None:
        with db.writing():
            order.append(f"one of {len(made)}")

    def many() -> None:
        with db.batch():
            order.append(f"many of {len(made)}")

    done = at_once(db, *[one] * 12, many)
    assert [each.exception() for each in done] == [None] * 13
    # The one who held the turn counts among those who came before.
    first = order.index("many of 0")
    assert first == BETWEEN - 1
    # The many were on the disk before anybody else wrote.
    assert set(order[first + 1 :]) == {"one of 1"}
