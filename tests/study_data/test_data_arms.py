"""Arms: the largest clips that fit and are ready, balanced by leases that run out."""

from __future__ import annotations

from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

from study.data import arms, jobs, participants, progress, steps, studies, trials
from study.data.database import Database
from study.data.readiness import readiness
from study.data.studies import Study
from study.design.arms import Arm, all_arms
from study.design.definition import StudyDefinition, WantedClip, parse_definition
from study.design.schedule import schedule

SMALL, LARGE = "320x180", "640x360"


@pytest.fixture
def wanted(db: Database, study: Study) -> list[WantedClip]:
    clips = study.definition.wanted_specs()
    jobs.enqueue(db, clips)
    return clips


def render(db: Database, number: int) -> None:
    for _ in range(number):
        job = jobs.claim(db, worker="w")
        assert job is not None
        jobs.finish(db, job, worker="w", record={})


def test_nobody_starts_before_the_clips_of_one_arm_are_there(
    db: Database, walk: Any, wanted: list[WantedClip]
) -> None:
    assert len(wanted) == 16
    walk.to_preparing()
    before = readiness(db, walk.participant, screen=(1920, 1080))
    assert (before.fits, before.is_ready, before.progress, before.clips_left) == (True, False, 0, 4)
    assert before.clips == {one.spec.clip_id for one in wanted[:4]}
    assert arms.assign(db, walk.participant) is None
    render(db, 3)
    assert readiness(db, walk.participant, screen=None).clips_left == 1
    assert arms.assign(db, walk.participant) is None
    render(db, 1)
    assert readiness(db, walk.participant, screen=None).is_ready
    leased = arms.assign(db, walk.participant)
    assert leased is not None
    assert (leased.size, leased.orbit_direction) == (SMALL, "rightward")


def test_a_clip_under_way_moves_the_progress_but_is_not_ready(
    db: Database, walk: Any, wanted: list[WantedClip]
) -> None:
    assert wanted
    job = jobs.claim(db, worker="w")
    assert job is not None
    jobs.report(db, job, worker="w", progress=1.0)
    found = readiness(db, walk.participant, screen=None)
    assert found.progress == pytest.approx(0.99 / 4)
    assert found.clips_left == 4


def test_waiting_for_a_clip_that_was_given_up_is_said_to_be_in_vain(
    db: Database, walk: Any, wanted: list[WantedClip]
) -> None:
    def give_up_next() -> None:
        for _ in range(jobs.MAX_ATTEMPTS):
            job = jobs.claim(db, worker="w")
            assert job is not None
            jobs.fail(db, job, worker="w", error="no")

    small, everything = (400, 400), (1920, 1080)
    give_up_next()
    assert not readiness(db, walk.participant, screen=small).is_stuck
    render(db, 3)
    give_up_next()
    assert readiness(db, walk.participant, screen=small).is_stuck
    assert not readiness(db, walk.participant, screen=everything).is_stuck
    render(db, len(wanted) - 5)
    assert readiness(db, walk.participant, screen=everything).is_ready


def test_the_largest_size_that_fits_and_is_ready_is_taken(
    db: Database, enrol_walk: Any, wanted: list[WantedClip]
) -> None:
    render(db, 8)
    first = arms.assign(db, enrol_walk(1).participant, screen=(1920, 1080))
    render(db, len(wanted) - 8)
    second = arms.assign(db, enrol_walk(2).participant, screen=(1920, 1080))
    third = arms.assign(db, enrol_walk(3).participant, screen=(639, 1080))
    assert [each and each.size for each in (first, second, third)] == [SMALL, LARGE, SMALL]


def test_a_screen_that_is_too_small_fits_nothing(
    db: Database, walk: Any, wanted: list[WantedClip]
) -> None:
    render(db, len(wanted))
    assert not readiness(db, walk.participant, screen=(319, 1000)).fits
    assert arms.assign(db, walk.participant, screen=(319, 1000)) is None


