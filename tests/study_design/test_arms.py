"""Arms: a least filled one is taken, and completed counts even out whoever drops out or returns."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass, field

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from study.design.arms import Arm, all_arms, assign_arm, assign_row, clips_of_arm
from study.design.definition import StudyDefinition, parse_definition, read_definition
from study.design.schedule import order_rows

THESIS, LOD = read_definition("thesis"), read_definition("lod")
SHARED = parse_definition(  # six pairings, of which one person sees four: 12 arms, 4 rows
    json.loads(THESIS.to_json())
    | {
        "clips": [],
        "factors": [
            {"distances": ["near"], "lods": ["low", "medium", "high"], "against": ["ultra"]}
        ],
        "per_person": {"pairs": 4},
        "order": {"trials": "balanced"},
    }
)
ARMS = [Arm("1280x720", direction) for direction in ("leftward", "rightward")]
seeds = st.integers(0, 2**62)


def test_arms_are_every_size_with_every_direction() -> None:
    assert [str(arm) for arm in all_arms(THESIS)] == [
        *("1280x720 rightward", "1280x720 leftward"),
        *("1920x1080 rightward", "1920x1080 leftward"),
    ]


def test_arms_of_a_shared_out_study_are_blocks_in_both_directions() -> None:
    arms = all_arms(LOD)
    assert len(arms) == len(set(arms)) == 48
    assert [str(arm) for arm in arms[:3]] == [
        "1280x720 rightward block 1",
        "1280x720 leftward block 2",
        "1280x720 rightward block 3",
    ]
    assert len(clips_of_arm(LOD, arms[0])) == 24


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


def test_of_equally_filled_arms_the_block_that_evens_the_exposures_is_taken() -> None:
    mine = [arm for arm in all_arms(LOD) if arm.size == "1280x720"]
    counts: Counter[Arm] = Counter()
    for number in range(6):
        arm = assign_arm(counts, mine, np.random.default_rng(number), blocks=LOD.blocks)
        counts[arm] += 1
    shown = Counter(clip.condition for arm in counts for clip in LOD.blocks[(arm.block or 1) - 1])
    pairs = {clip.condition: shown[clip.condition] for clip in LOD.trial_clips if not clip.is_catch}
    assert set(pairs.values()) == {4}
    assert Counter(arm.orbit_direction for arm in counts.elements()) == {
        "leftward": 3,
        "rightward": 3,
    }


def test_an_arm_is_needed_less_when_its_block_was_seen_in_another_size() -> None:
    large, small = (Arm(size, "leftward", 1) for size in ("1920x1080", "1280x720"))
    other = Arm("1280x720", "leftward", 2)
    for seed in range(10):
        rng = np.random.default_rng(seed)
        assert assign_arm({large: 1}, [small, other], rng, blocks=LOD.blocks) == other


@dataclass
class Lab:
    """A study to which people come, from which they drop out, and to which some come back.

    The counts are those of the site: completed people and live leases.
    """

    definition: StudyDefinition
    seed: int
    completed: Counter[tuple[Arm, int | None]] = field(default_factory=Counter)
    live: list[tuple[Arm, int | None]] = field(default_factory=list)
    expired: list[tuple[Arm, int | None]] = field(default_factory=list)
    came: int = 0

    @property
    def arms(self) -> list[Arm]:
        return [a for a in all_arms(self.definition) if a.size == "1280x720"]

    def filled(self) -> Counter[tuple[Arm, int | None]]:
        return self.completed + Counter(self.live)

    def come(self) -> tuple[Arm, int | None]:
        rng = np.random.default_rng([self.seed, self.came])
        self.came += 1
        filled = self.filled()
        by_arm: Counter[Arm] = Counter()
        for (arm, _), count in filled.items():
            by_arm[arm] += count
        arm = assign_arm(by_arm, self.arms, rng, blocks=self.definition.blocks)
        assert by_arm[arm] == min(by_arm[one] for one in self.arms)
        used = Counter({(a, n): count for (a, n), count in filled.items() if n is not None})
        place = arm, assign_row(used, arm, len(order_rows(self.definition)), rng)
        self.live.append(place)
        return place

    def happen(self, what: str, whom: int) -> None:
        if what == "come":
            self.come()
        elif what == "finish" and self.live:
            self.completed[self.live.pop(whom % len(self.live))] += 1
        elif what == "drop out" and self.live:
            self.expired.append(self.live.pop(whom % len(self.live)))
        elif what == "come back" and self.expired:
            self.live.append(self.expired.pop(whom % len(self.expired)))
        elif what == "withdraw" and self.completed.total():
            gone = sorted(self.completed.elements(), key=str)[whom % self.completed.total()]
            self.completed[gone] -= 1

    def by_arm(self) -> list[int]:
        return [sum(n for (arm, _), n in self.completed.items() if arm == one) for one in self.arms]

    def by_row(self) -> list[int]:
        rows = range(1, len(order_rows(self.definition)) + 1)
        return [sum(n for (_, row), n in self.completed.items() if row == one) for one in rows]


def deficit(counts: list[int]) -> int:
    return sum(max(counts) - count for count in counts)


WHAT = st.sampled_from(["come", "come", "come", "finish", "finish", "drop out", "come back"])
EVENTS = st.lists(
    st.tuples(st.one_of(WHAT, st.just("withdraw")), st.integers(0, 1000)), max_size=60
)


@pytest.mark.parametrize("definition", [THESIS, SHARED], ids=["thesis", "shared"])
@given(events=EVENTS, seed=st.integers(0, 2**32))
@settings(max_examples=30, deadline=None)
def test_completed_counts_even_out_once_a_deficit_can_be_filled(
    definition: StudyDefinition, events: list[tuple[str, int]], seed: int
) -> None:
    lab = Lab(definition, seed)
    for what, whom in events:
        lab.happen(what, whom)
    while lab.live:  # those who are here finish
        lab.happen("finish", 0)
    needed = deficit(lab.by_arm())
    for _ in range(needed):
        lab.come()
        lab.happen("finish", 0)
    assert max(lab.by_arm()) - min(lab.by_arm()) <= 1


@given(events=EVENTS, seed=st.integers(0, 2**32))
@settings(max_examples=30, deadline=None)
def test_rows_of_the_orders_even_out_as_well(events: list[tuple[str, int]], seed: int) -> None:
    lab = Lab(SHARED, seed)
    for what, whom in events:
        lab.happen(what, whom)
    while lab.live:
        lab.happen("finish", 0)
    for _ in range(deficit(lab.by_row())):
        lab.come()
        lab.happen("finish", 0)
    assert max(lab.by_row()) - min(lab.by_row()) <= 1


@given(st.lists(st.booleans(), max_size=60), seeds)
@settings(deadline=None)
def test_completed_counts_stay_balanced_when_people_come_one_by_one(
    completes: list[bool], seed: int
) -> None:
    lab = Lab(THESIS, seed)
    for completed_it in completes:
        lab.come()
        lab.happen("finish" if completed_it else "drop out", 0)
        assert max(lab.by_arm()) - min(lab.by_arm()) <= 1


def test_a_study_without_rows_gives_none() -> None:
    assert assign_row({}, ARMS[0], 0, np.random.default_rng(0)) is None


def test_a_row_used_less_in_this_arm_goes_first_among_equals() -> None:
    counts = {(ARMS[0], 1): 1, (ARMS[1], 2): 1}
    for seed in range(10):
        assert assign_row(counts, ARMS[0], 2, np.random.default_rng(seed)) == 2
