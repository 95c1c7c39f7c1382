"""Factors generate clips; sides and catch clips come out as named."""

from __future__ import annotations

from typing import Any, Literal

import pytest

from study.design.definition import parse_definition
from study.design.pairings import CatchClip, Factors

Sides = Literal["given", "swapped", "both", "alternating"]


def pairs(sides: Sides) -> list[tuple[str, str, str]]:
    factors = Factors(
        distances=("near", "far"), lods=("low", "high", "ultra"), against=("ultra",), sides=sides
    )
    return [(clip.distance, clip.left, clip.right) for clip in factors.clips()]


@pytest.mark.parametrize(
    ("sides", "expected"),
    [
        ("given", [("low", "ultra"), ("high", "ultra")] * 2),
        ("swapped", [("ultra", "low"), ("ultra", "high")] * 2),
        ("alternating", [("low", "ultra"), ("ultra", "high")] * 2),
        ("both", [("low", "ultra"), ("ultra", "low"), ("high", "ultra"), ("ultra", "high")] * 2),
    ],
)
def test_factors_put_each_lod_beside_the_others(
    sides: Sides, expected: list[tuple[str, str]]
) -> None:
    assert [pair[1:] for pair in pairs(sides)] == expected
    assert {pair[0] for pair in pairs(sides)} == {"near", "far"}


def test_an_odd_number_of_pairings_alternates_over_distances() -> None:
    factors = Factors(
        distances=("near", "far"), lods=("low",), against=("ultra",), sides="alternating"
    )
    assert [clip.left for clip in factors.clips()] == ["low", "ultra"]


def test_a_catch_clip_has_the_same_lod_in_both_eyes() -> None:
    clip = CatchClip(distance="far", lod="high").clip()
    assert (clip.id, clip.left, clip.right, clip.is_catch) == (
        "catch-far-high",
        *["high"] * 2,
        True,
    )


def test_trials_are_written_clips_then_generated_then_catch(raw: dict[str, Any]) -> None:
    raw["factors"] = [{"distances": ["near"], "lods": ["low"], "against": ["no-caustics"]}]
    raw["catch"] = [{"distance": "far", "lod": "low", "id": "same"}]
    definition = parse_definition(raw)
    assert [clip.id for clip in definition.trial_clips] == [
        *("a", "b", "near-low-no-caustics", "near-no-caustics-low", "same")
    ]
    assert [clip.id for clip in definition.trial_clips if clip.is_catch] == ["same"]
    assert definition.clip("same").left == "low"