def test_asking_again_keeps_the_arm(db: Database, walk: Any, wanted: list[WantedClip]) -> None:
    render(db, len(wanted))
    first = arms.assign(db, walk.participant, screen=(1920, 1080))
    assert first is not None
    again = arms.assign(db, first, screen=(1920, 1080))
    assert again is not None
    assert (again.size, again.orbit_direction) == (first.size, first.orbit_direction)


def test_before_the_first_trial_a_smaller_screen_gets_a_smaller_clip(
    db: Database, walk: Any, wanted: list[WantedClip]
) -> None:
    render(db, len(wanted))
    walk.to_preparing()
    first = arms.assign(db, walk.participant, screen=(1920, 1080))
    smaller = arms.assign(db, walk.participant, screen=(400, 400))
    assert first is not None
    assert smaller is not None
    assert (first.size, smaller.size) == (LARGE, SMALL)
    steps.begin(db, smaller, key="begin")
    later = arms.assign(db, smaller, screen=(1920, 1080))
    assert later is not None
    assert later.size == SMALL


def test_directions_are_balanced_over_people_who_come_one_by_one(
    db: Database, study: Study, enrol_walk: Any
) -> None:
    for seed in range(7):
        enrol_walk(seed).begin()
        counts = arms.counts(db, study)
        taken = [counts[Arm(LARGE, direction)] for direction in ("leftward", "rightward")]
        assert sum(taken) == seed + 1
        assert max(taken) - min(taken) <= 1


def test_directions_stay_balanced_when_many_come_at_once(
    db: Database, study: Study, enrol_walk: Any
) -> None:
    walks = [enrol_walk(seed) for seed in range(12)]
    with ThreadPoolExecutor(6) as pool:
        list(pool.map(lambda walk: walk.begin(), walks))
    counts = arms.counts(db, study)
    assert [counts[Arm(LARGE, direction)] for direction in ("leftward", "rightward")] == [6, 6]


def test_an_expired_lease_no_longer_counts_but_its_participant_may_go_on(
    db: Database, study: Study, enrol_walk: Any, clock: Any
) -> None:
    gone = enrol_walk(1)
    gone.begin()
    assert sum(arms.counts(db, study).values()) == 1
    clock.move(minutes=29)
    assert sum(arms.counts(db, study).values()) == 1
    clock.move(minutes=2)
    assert sum(arms.counts(db, study).values()) == 0
    second = enrol_walk(2)
    second.begin()
    participants.seen(db, gone.participant)
    assert sum(arms.counts(db, study).values()) == 2
    gone.finish()
    assert progress.current_step(db, gone.participant).name == "thanks"


def test_signs_of_life_keep_a_lease(
    db: Database, study: Study, enrol_walk: Any, clock: Any
) -> None:
    walk = enrol_walk(1)
    walk.begin()
    for _ in range(4):
        clock.move(minutes=20)
        walk.participant = participants.seen(db, walk.participant)
    assert sum(arms.counts(db, study).values()) == 1


def shared_out(raw: dict[str, Any]) -> StudyDefinition:
    """Return a study of six pairings of which one person sees four: six blocks, four rows."""
    factors = {"distances": ["near"], "lods": ["low", "own", "third"], "against": ["ultra"]}
    raw["lods"]["third"] = {"base": "ultra", "sclera": "low"}
    raw |= {"key": "shared", "sizes": ["320x180"], "factors": [factors], "clips": [], "catch": []}
    return parse_definition(raw | {"per_person": {"pairs": 4}, "order": {"trials": "balanced"}})


def test_people_get_blocks_and_rows_in_turn(
    db: Database, raw: dict[str, Any], enrol_into: Any
) -> None:
    study = studies.register(db, shared_out(raw))
    people = []
    for seed in range(12):
        walk = enrol_into(study, seed)
        walk.begin()
        people.append(walk.participant)
    assert {Counter(arms.counts(db, study).values())[1], len(people)} == {12}
    assert Counter(person.block for person in people) == dict.fromkeys(range(1, 7), 2)
    assert Counter(person.order_row for person in people) == dict.fromkeys(range(1, 5), 3)
    for person in people:
        mine = trials.all_trials(db, person)
        assert [t.clip for t in mine] == [
            t.clip.id
            for t in schedule(
                study.definition, person.seed, block=person.block, order_row=person.order_row
            )
        ]
        assert trials.clip_ids(db, person) == tuple(t.clip_id for t in mine)


