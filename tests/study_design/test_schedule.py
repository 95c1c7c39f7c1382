"""Orders: drawn, balanced or the file's, and the same again from the same seed."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from study.design.definition import StudyDefinition, parse_definition, read_definition
from study.design.schedule import order_rows, schedule

THESIS, LOD = read_definition("thesis"), read_definition("lod")
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


def balanced(raw: dict[str, Any], **order: Any) -> StudyDefinition:
    """Return a study of four clips whose orders are balanced."""
    factors = {"distances": ["near", "far"], "lods": ["low"], "against": ["ultra"]}
    more = {"clips": [], "factors": [factors], "order": {"trials": "balanced", **order}}
    return parse_definition(raw | more)


def test_balanced_orders_are_rows_of_a_williams_square_of_the_clips(raw: dict[str, Any]) -> None:
    definition = balanced(raw)
    rows = range(1, len(order_rows(definition)) + 1)
    assert len(rows) == 4
    orders = [
        [t.clip.id for t in schedule(definition, 9, order_row=row) if not t.is_practice]
        for row in rows
    ]
    places = Counter((place, name) for order in orders for place, name in enumerate(order))
    assert set(places.values()) == {1}
    assert len(places) == 16
    after = Counter(pair for order in orders for pair in pairwise(order))
    assert set(after.values()) == {1}
    assert len(after) == 12


def test_an_order_that_is_drawn_or_the_files_has_no_rows(raw: dict[str, Any]) -> None:
    assert order_rows(THESIS) == ()
    raw["order"] = {"trials": "file"}
    assert order_rows(parse_definition(raw)) == ()


@given(seeds, st.integers(1, 12), st.integers(1, 20))
@settings(max_examples=20, deadline=None)
def test_one_visit_of_the_recommended_study(seed: int, block: int, row: int) -> None:
    trials = schedule(LOD, seed, block=block, order_row=row)
    assert trials == schedule(LOD, seed, block=block, order_row=row)
    assert [trial.is_practice for trial in trials] == [True] * 3 + [False] * 21
    assert [trial.position for trial in trials] == list(range(1, 25))
    rated = [trial.clip for trial in trials[3:]]
    assert rated.index(LOD.clip("gold")) == 13
    rest = [clip for clip in rated if clip.id != "gold"]
    assert set(rest) == set(LOD.blocks[block - 1])
    assert sum(clip.is_catch for clip in rest) == 4


def test_who_shares_block_and_row_still_draws_lots_within_a_distance() -> None:
    orders = {
        tuple(t.clip.id for t in schedule(LOD, seed, block=2, order_row=5)) for seed in range(5)
    }
    kinds = {
        tuple((t.clip.distance, t.clip.is_catch) for t in schedule(LOD, seed, block=2, order_row=5))
        for seed in range(5)
    }
    assert len(orders) == 5
    assert len(kinds) == 1


def test_the_order_of_a_seed_a_block_and_a_row_never_changes() -> None:
    # Written down once: a change here means that stored places no longer give what people saw.
    trials = schedule(LOD, 1, block=1, order_row=1)
    assert [trial.clip.id for trial in trials[3:7]] == [
        "macroscopic-high-ultra-brown",
        "near-medium-ultra-green",
        "catch-far-ultra-dark-brown",
        "medium-medium-ultra-blue",
    ]


def test_distances_and_equal_pairs_are_balanced_over_places_by_the_rows() -> None:
    seen = Counter(
        (trial.number, trial.clip.distance, trial.clip.is_catch)
        for row in range(1, 21)
        for trial in schedule(LOD, row, block=1, order_row=row)
        if not trial.is_practice and trial.clip.id != "gold"
    )
    assert {n for (_, _, is_catch), n in seen.items() if is_catch} == {1}
    assert {n for (_, _, is_catch), n in seen.items() if not is_catch} == {4}


def test_a_files_order_holds_within_a_block(raw: dict[str, Any]) -> None:
    definition = balanced(raw | {"per_person": {"pairs": 2}}, trials="file")
    names = [[t.clip.id for t in schedule(definition, 1, block=b)[1:]] for b in (1, 2)]
    assert names == [["near-low-ultra", "far-ultra-low"], ["near-ultra-low", "far-low-ultra"]]


def test_gold_trials_come_after_as_many_others_as_the_file_says(raw: dict[str, Any]) -> None:
    gold: dict[str, Any] = {"distance": "near", "left": "low", "right": "ultra"}
    gold |= {"expected": [{"question": "noticed", "value": "yes"}]}
    raw["gold"] = [{"id": "late", "after": 3, **gold}, {"id": "early", "after": 0, **gold}]
    raw["order"] = {"trials": "file"}
    trials = schedule(parse_definition(raw), 1)
    assert [trial.clip.id for trial in trials] == ["p", "early", "a", "b", "late"]
