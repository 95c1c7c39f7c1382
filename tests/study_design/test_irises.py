"""Irises: clips show the one that they name, and a file says where it names one in vain."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from study.design.definition import DefinitionError, parse_definition
from study.design.files import find_files
from study.design.parts import read_size

DARK = {"iris": "dark"}
FACTORS = {"distances": ["near"], "lods": ["low"], "against": ["ultra"]}


def test_a_clip_shows_the_iris_that_it_names(raw: dict[str, Any]) -> None:
    raw["eye"] = {"iris_seed": 7, "iris_colour": "hazel", "pupil_mm": 3.0}
    raw["irises"] = {"dark": {"iris_seed": 9, "iris_colour": "brown"}}
    raw["clips"][0]["iris"] = "dark"
    definition, size = parse_definition(raw), read_size("320x180")
    specs = [
        definition.clip_spec(clip, size=size, orbit_direction="leftward")
        for clip in definition.clips
    ]
    eyes = [(spec.iris_seed, spec.iris_colour, spec.pupil_mm) for spec in specs]
    assert eyes == [(9, "brown", 3.0), (7, "hazel", 3.0)]


def test_an_iris_of_a_photograph_is_known_by_its_contents_and_not_its_place(
    raw: dict[str, Any],
) -> None:
    told = {"iris_file": "/a/anna.npz", "iris_sha256": "0" * 64}
    first = parse_definition(raw | {"irises": {"anna": told}})
    moved = parse_definition(raw | {"irises": {"anna": told | {"iris_file": "/b/anna.npz"}}})
    other = parse_definition(raw | {"irises": {"anna": told | {"iris_sha256": "1" * 64}}})
    assert first.definition_hash == moved.definition_hash != other.definition_hash


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        (
            {"practice": [{"id": "p", "distance": "near", "left": "low", "right": "low"} | DARK]},
            'practice.0.iris: unknown iris "dark"; no iris is defined',
        ),
        (
            {"catch": [{"distance": "far", "lod": "low"} | DARK], "irises": {"dart": {}}},
            'catch.0.iris: unknown iris "dark"; choose one of dart; did you mean "dart"?',
        ),
        (
            {"factors": [FACTORS | {"irises": ["one", "one"]}], "irises": {"one": {}}},
            "factors.0.irises: an iris is listed twice",
        ),
        (
            {"irises": {"one": {"iris_colour": "bleu"}}},
            "irises.one.iris_colour: unknown",
        ),
    ],
)
def test_faults_of_irises_are_told(raw: dict[str, Any], changes: dict[str, Any], told: str) -> None:
    with pytest.raises(DefinitionError) as caught:
        parse_definition(raw | changes, source="x")
    assert any(line.startswith(f"x: {told}") for line in str(caught.value).splitlines())


def test_a_photograph_of_an_iris_is_found_beside_the_study(
    raw: dict[str, Any], tmp_path: Path
) -> None:
    (tmp_path / "anna.npz").write_bytes(b"an iris")
    found, faults = find_files(raw | {"irises": {"anna": {"iris_file": "anna.npz"}}}, tmp_path)
    assert faults == []
    assert found["irises"]["anna"]["iris_file"] == str(tmp_path / "anna.npz")
    assert len(found["irises"]["anna"]["iris_sha256"]) == 64
    wrong = {"otto": {"iris_file": "otto.npz", "iris_colour": "blue"}}
    _, faults = find_files(raw | {"irises": wrong}, tmp_path)
    assert [fault.place for fault in faults] == ["irises.otto.iris_colour", "irises.otto.iris_file"]


def test_factors_show_every_pairing_with_every_iris(raw: dict[str, Any]) -> None:
    raw["irises"] = {"light": {}, "dark": {"iris_colour": "brown"}}
    raw |= {"clips": [], "factors": [FACTORS | {"irises": ["light", "dark"]}]}
    raw["catch"] = [{"distance": "far", "lod": "low", "iris": "dark"}]
    definition = parse_definition(raw)
    assert [clip.id for clip in definition.trial_clips] == [
        *("near-low-ultra-light", "near-low-ultra-dark"),
        *("near-ultra-low-light", "near-ultra-low-dark"),
        "catch-far-low-dark",
    ]
    assert {clip.pairing for clip in definition.trial_clips} == {
        *("near-low-ultra", "near-ultra-low", "catch-far-low"),
    }
