"""Crowds as a factor: the same pairings amid nobody, five people or more."""

from __future__ import annotations

from collections import Counter
from typing import Any

import pytest

from study.design.definition import DefinitionError, parse_definition
from study.design.exposure import spreads, visits
from study.design.parts import read_size

FACTORS = {"distances": ["near"], "lods": ["low"], "against": ["ultra"], "crowds": [0, 5]}


def test_factors_show_every_pairing_amid_every_crowd(raw: dict[str, Any]) -> None:
    raw |= {"clips": [], "irises": {"blue": {}}, "scene": {"crowd": 10}}
    raw["factors"] = [FACTORS, FACTORS | {"crowds": [30], "irises": ["blue"], "sides": "given"}]
    raw["catch"] = [{"distance": "far", "lod": "low", "crowd": 5}]
    definition, size = parse_definition(raw), read_size("320x180")
    specs = {
        clip.id: definition.clip_spec(clip, size=size, orbit_direction="leftward").crowd
        for clip in definition.every_clip
    }
    assert specs == {
        "p": 10,
        **{"near-low-ultra-crowd-0": 0, "near-low-ultra-crowd-5": 5},
        **{"near-ultra-low-crowd-0": 0, "near-ultra-low-crowd-5": 5},
        "near-low-ultra-crowd-30-blue": 30,
        "catch-far-low-crowd-5": 5,
    }
    files = definition.file_names(size, "leftward")
    assert files["near-low-ultra-crowd-0"] != files["near-low-ultra-crowd-5"]


def test_blocks_balance_crowds_and_the_audit_counts_them(raw: dict[str, Any]) -> None:
    raw |= {"clips": [], "factors": [FACTORS], "per_person": {"pairs": 2}}
    definition = parse_definition(raw)
    seen = Counter(clip.crowd for block in definition.blocks for clip in block)
    assert len(set(seen.values())) == 1
    assert set(seen) == {0, 5}
    counted = {row.name: row for row in spreads(definition, visits(definition, 24))}
    assert counted["each crowd"].least == counted["each crowd"].most == 24


def test_a_study_without_them_keeps_its_hash(raw: dict[str, Any]) -> None:
    raw["clips"] = [clip | {"crowd": None} for clip in raw["clips"]]
    told, plain = parse_definition(raw), parse_definition(raw | {"factors": []})
    assert told.definition_hash == plain.definition_hash
    other = [clip | {"crowd": 0} for clip in raw["clips"]]
    assert parse_definition(raw | {"clips": other}).definition_hash != plain.definition_hash


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"factors": [FACTORS | {"crowds": [0, 7]}]}, "factors.0.crowds.1: "),
        ({"factors": [FACTORS | {"crowds": [5, 5]}]}, "factors.0.crowds: a crowd is listed twice"),
        ({"catch": [{"distance": "far", "lod": "low", "crowd": -1}]}, "catch.0.crowd: "),
    ],
)
def test_faults_of_crowds_are_told(raw: dict[str, Any], changes: dict[str, Any], told: str) -> None:
    with pytest.raises(DefinitionError) as caught:
        parse_definition(raw | changes, source="x")
    lines = [line for line in str(caught.value).splitlines() if line.startswith(f"x: {told}")]
    assert len(lines) == 1
    assert "twice" in lines[0] or "0, 5, 10, 30" in lines[0]
