"""ClipSpec: names follow from content, faults are told together."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest

from renderer.clip import ClipSpec
from renderer.detail import EFFECTS, Detail
from renderer.lod.policy import default_policy

LOW, ULTRA = Detail.uniform("low"), Detail.uniform("ultra")


def test_equal_specs_share_a_name_and_any_change_makes_another() -> None:
    spec = ClipSpec(left=LOW, right=ULTRA)
    assert spec.clip_id == ClipSpec(left=LOW, right=ULTRA).clip_id
    others = [
        spec.swapped(),
        spec.resized(1280, 720),
        ClipSpec(left=LOW, right=ULTRA, orbit_direction="leftward"),
        ClipSpec(left=LOW, right=ULTRA, iris_seed=2),
        *(ClipSpec(left=LOW.with_levels(**{effect: "high"}), right=ULTRA) for effect in EFFECTS),
    ]
    assert len({spec.clip_id, *(other.clip_id for other in others)}) == len(others) + 1


def test_a_spec_survives_the_way_through_json() -> None:
    spec = ClipSpec(left=LOW, right=ULTRA, distance="far", sun_azimuth_deg=12.5, crowd=0)
    assert ClipSpec.from_dict(spec.to_dict()) == spec


def test_an_image_is_named_by_its_contents_wherever_it_lies() -> None:
    def lit_by(path: str, digit: str) -> ClipSpec:
        return ClipSpec(
            left=LOW,
            right=ULTRA,
            environment="image",
            environment_file=path,
            environment_sha256=digit * 64,
        )

    here, there, other = lit_by("/a/x.exr", "0"), lit_by("/b/y.exr", "0"), lit_by("/a/x.exr", "1")
    assert here.clip_id == there.clip_id != other.clip_id
    assert ClipSpec.from_dict(here.to_dict()) == here


def test_an_image_needs_path_and_hash_and_the_park_has_neither() -> None:
    with pytest.raises(ValueError, match=r"environment_file: empty; .* needs a picture") as caught:
        ClipSpec(left=LOW, right=LOW, environment="image", environment_sha256="abc")
    assert "environment_sha256: needs the picture's SHA-256" in str(caught.value)
    with pytest.raises(ValueError, match='environment_file: only an environment "image" has one'):
        ClipSpec(left=LOW, right=LOW, environment_file="x.exr")


def test_the_orbit_is_linear_symmetric_and_turns_with_its_direction() -> None:
    rightward = ClipSpec(left=LOW, right=LOW)
    leftward = ClipSpec(left=LOW, right=LOW, orbit_direction="leftward")
    last = rightward.frame_count - 1
    assert rightward.frame_count == 150
    assert (rightward.azimuth_deg(0), rightward.azimuth_deg(last)) == (-60.0, 60.0)
    steps = [rightward.azimuth_deg(i + 1) - rightward.azimuth_deg(i) for i in range(last)]
    assert max(steps) - min(steps) < 1e-9
    assert [leftward.azimuth_deg(i) for i in range(150)] == [
        -rightward.azimuth_deg(i) for i in range(150)
    ]


def test_all_faults_are_told_at_once() -> None:
    with pytest.raises(ValueError, match=re.escape('distance: unknown value "close"')) as caught:
        ClipSpec(left=LOW, right=LOW, distance="close", width=1921, pupil_mm=12)
    message = str(caught.value)
    assert "choose one of macroscopic, near, medium, far" in message
    assert "width: 1921 is odd" in message
    assert "pupil_mm: 12 lies outside 1.5 to 8.0" in message


def test_clips_that_neither_approach_nor_switch_keep_the_names_they_had() -> None:
    assert ClipSpec(left=LOW, right=ULTRA).clip_id == "123a732dd9bed0c56b3b"
    assert ClipSpec(left=LOW, right=ULTRA, approach_start_px=12.0).clip_id == "123a732dd9bed0c56b3b"


def approach(**values: Any) -> ClipSpec:
    fields: dict[str, Any] = {
        "motion": "approach",
        "approach_start_px": 12.0,
        "approach_end_px": 192.0,
    }
    return ClipSpec(**{"left": ULTRA, "right": ULTRA, **fields, **values})


def test_an_approach_grows_by_the_same_factor_and_keeps_its_azimuth() -> None:
    spec = approach(approach_azimuth_deg=20.0, duration_s=5 / 30)
    sizes = [spec.distance_px(frame) for frame in range(spec.frame_count)]
    assert sizes == pytest.approx([12.0, 24.0, 48.0, 96.0, 192.0])
    assert {spec.azimuth_deg(frame) for frame in range(5)} == {20.0}
    leftward = approach(approach_azimuth_deg=20.0, orbit_direction="leftward")
    assert leftward.azimuth_deg(0) == -20.0
    assert ClipSpec(left=LOW, right=LOW).distance_px(3) is None
    assert approach(duration_s=0.03).distance_px(0) == 12.0


def test_switching_and_policy_make_another_name_and_survive_json() -> None:
    policy = default_policy()
    switching = {"left": policy.finest, "right": policy.finest, "lod_policy": policy}
    specs = [
        approach(),
        approach(**switching, left_switching="blended"),
        approach(**switching, left_switching="instant"),
        approach(**switching, left_switching="instant", right_switching="blended"),
        approach(approach_end_px=100.0),
    ]
    assert len({spec.clip_id for spec in specs}) == len(specs)
    for spec in specs:
        assert ClipSpec.from_dict(json.loads(json.dumps(spec.to_dict()))) == spec
    assert specs[3].swapped().left_switching == "blended"


def test_an_eye_that_switches_needs_a_policy_that_ends_at_its_lod() -> None:
    with pytest.raises(ValueError, match="left_switching: blended; an eye that switches needs a"):
        approach(left_switching="blended")
    with pytest.raises(ValueError, match="lod_policy: no eye switches; leave it out"):
        approach(lod_policy=default_policy())
    with pytest.raises(ValueError, match="right: an eye that switches ends at its policy's finest"):
        approach(right=LOW, right_switching="instant", lod_policy=default_policy())


def test_one_camera_shows_both_eyes_only_up_to_a_size() -> None:
    with pytest.raises(ValueError, match="approach_end_px: 250 is too large; one camera shows"):
        approach(approach_end_px=250.0)
    with pytest.raises(ValueError, match="up to an iris of 137 pixels on 1080 lines"):
        approach(width=1080, approach_end_px=140.0)
