"""Participants: known by token alone, kept alive by signs of life, a random pseudonym to us."""

from __future__ import annotations

from typing import Any

import numpy as np
from sqlalchemy import text

from study.data import enrolment, participants
from study.data.database import Database
from study.data.devices import read_device
from study.data.studies import Study


def test_a_token_leads_to_its_participant_and_to_nobody_else(db: Database, study: Study) -> None:
    first, second = (enrolment.enrol(db, study) for _ in range(2))
    assert participants.by_token(db, first.token) == first.participant
    assert participants.by_token(db, second.token) == second.participant
    assert participants.by_token(db, first.token[:-1]) is None
    assert participants.by_token(db, "") is None
    assert participants.by_public_id(db, study, first.participant.public_id) == first.participant
    assert participants.by_public_id(db, study, "p-nobody") is None


def test_the_database_holds_no_token(db: Database, study: Study) -> None:
    token = enrolment.enrol(db, study).token
    with db.reading() as session:
        stored = str(session.execute(text("SELECT * FROM participants")).all())
    assert len(token) >= 43
    assert token not in stored


def test_pseudonym_and_seed_can_be_repeated_but_not_the_token(db: Database, study: Study) -> None:
    first = enrolment.enrol(db, study, rng=np.random.default_rng(3))
    with db.writing() as session:
        session.execute(text("DELETE FROM sessions"))
        session.execute(text("DELETE FROM participants"))
    again = enrolment.enrol(db, study, rng=np.random.default_rng(3))
    assert again.participant.public_id == first.participant.public_id
    assert again.participant.seed == first.participant.seed
    assert again.token != first.token


def test_a_taken_pseudonym_is_not_given_twice(db: Database, study: Study) -> None:
    names = {
        enrolment.enrol(db, study, rng=np.random.default_rng(3)).participant.public_id
        for _ in range(3)
    }
    assert len(names) == 3


def test_coming_back_after_a_pause_opens_a_new_sitting(db: Database, walk: Any, clock: Any) -> None:
    def sittings() -> int:
        with db.reading() as session:
            return int(session.execute(text("SELECT count(*) FROM sessions")).scalar_one())

    clock.move(minutes=20)
    person = participants.seen(db, walk.participant)
    assert (person.last_seen_at, sittings()) == (clock.now, 1)
    clock.move(minutes=31)
    participants.seen(db, person)
    assert sittings() == 2


def test_signs_of_life_within_seconds_are_not_written(db: Database, walk: Any, clock: Any) -> None:
    clock.move(seconds=10)
    assert participants.seen(db, walk.participant) is walk.participant
    clock.move(seconds=6)
    assert participants.seen(db, walk.participant).last_seen_at == clock.now


def test_a_browser_may_say_anything_about_itself() -> None:
    given = {
        "screen_width": 1920.4,
        "screen_height": -1,
        "pixel_ratio": float("nan"),
        "user_agent_family": "Fire\x00fox\ud800" + "x" * 400,
        "hidden": True,
        "nested": {"a": 1},
        "nothing": None,
    }
    kept = read_device(given)
    assert kept.pop("user_agent_family").startswith("Firefox?xxx")
    assert kept == {"screen_width": 1920, "hidden": True}
    assert len(read_device({str(n): n for n in range(100)})) == 40
