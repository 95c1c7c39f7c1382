"""Ending early: nobody is at work any more and the place is free, until they come back."""

from __future__ import annotations

from typing import Any

from study.data import arms, dashboard, events, participants, stopping
from study.data.database import Database
from study.data.studies import Study


def test_who_ended_early_is_not_at_work_and_frees_the_place(
    db: Database, study: Study, walk: Any, clock: Any
) -> None:
    walk.begin()
    clock.move(minutes=1)
    stopping.stop(db, walk.participant, key="stop")
    found = dashboard.summary(db, study)
    [person] = found.people
    assert (person.is_here, person.ended_early) == (False, True)
    assert (found.real.here, found.real.ended_early, found.real.withdrawn) == (0, 1, 0)
    assert sum(arms.counts(db, study).values()) == 0
    assert events.history(db, walk.participant)[-1].kind == stopping.STOPPED


def test_who_comes_back_by_the_link_is_at_work_again(
    db: Database, study: Study, walk: Any, clock: Any
) -> None:
    walk.begin()
    stopping.stop(db, walk.participant, key="stop")
    clock.move(minutes=1)
    participants.seen(db, walk.participant)
    found = dashboard.summary(db, study)
    assert (found.real.here, found.real.ended_early) == (1, 0)
    assert sum(arms.counts(db, study).values()) == 1
    walk.finish()
    stopping.stop(db, walk.participant, key="again")  # after the last clip there is no early end
    found = dashboard.summary(db, study)
    assert (found.real.completed, found.real.ended_early) == (1, 0)


def test_ending_before_the_clips_needs_no_place(db: Database, study: Study, walk: Any) -> None:
    stopping.stop(db, walk.participant, key="stop")
    stopping.stop(db, walk.participant, key="stop")
    assert dashboard.summary(db, study).real.here == 0
    assert [event.kind for event in events.history(db, walk.participant)] == ["stopped"]