def test_a_person_starts_as_soon_as_one_block_is_there(
    db: Database, raw: dict[str, Any], enrol_into: Any
) -> None:
    study = studies.register(db, shared_out(raw))
    wanted = study.definition.wanted_specs()
    jobs.enqueue(db, wanted)
    assert len(wanted) == 2 * 7
    walk = enrol_into(study)
    walk.to_preparing()
    render(db, 4)
    assert readiness(db, walk.participant, screen=None).clips_left == 1
    render(db, 1)
    leased = arms.assign(db, walk.participant)
    assert leased is not None
    assert (leased.orbit_direction, leased.block) == ("rightward", 1)


def test_a_smaller_screen_keeps_the_row_and_gives_the_arm_back(
    db: Database, raw: dict[str, Any], enrol_into: Any
) -> None:
    definition = shared_out(raw).model_dump(mode="json") | {"sizes": [SMALL, LARGE]}
    study = studies.register(db, parse_definition(definition))
    walk = enrol_into(study)
    walk.to_preparing()
    open_arms = all_arms(study.definition)
    first = arms.assign(db, walk.participant, available=open_arms)
    smaller = arms.assign(db, walk.participant, screen=(400, 400), available=open_arms)
    assert first is not None
    assert smaller is not None
    assert (first.size, smaller.size) == (LARGE, SMALL)
    assert first.order_row == smaller.order_row
    assert sum(arms.counts(db, study).values()) == 1


def test_who_fails_the_checks_leaves_the_place_to_somebody_else(
    db: Database, raw: dict[str, Any], enrol_into: Any
) -> None:
    expected = [{"question": "comparison", "value": -1}]
    gold = {"id": "g", "distance": "near", "left": "ultra", "right": "low", "after": 1}
    rule = {"rule": {"failed_gold": 1}}
    study = studies.register(
        db, parse_definition(raw | {"gold": [gold | {"expected": expected}], "completion": rule})
    )
    for seed, comparison in ((1, "1"), (2, "-1")):
        walk = enrol_into(study, seed)
        walk.begin()
        while (step := progress.current_step(db, walk.participant)).trial is not None:
            walk.answer(step.trial.position, comparison=comparison)
        person = participants.by_name(db, walk.participant.public_id)
        assert person is not None
        assert person.outcome == {"1": "failed_checks", "-1": "completed"}[comparison]
        assert sum(arms.counts(db, study).values()) == seed - 1


def test_completed_people_count_for_ever(
    db: Database, study: Study, enrol_walk: Any, clock: Any
) -> None:
    walk = enrol_walk(1)
    walk.begin()
    walk.finish()
    clock.move(days=400)
    assert sum(arms.counts(db, study).values()) == 1


def test_simulated_people_do_not_unbalance_real_ones(
    db: Database, study: Study, enrol_walk: Any
) -> None:
    for seed in range(3):
        enrol_walk(seed, simulated=True).begin()
    assert sum(arms.counts(db, study).values()) == 0
    assert sum(arms.counts(db, study, simulated=True).values()) == 3


def test_abandoned_arms_are_filled_again(
    db: Database, study: Study, enrol_walk: Any, clock: Any
) -> None:
    # Who drops out leaves a deficit; the next people fill it until the arms are even again.
    abandons = [True, False, True, True, False, False, True, False, False, False, False, False]
    for seed, abandoned in enumerate(abandons):
        walk = enrol_walk(seed)
        walk.begin()
        if abandoned:
            clock.move(minutes=31)
        else:
            walk.finish()
        done = Counter(arms.counts(db, study))
        assert abs(done[Arm(LARGE, "leftward")] - done[Arm(LARGE, "rightward")]) <= 1
    assert set(done) == set(all_arms(study.definition))
