"""ClipSpec: names follow from content, faults are told together."""

from __future__ import annotations

import re

import pytest

from renderer.clip import ClipSpec
from renderer.detail import EFFECTS, Detail

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
