"""Outcomes and their codes: given once everything is stored, and as the study file says."""

from __future__ import annotations

from typing import Any

import pytest
from sqlalchemy import update

from study.data import completion, dashboard, enrolment, participants, studies
from study.data.database import Database
from study.data.refusals import NotReachedError
from study.data.schema import TrialRow
from study.data.studies import Study
from study.design.definition import parse_definition


def now_of(db: Database, walk: Any) -> participants.Participant:
    found = participants.by_token(db, walk.token)
    assert found is not None
    return found


def test_a_code_of_ones_own_comes_with_the_last_answer_and_names_its_owner(
    db: Database, walk: Any
) -> None:
    walk.begin()
    walk.answer(1)
    walk.answer(2)
    assert completion.code(db, walk.participant) is None
    walk.finish()
    code = completion.code(db, walk.participant)
    assert code is not None
    assert len(code) == 9
    assert participants.by_code(db, code) == now_of(db, walk)
    assert now_of(db, walk).outcome == "completed"


def test_no_code_while_a_row_that_it_stands_for_is_missing(db: Database, walk: Any) -> None:
    walk.begin()
    with db.writing() as session:  # as if the stamp of a trial had outlived its answers
        session.execute(
            update(TrialRow).where(TrialRow.position == 1).values(completed_at=db.now())
        )
    walk.answer(2)
    walk.finish()
    assert completion.code(db, walk.participant) is None
    assert now_of(db, walk).outcome is None


def test_a_code_for_all_is_no_ones_own(db: Database, raw: dict[str, Any], enrol_walk: Any) -> None:
    assert enrol_walk
    raw |= {"key": "coded", "completion": {"completed": {"code": "C1DONE"}}}
    study = studies.register(db, parse_definition(raw))
    both = [type(enrol_walk(n))(db, study, *_enrolled(db, study)) for n in (8, 9)]
    for one in both:
        one.begin()
        one.finish()
        assert completion.code(db, one.participant) == "C1DONE"
    assert participants.by_code(db, "C1DONE") is None


def _enrolled(db: Database, study: Study) -> tuple[participants.Participant, str]:
    new = enrolment.enrol(db, study)
    return new.participant, new.token


def test_nobody_is_screened_out_in_the_middle(db: Database, study: Study, walk: Any) -> None:
    walk.begin()
    with pytest.raises(NotReachedError, match="after the trials have begun"):
        completion.screen_out(db, walk.participant, reason="screen")
    assert dashboard.summary(db, study).real.outcomes["screened_out"] == 0


def test_who_is_screened_out_is_counted_and_frees_their_place(
    db: Database, study: Study, walk: Any, enrol_walk: Any
) -> None:
    walk.to_preparing()
    completion.screen_out(db, walk.participant, reason="screen")
    enrol_walk(2)
    found = dashboard.summary(db, study)
    assert found.real.outcomes == {"completed": 0, "screened_out": 1, "failed_checks": 0}
    assert (found.real.here, found.real.steps["screened_out"]) == (1, 1)
    assert completion.code(db, walk.participant) is None
