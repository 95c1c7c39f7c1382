"""Errands and the writer: many in one transaction, each with its own end, none told too early."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable
from typing import Any

import pytest
from sqlalchemy import event, select

from study.data import answers, at_trial, batches, errands, events, progress, views
from study.data.database import Database
from study.data.errands import Errand, Make
from study.data.prepared import Prepared, table_of
from study.data.refusals import NotReachedError, WithdrawnError
from study.data.schema import EventRow, ParticipantRow, TrialRow
from study.data.senders import locking_again
from study.data.writer import Writer


@pytest.fixture
def people(enrol_walk: Callable[..., Any]) -> list[Any]:
    """Three people at their first trial."""
    found = [enrol_walk(seed) for seed in (1, 2, 3)]
    for one in found:
        one.begin()
    return found


def playing(walk: Any, key: str, position: int = 1) -> Make[bool]:
    def errand() -> Errand[bool]:
        who = yield from locking_again(walk.participant)
        stored, _ = yield from views.recording(
            walk.db, who, position, key=key, play=lambda _clip: walk.play
        )
        return stored.new

    return errand


def breaking(walk: Any, key: str) -> Make[bool]:
    """Write, and fail after that."""

    def errand() -> Errand[bool]:
        yield from playing(walk, key)()
        raise ZeroDivisionError("after writing")

    return errand


def keys(walk: Any) -> set[str]:
    with walk.db.reading() as session:
        query = select(EventRow.key).where(EventRow.participant_id == walk.participant.id)
        return set(session.scalars(query)) - {"consent", "about", "instructions", "begin"}


def together(db: Database, *makes: Make[Any]) -> list[errands.Outcome]:
    with db.batch() as connection:
        return batches.run(connection, makes)


def write_all(db: Database, *makes: Make[Any]) -> list[Any]:
    async def all_at_once() -> list[Any]:
        writer = Writer(db)
        try:
            found = [writer.write(make) for make in makes]
            return await asyncio.gather(*found, return_exceptions=True)
        finally:
            writer.close()

    return asyncio.run(all_at_once())


def test_one_who_fails_after_writing_takes_back_only_their_own(
    db: Database, people: list[Any]
) -> None:
    a, b, c = people
    found = together(db, playing(a, "a"), breaking(b, "b"), playing(c, "c"))
    assert isinstance(found[1].error, ZeroDivisionError)
    assert (found[0].get(), found[2].get()) == (True, True)
    assert [keys(one) for one in people] == [{"a"}, set(), {"c"}]


def test_what_the_database_refuses_takes_back_only_its_own(db: Database, people: list[Any]) -> None:
    a, b, c = people

    def twice() -> Errand[None]:
        who = yield from locking_again(b.participant)
        trial = yield from at_trial.reaching(who, 1, key="b")
        for _ in range(2):
            yield from at_trial.adding(who, trial, key="b", kind="played", payload={}, now=db.now())

    found = together(db, playing(a, "a"), twice, playing(c, "c"))
    assert re.search("(?i)unique", str(found[1].error))
    assert (found[0].get(), found[2].get()) == (True, True)
    assert [keys(one) for one in people] == [{"a"}, set(), {"c"}]


def test_one_alone_who_fails_leaves_nothing(db: Database, people: list[Any]) -> None:
    with pytest.raises(ZeroDivisionError, match="after writing"):
        db.run(breaking(people[0], "a"))
    assert keys(people[0]) == set()


def test_what_is_refused_before_writing_is_refused_alone(db: Database, people: list[Any]) -> None:
    a, b, _ = people
    found = together(db, playing(a, "a"), playing(b, "b", position=2), playing(b, "b1"))
    assert isinstance(found[1].error, NotReachedError)
    assert "trial 2 comes after the ones before it" in str(found[1].error)
    assert [keys(one) for one in people] == [{"a"}, {"b1"}, set()]


def test_a_key_twice_in_one_batch_is_one_event(db: Database, people: list[Any]) -> None:
    found = together(db, playing(people[0], "k"), playing(people[0], "k"))
    assert [one.get() for one in found] == [True, False]
    history = [one for one in events.history(db, people[0].participant) if one.kind == "played"]
    assert [one.payload for one in history] == [people[0].play]


def test_an_erased_ones_number_is_nobody(db: Database, people: list[Any]) -> None:
    a, b, _ = people
    a.participant = b.participant.__class__(**{**vars(a.participant), "id": b.participant.id})
    with pytest.raises(WithdrawnError, match="this participant has withdrawn"):
        db.run(playing(a, "k"))
    assert keys(b) == set()


def test_an_errand_inside_a_transaction_is_taken_back_with_it(
    db: Database, people: list[Any]
) -> None:
    def write() -> None:
        with db.writing():
            db.run(playing(people[0], "k"))
            raise KeyError

    with pytest.raises(KeyError):
        write()
    assert keys(people[0]) == set()


def test_where_somebody_stands_is_the_same_as_an_errand(db: Database, people: list[Any]) -> None:
    walk = people[0]
    while (step := progress.current_step(db, walk.participant)).trial is not None:

        def look() -> Errand[Any]:
            who = yield from locking_again(walk.participant)
            return (yield from progress.standing(who, walk.study.definition))

        stood, mine = db.look(look)
        assert stood == step
        assert [one.position for one in mine] == sorted(one.position for one in mine)
        walk.answer(step.trial.position, rating_left="2", rating_right="5", comparison="1")
    assert db.look(look)[0].name == "thanks"


@pytest.mark.parametrize("kind", [ParticipantRow, TrialRow, EventRow])
def test_prepared_rows_are_what_the_tables_classes_read(
    db: Database, people: list[Any], kind: Any
) -> None:
    people[0].answer(1, rating_left="2", rating_right="5", comparison="1")
    table = table_of(kind)
    statement = Prepared(select(*table.c).order_by(table.c.id))

    def look() -> Errand[Any]:
        return (yield statement, {})

    with db.reading() as session:
        rows = session.scalars(select(kind).order_by(kind.id)).all()
        expected = [{column.key: getattr(row, column.key) for column in table.c} for row in rows]
    assert [row._asdict() for row in db.look(look)] == expected


def test_many_who_come_at_once_share_transactions(db: Database, people: list[Any]) -> None:
    made: list[int] = []
    event.listen(db.engine, "commit", lambda _connection: made.append(1))
    told = write_all(db, *(playing(one, f"k{n}") for one in people for n in range(8)))
    assert told == [True] * 24
    assert [len(keys(one)) for one in people] == [8, 8, 8]
    assert len(made) <= 4  # with what has been read to look at the keys


def test_nobody_is_told_yes_when_the_disk_refuses(db: Database, people: list[Any]) -> None:
    def refuse(_connection: Any) -> None:
        raise OSError("the disk is full")

    event.listen(db.engine, "commit", refuse)
    told = write_all(db, *(playing(one, "k") for one in people))
    event.remove(db.engine, "commit", refuse)
    assert len(told) == 3
    assert all("the disk is full" in str(error) for error in told)
    assert [keys(one) for one in people] == [set(), set(), set()]
    assert write_all(db, playing(people[0], "later")) == [True]


def test_the_last_of_a_batch_completes_only_its_own(db: Database, people: list[Any]) -> None:
    a, b, _ = people
    given = {"rating_left": "2", "rating_right": "5", "comparison": "1"}
    last = 0
    while (step := progress.current_step(db, a.participant)).trial is not None:
        last = step.trial.position
        a.watch(last)
        if step.number == step.total and step.name == "trial":
            break
        answers.store(db, a.participant, last, given, key=f"f{last}", is_final=True)

    def finish() -> Errand[Any]:
        who = yield from locking_again(a.participant)
        return (
            yield from answers.storing(
                db, a.study.definition, who, last, given, key="last", is_final=True
            )
        )

    found = together(db, playing(b, "b"), finish)
    assert found[1].get().trial_complete
    assert progress.current_step(db, a.participant).name == "thanks"
    assert progress.current_step(db, b.participant).name == "practice"
