"""Where a participant is: reload, back, double click and coming back change nothing."""

from __future__ import annotations

from typing import Any

import pytest

from study.data import (
    arms,
    completion,
    consents,
    enrolment,
    events,
    participants,
    progress,
    steps,
    studies,
    trials,
)
from study.data.database import Database
from study.data.refusals import NotReachedError
from study.data.studies import Study
from study.design.arms import all_arms
from study.design.definition import parse_definition
from study.design.questions import AnswerError
from study.design.schedule import schedule
from study.texts import catalogue

ENGLISH = catalogue("en").text


def step(walk: Any) -> str:
    return str(progress.current_step(walk.db, walk.participant).name)


def test_the_steps_come_in_order(walk: Any) -> None:
    seen = [step(walk)]
    walk.consent()
    seen.append(step(walk))
    walk.about(age="33")
    seen.append(step(walk))
    steps.finish_instructions(walk.db, walk.participant, key="instructions")
    seen.append(step(walk))
    walk.begin()
    while seen[-1] != "thanks":
        seen.append(step(walk))
        now = progress.current_step(walk.db, walk.participant)
        if now.trial is not None:
            walk.answer(now.trial.position)
    assert seen == [
        *("consent", "about", "instructions", "preparing"),
        *("practice", "trial", "trial", "trial", "thanks"),
    ]


def test_trials_are_counted_apart_from_practice(walk: Any) -> None:
    walk.begin()
    counted = []
    while (now := progress.current_step(walk.db, walk.participant)).trial is not None:
        counted.append((now.name, now.number, now.total))
        walk.answer(now.trial.position)
    assert counted == [("practice", 1, 1), ("trial", 1, 3), ("trial", 2, 3), ("trial", 3, 3)]


def test_trials_follow_from_seed_and_arm(walk: Any) -> None:
    walk.begin()
    definition = walk.study.definition
    mine = trials.all_trials(walk.db, walk.participant)
    assert [(t.position, t.clip) for t in mine] == [
        (t.position, t.clip.id) for t in schedule(definition, walk.participant.seed)
    ]
    assert tuple(t.clip_id for t in mine) == trials.clip_ids(walk.db, walk.participant)
    specs = {
        w.spec.clip_id: w
        for w in definition.wanted_specs()
        if (str(w.size), w.orbit_direction)
        == (walk.participant.size, walk.participant.orbit_direction)
    }
    assert [specs[t.clip_id].clip.id for t in mine] == [t.clip for t in mine]


def test_coming_back_by_token_resumes(db: Database, walk: Any, clock: Any) -> None:
    walk.begin()
    walk.answer(1)
    clock.move(days=3)
    again = participants.by_token(db, walk.token)
    assert again is not None
    now = progress.current_step(db, again)
    assert now.trial is not None
    assert (now.name, now.trial.position) == ("trial", 2)


def test_a_step_sent_twice_is_one_step(walk: Any) -> None:
    walk.begin()
    before = events.history(walk.db, walk.participant)
    repeated = [
        consents.give_consent(walk.db, walk.participant, key="consent"),
        steps.store_about(walk.db, walk.participant, {"age": "44"}, key="about"),
        steps.finish_instructions(walk.db, walk.participant, key="instructions"),
        steps.begin(walk.db, walk.participant, key="begin"),
    ]
    assert [recorded.new for recorded in repeated] == [False] * 4
    assert events.history(walk.db, walk.participant) == before
    assert len(trials.all_trials(walk.db, walk.participant)) == 4


def test_beginning_twice_with_different_keys_lays_out_trials_once(walk: Any) -> None:
    walk.begin()
    walk.answer(1)
    mine = trials.all_trials(walk.db, walk.participant)
    steps.begin(walk.db, walk.participant, key="begin-again")
    assert trials.all_trials(walk.db, walk.participant) == mine


def test_going_back_to_an_early_page_leads_to_the_present_one(walk: Any) -> None:
    walk.begin()
    walk.answer(1)
    consents.give_consent(walk.db, walk.participant, key="consent-2")
    steps.finish_instructions(walk.db, walk.participant, key="instructions-2")
    assert step(walk) == "trial"


def test_consent_is_stored_with_its_version_and_time(walk: Any, clock: Any) -> None:
    when = clock.now
    payload = {"statements": 2, "consent_version": "forged"}
    consents.give_consent(walk.db, walk.participant, key="c", payload=payload)
    (event,) = events.history(walk.db, walk.participant)
    assert (event.kind, event.created_at) == ("consented", when)
    assert event.payload == {"statements": 2, "consent_version": "3"}


def test_faulty_answers_about_oneself_are_not_stored(walk: Any) -> None:
    walk.consent()
    with pytest.raises(AnswerError) as caught:
        walk.about(age="7", gender="woman")
    assert caught.value.said(ENGLISH) == {"age": "Please enter a whole number from 18 to 99."}
    assert step(walk) == "about"


def test_steps_cannot_be_jumped_over(walk: Any) -> None:
    with pytest.raises(NotReachedError, match="come after the consent"):
        walk.about()
    with pytest.raises(NotReachedError, match="instructions come after"):
        steps.finish_instructions(walk.db, walk.participant, key="i")
    with pytest.raises(NotReachedError, match="clips come after the instructions"):
        steps.begin(walk.db, walk.participant, key="b")
    walk.to_preparing()
    with pytest.raises(NotReachedError, match="once they are ready"):
        steps.begin(walk.db, walk.participant, key="b")
    assert step(walk) == "preparing"


def test_a_study_without_questions_about_you_goes_on_to_the_instructions(
    db: Database, raw: dict[str, Any]
) -> None:
    other = studies.register(db, parse_definition({**raw, "key": "other", "about": []}))
    person = enrolment.enrol(db, other).participant
    consents.give_consent(db, person, key="c")
    assert progress.current_step(db, person).name == "instructions"
    steps.finish_instructions(db, person, key="i")
    leased = arms.assign(db, person, available=all_arms(other.definition))
    assert leased is not None
    assert steps.begin(db, leased, key="b").new


def test_a_code_is_issued_when_every_trial_is_complete_and_not_before(
    walk: Any, study: Study
) -> None:
    assert study.definition.practice
    walk.begin()
    codes = []
    for position in range(1, 5):
        codes.append(completion.code(walk.db, walk.participant))
        walk.answer(position)
    code = completion.code(walk.db, walk.participant)
    assert codes == [None] * 4
    assert code is not None
    assert len(code) == 9
    assert completion.code(walk.db, walk.participant) == code


def test_codes_differ(enrol_walk: Any) -> None:
    codes = set()
    for seed in range(5):
        walk = enrol_walk(seed)
        walk.begin()
        walk.finish()
        codes.add(completion.code(walk.db, walk.participant))
    assert len(codes) == 5
    assert None not in codes
