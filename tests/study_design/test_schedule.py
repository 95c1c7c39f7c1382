"""Order and arms: random, balanced, and the same again from the same seed."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from study.design.definition import parse_definition, read_definition
from study.design.schedule import Arm, all_arms, assign_arm, schedule

THESIS = read_definition("thesis")
ARMS = [Arm("1280x720", direction) for direction in ("leftward", "rightward")]
seeds = st.integers(0, 2**62)


@given(seeds)
def test_everybody_sees_practice_first_and_then_every_clip_once(seed: int) -> None:
    trials = schedule(THESIS, seed)
    assert [trial.position for trial in trials] == list(range(1, 9))
    assert [trial.is_practice for trial in trials] == [True] + [False] * 7
    assert [trial.number for trial in trials] == [1, *range(1, 8)]
    assert sorted(trial.clip.id for trial in trials[1:]) == list("1234567")


@given(seeds)
def test_the_same_seed_gives_the_same_order(seed: int) -> None:
    assert schedule(THESIS, seed) == schedule(THESIS, seed)


def test_the_order_of_a_seed_never_changes() -> None:
    # Written down once: a change here means that stored seeds no longer give what people saw.
    assert [trial.clip.id for trial in schedule(THESIS, 1)] == ["practice", *"3176524"]
    assert [trial.clip.id for trial in schedule(THESIS, 2)] == ["practice", *"5143726"]


def test_every_clip_comes_at_every_position_equally_often() -> None:
    seen = Counter(
        (trial.clip.id, trial.number)
        for seed in range(1400)
        for trial in schedule(THESIS, seed)
        if not trial.is_practice
    )
    assert len(seen) == 49
    # 200 expected in each of 49 cells, standard deviation 13: five of them are never exceeded.
    assert max(abs(count - 200) for count in seen.values()) < 66


def test_a_study_may_keep_the_files_order(raw: dict[str, Any]) -> None:
    raw["order"] = {"trials": "file"}
    definition = parse_definition(raw)
    for seed in range(5):
        assert [trial.clip.id for trial in schedule(definition, seed)] == ["p", "a", "b"]


def test_arms_are_every_size_with_every_direction() -> None:
    assert [str(arm) for arm in all_arms(THESIS)] == [
        *("1280x720 rightward", "1280x720 leftward"),
        *("1920x1080 rightward", "1920x1080 leftward"),
    ]


@given(st.lists(st.integers(0, 50), min_size=2, max_size=2), seeds)
def test_the_least_filled_arm_is_taken(filled: list[int], seed: int) -> None:
    counts = dict(zip(ARMS, filled, strict=True))
    taken = assign_arm(counts, ARMS, np.random.default_rng(seed))
    assert counts[taken] == min(filled)


@given(st.integers(0, 9), seeds)
def test_an_arm_that_is_not_available_is_never_taken(filled: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    assert assign_arm({ARMS[0]: filled}, [ARMS[0]], rng) == ARMS[0]


def test_equal_arms_are_both_taken_by_chance() -> None:
    taken = Counter(assign_arm({}, ARMS, np.random.default_rng(seed)) for seed in range(200))
    assert min(taken.values()) > 60


def test_no_arm_at_all_says_what_to_wait_for() -> None:
    with pytest.raises(ValueError, match="wait until the clips of one arm are rendered"):
        assign_arm({}, [], np.random.default_rng(0))


@given(st.lists(st.booleans(), max_size=60), seeds)
def test_completed_counts_stay_balanced_when_people_come_one_by_one(
    completes: list[bool], seed: int
) -> None:
    rng = np.random.default_rng(seed)
    completed: Counter[Arm] = Counter()
    for completed_it in completes:
        arm = assign_arm(completed, ARMS, rng)
        completed[arm] += completed_it
        assert abs(completed[ARMS[0]] - completed[ARMS[1]]) <= 1
