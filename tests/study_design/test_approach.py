"""Approaches and switching LoDs in a study file: clips, faults, and hashes that stay."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from renderer.detail import EFFECTS, Detail
from renderer.lod.policy import default_policy
from study.design.audit import warnings
from study.design.definition import StudyDefinition, parse_definition, read_definition
from study.design.faults import DefinitionError
from study.design.parts import read_size
from study.design.pixels import median_iris_px
from study.design.unseen import largest_iris_px

SIZE = read_size("1280x720")


@pytest.fixture
def approaching(raw: dict[str, Any]) -> dict[str, Any]:
    """The small study with one clip that approaches and eyes that switch."""
    raw["lods"]["blended"] = {"switching": "blended"}
    raw["lods"]["instant"] = {"switching": "instant"}
    raw["clips"].append(
        {
            "id": "closer",
            "motion": "approach",
            "distance": "far",
            "left": "blended",
            "right": "instant",
        }
    )
    raw["approach"] = {"start": 20, "end": "near", "duration_s": 2.0, "azimuth_deg": 10.0}
    return raw


def faults(raw: dict[str, Any]) -> list[str]:
    with pytest.raises(DefinitionError) as caught:
        parse_definition(raw)
    return [str(fault) for fault in caught.value.faults]


def spec_of(definition: StudyDefinition, clip: str, direction: str = "rightward") -> Any:
    found = definition.clip(clip)
    return definition.clip_spec(found, size=SIZE, orbit_direction=direction)


def test_an_approach_becomes_a_clip_with_its_way_and_its_switching(
    approaching: dict[str, Any],
) -> None:
    definition = parse_definition(approaching)
    spec = spec_of(definition, "closer")
    assert (spec.motion, spec.approach_start_px, spec.approach_end_px) == ("approach", 20.0, 160.0)
    assert (spec.duration_s, spec.azimuth_deg(3)) == (2.0, 10.0)
    assert (spec.left_switching, spec.right_switching) == ("blended", "instant")
    assert spec.lod_policy == default_policy()
    assert spec.left == default_policy().finest
    assert spec_of(definition, "closer", "leftward").azimuth_deg(3) == -10.0
    other = definition.every_clip[0]
    assert spec_of(definition, other.id).motion == "orbit"
    assert spec_of(definition, other.id).lod_policy is None


def test_straight_ahead_both_directions_are_one_clip(approaching: dict[str, Any]) -> None:
    approaching["approach"]["azimuth_deg"] = 0.0
    definition = parse_definition(approaching)
    ways = [spec_of(definition, "closer", way).clip_id for way in ("rightward", "leftward")]
    assert ways[0] == ways[1]


def test_without_an_end_the_camera_stops_at_the_clips_distance(approaching: dict[str, Any]) -> None:
    del approaching["approach"]["end"]
    assert spec_of(parse_definition(approaching), "closer").approach_end_px == 12.0


def test_the_sizes_of_an_approach_are_those_of_its_way(approaching: dict[str, Any]) -> None:
    definition = parse_definition(approaching)
    clip = definition.clip("closer")
    assert largest_iris_px(definition, clip, SIZE) == pytest.approx(160 * 720 / 1080, rel=0.05)
    middle = (20 * 160) ** 0.5 * 720 / 1080
    assert median_iris_px(spec_of(definition, "closer"))[0] == pytest.approx(middle, rel=0.2)


def test_a_lod_that_switches_has_no_levels_of_its_own(approaching: dict[str, Any]) -> None:
    definition = parse_definition(approaching)
    assert definition.levels("blended") == dict.fromkeys(EFFECTS)
    assert definition.levels("low") == Detail.uniform("low").levels()
    approaching["lods"]["blended"]["texture"] = "high"
    approaching["lods"]["own"] = {"base": "instant"}
    assert faults(approaching) == [
        "lods.blended.texture: a LoD that switches takes its levels from the lod_policy; leave "
        "this out",
        'lods.own.base: "instant" switches and has no levels to start from',
    ]


@pytest.mark.parametrize(
    ("key", "value", "expected"),
    [
        ("start", "close", 'approach.start: unknown distance "close"; choose one of macroscopic'),
        ("start", True, "approach.start: True is no place; write a distance, or an iris's"),
        ("end", 1000, "approach.end: 1000.0 lies outside 4.0 to 400.0"),
        ("end", "macroscopic", "approach: 320x180: approach_end_px: 350 is too large; one camera"),
        ("azimuth_deg", 90.0, "approach.azimuth_deg: 90.0 lies outside -60.0 to 60.0"),
    ],
)
def test_a_way_that_cannot_be_is_a_fault(
    approaching: dict[str, Any], key: str, value: object, expected: str
) -> None:
    approaching["approach"][key] = value
    assert [fault for fault in faults(approaching) if fault.startswith(expected)]


def test_an_approach_to_macroscopic_needs_an_end(approaching: dict[str, Any]) -> None:
    del approaching["approach"]["end"]
    approaching["clips"][-1]["distance"] = "macroscopic"
    approaching["distances"].append("macroscopic")
    (fault,) = faults(approaching)
    assert fault.endswith("say in [approach] where the camera ends")
    assert fault.startswith(f"clips.{len(approaching['clips']) - 1}.distance: one camera cannot")


def test_a_policy_is_read_beside_the_study_and_kept_in_it(
    approaching: dict[str, Any], tmp_path: Path
) -> None:
    policy = {
        "schema": 1,
        "measure": "people's ratings",
        "hysteresis": 0.2,
        "band": 0.3,
        "steps": [
            {"lod": "medium", "up_to_iris_px": 33},
            {"lod": "high", "up_to_iris_px": None, "ms": 2.5},
        ],
    }
    (tmp_path / "mine.json").write_text(json.dumps(policy))
    text = Path(str(parse_definition.__code__.co_filename)).parent / "definitions" / "approach.toml"
    own, _, _ = text.read_text().partition("[lod_policy]")
    (tmp_path / "mine.ar.toml").write_text(text.with_name("approach.ar.toml").read_text())
    study = own.replace("[contact]", 'lod_policy = "mine.json"\n\n[contact]', 1)
    (tmp_path / "mine.toml").write_text(study)
    definition = read_definition(tmp_path / "mine.toml")
    assert definition.detail("blended") == Detail.uniform("high")
    again = parse_definition(json.loads(definition.to_json()))
    assert again.detail("instant") == Detail.uniform("high")
    (tmp_path / "mine.json").unlink()
    with pytest.raises(DefinitionError, match=r"lod_policy: .*mine\.json: No such file"):
        read_definition(tmp_path / "mine.toml")
    wide = [{"lod": "medium", "up_to_iris_px": 9000}, {"lod": "high", "up_to_iris_px": None}]
    approaching["lod_policy"] = policy | {"steps": wide}
    told = "steps.0.up_to_iris_px: 9000.0; the LoDs run from coarse to fine, and each needs a size "
    assert f"{told}in pixels above 0, to 7680, the widest picture" in faults(approaching)[0]
    approaching["lod_policy"] = policy | {"steps": []}
    assert faults(approaching)[0].startswith("lod_policy: not a LoD policy of schema 1: steps: em")


def test_what_came_later_leaves_older_definitions_their_names(raw: dict[str, Any]) -> None:
    before = parse_definition(raw).definition_hash
    raw["clips"][0]["motion"] = "orbit"
    raw["approach"] = {"start": 30}
    assert parse_definition(raw).definition_hash == before
    raw["clips"][0] |= {"motion": "approach", "distance": "near"}
    assert parse_definition(raw).definition_hash != before
    # Written when the keys did not exist: people's answers refer to it.
    older = read_definition(Path(__file__).with_name("thesis-version-1.toml"))
    assert older.definition_hash == "a5d8d8a6244d0387"


def test_the_check_warns_where_motions_mix(approaching: dict[str, Any]) -> None:
    approaching["clips"].append(
        {"id": "turn", "distance": "far", "left": "low", "right": "ultra"},
    )
    told = warnings(parse_definition(approaching))
    assert [line for line in told if line.startswith("clips: at far some turn around the eyes")]


def test_factors_generate_approaches_with_names_of_their_own(approaching: dict[str, Any]) -> None:
    approaching["factors"] = [
        {
            "motion": "approach",
            "distances": ["far"],
            "lods": ["blended"],
            "against": ["ultra"],
            "sides": "given",
        }
    ]
    clip = parse_definition(approaching).clip("approach-far-blended-ultra")
    assert clip.motion == "approach"
