"""On PostgreSQL many write at once: none of them waits for somebody who waits for them."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta
from typing import Any

import pytest
from sqlalchemy import func, select, text
from sqlalchemy.orm import Session

from study.data import entrance, erasure, errands, limits, links, studies
from study.data.database import Database
from study.data.limits import Limit
from study.data.schema import LimitRow, ParticipantRow, StudyRow
from study.data.studies import Study

pytestmark = pytest.mark.parametrize("database_kind", ["postgresql"])


def test_who_is_counted_forgets_nobody_who_is_being_counted(db: Database, clock: Any) -> None:
    limit = Limit("joining", 1, timedelta(minutes=10))
    for who in ("a", "b", "c"):
        limits.count(db, limit, who)
    clock.move(minutes=10)
    others = select(LimitRow.who).order_by(LimitRow.who)
    with Session(db.engine) as other, other.begin():
        other.execute(others.where(LimitRow.who == "b").with_for_update())
        limits.count(db, limit, "a")
    with db.reading() as session:
        assert session.scalars(others).all() == ["a", "b"]


def test_who_withdraws_passes_whoever_is_at_the_gate_of_the_study(
    db: Database, study: Study, walk: Any
) -> None:
    with Session(db.engine) as other, other.begin():
        studies.gate(other, StudyRow.id == study.id)
        erasure.withdraw(db, walk.participant)
    assert len(erasure.withdrawals(db, study)) == 1


def test_one_after_the_other_passes_the_gate(db: Database, study: Study) -> None:
    query = select(StudyRow.id).with_for_update(key_share=True, skip_locked=True)
    with Session(db.engine) as one, Session(db.engine) as other, one.begin(), other.begin():
        studies.gate(one, StudyRow.id == study.id)
        assert other.scalars(query).all() == []


def test_who_withdraws_takes_their_link_before_their_name(db: Database, study: Study) -> None:
    [link] = links.make(db, study, 1)
    person = entrance.enter(db, study, link=link.token).participant
    waiting = text("SELECT count(*) FROM pg_stat_activity WHERE wait_event_type = 'Lock'")
    mine = select(ParticipantRow.id).where(ParticipantRow.id == person.id)
    with ThreadPoolExecutor(1) as beside, Session(db.engine) as other, other.begin():
        errands.look(other.connection(), lambda: entrance._unused_or_mine(link.token))
        withdrawal = beside.submit(erasure.withdraw, db, person)
        while not other.scalar(waiting):
            other.execute(select(func.pg_stat_clear_snapshot()))
        assert other.scalar(mine.with_for_update(nowait=True)) == person.id
        other.rollback()
        withdrawal.result()
    assert len(erasure.withdrawals(db, study)) == 1
