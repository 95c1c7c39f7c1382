"""The LoDs along a clip's path: the same for a frame alone, and remembered from frame to frame."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.lod.choice import LodPolicy, LodStep
from renderer.lod.path import details_of, places_of_clip, places_of_view, shares_of

LOW, HIGH, ULTRA = (Detail.uniform(name) for name in ("low", "high", "ultra"))
POLICY = LodPolicy(
    (LodStep("low", LOW, 20.0), LodStep("high", HIGH, 90.0), LodStep("ultra", ULTRA, None)),
    hysteresis=0.2,
)
SPEC = ClipSpec(
    left=ULTRA,
    right=ULTRA,
    motion="approach",
    approach_start_px=10.0,
    approach_end_px=200.0,
    left_switching="blended",
    right_switching="instant",
    lod_policy=POLICY,
    duration_s=4.0,
)


def test_an_approach_climbs_the_steps_one_way_or_the_other() -> None:
    left, right = zip(*places_of_clip(SPEC), strict=True)
    assert (left[0], left[-1], right[0], right[-1]) == (0.0, 2.0, 0.0, 2.0)
    assert all(a <= b for places in (left, right) for a, b in pairwise(places))
    assert set(right) == {0.0, 1.0, 2.0}
    assert len({place for place in left if place % 1}) > 8, "it blends over several frames"


def test_on_the_way_back_the_finer_lod_lasts_longer() -> None:
    there = places_of_clip(SPEC)
    back = places_of_clip(replace(SPEC, approach_start_px=200.0, approach_end_px=10.0))[::-1]
    assert [row[0] for row in there] == pytest.approx([row[0] for row in back])
    fine_there, fine_back = (sum(row[1] == 2.0 for row in rows) for rows in (there, back))
    assert fine_back > fine_there


def test_a_view_that_came_from_nowhere_has_no_memory() -> None:
    assert places_of_view(SPEC, 0.0, distance_px=19.0) == pytest.approx(
        (POLICY.mix(19.0), 0.0), abs=0.01
    )
    assert places_of_view(replace(SPEC, left_switching="fixed"), 0.0, distance_px=19.0) == (2, 0)


def test_eyes_that_keep_their_lods_have_no_places() -> None:
    fixed = ClipSpec(left=LOW, right=HIGH)
    assert places_of_clip(fixed) == ()
    assert places_of_view(fixed, 0.0) is None
    assert shares_of(fixed, None) == (((LOW, 1.0),), ((HIGH, 1.0),))
    assert details_of(fixed) == (LOW, HIGH)


def test_a_place_between_two_steps_is_shared_by_them() -> None:
    left, right = shares_of(SPEC, (0.25, 2.0))
    assert left == ((LOW, 0.75), (HIGH, 0.25))
    assert right == ((ULTRA, 1.0),)
    assert set(details_of(SPEC)) == {LOW, HIGH, ULTRA}
