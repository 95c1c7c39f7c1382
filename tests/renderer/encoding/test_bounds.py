"""What is accepted of an encoding, and how it is made to hold."""

from __future__ import annotations

from dataclasses import replace

import pytest

from renderer.clip import ClipSpec
from renderer.clip_values import DISTANCES
from renderer.detail import Detail
from renderer.encoding.bounds import fineness, max_bytes, max_rate, missed_bounds
from renderer.encoding.comparison import Fidelity

SPEC = ClipSpec(left=Detail.uniform("low"), right=Detail.uniform("ultra"))
LIMIT = 8_000_000


def fidelity(share: float | None = None, floor: float | None = None) -> Fidelity:
    lods = None if share is None else [0.3, 0.1]
    encoding = None if share is None else [0.3 * share, 0.1 * share]
    return Fidelity(
        psnr_db=[40.0, 40.0],
        ssim=[0.99, 0.99],
        flip_encoding=encoding,
        flip_lods=lods,
        flip_floor=floor,
    )


def test_five_seconds_at_1080_lines_may_have_eight_megabytes() -> None:
    assert max_bytes(SPEC) == 8_000_000
    assert max_bytes(SPEC.resized(1280, 720)) == 8_000_000
    assert max_bytes(SPEC.resized(3840, 2160)) == 32_000_000


def test_the_bound_follows_a_clips_time_but_leaves_room_for_a_key_frame() -> None:
    assert max_bytes(replace(SPEC, duration_s=10.0)) == 16_000_000
    assert max_bytes(replace(SPEC, duration_s=0.1)) == 1_600_000


def test_what_misses_a_bound_is_said_with_found_and_accepted() -> None:
    assert missed_bounds(7_900_000, fidelity(0.099), limit=LIMIT) == []
    assert missed_bounds(9_250_000, fidelity(0.123), limit=LIMIT) == [
        "the file has 9.25 MB; at most 8.00 MB are accepted",
        "FLIP of the encoding is 0.123 of FLIP between its LoDs; at most 0.1 is accepted",
    ]


def test_what_the_form_itself_loses_is_said_too() -> None:
    assert missed_bounds(7_900_000, fidelity(0.64, 0.41), limit=LIMIT) == [
        "FLIP of the encoding is 0.640 of FLIP between its LoDs; at most 0.1 is accepted; "
        "8 bits of 4:2:0 alone, uncompressed, have 0.410"
    ]


def test_without_a_difference_only_the_size_counts() -> None:
    assert missed_bounds(7_000_000, fidelity(), limit=LIMIT) == []
    alike = Fidelity(psnr_db=[1], ssim=[1], flip_encoding=[0.2, 0.2], flip_lods=[0.0, 0.0])
    assert alike.flip_share is None


@pytest.mark.parametrize("seconds", [0.1, 1.0, 3.9, 5.0, 12.0])
def test_the_rate_and_what_is_taken_from_the_buffer_stay_below_the_bound(seconds: float) -> None:
    spec = replace(SPEC, duration_s=seconds)
    rate = max_rate(spec)
    drained = 0.4 if seconds >= 4 else 0.9
    total = rate.bits_per_s * (seconds + drained * rate.over_s) / 8
    assert 0.9 * max_bytes(spec) < total < max_bytes(spec)
    if spec.duration_s == 5.0:
        assert rate.bits_per_s * rate.over_s < 31.25e6  # H.264's level 4


def test_smaller_pictures_and_eyes_are_encoded_finer() -> None:
    whole, near = fineness(SPEC), fineness(replace(SPEC, distance="near"))
    assert whole.quality - whole.eye_steps > near.quality - near.eye_steps
    assert fineness(SPEC.resized(1280, 720)).quality == pytest.approx(
        whole.quality - 5.85, abs=0.01
    )
    assert fineness(SPEC.resized(320, 180)).quality == whole.quality - 6.0
    assert fineness(SPEC.resized(3840, 2160)) == whole


@pytest.mark.parametrize("distance", DISTANCES)
def test_an_opening_is_finer_than_its_lids_and_these_no_coarser_than_skin(distance: str) -> None:
    fine = fineness(replace(SPEC, distance=distance))
    assert fine.eye_steps > fine.lid_steps + 10
    assert fine.lid_steps >= 0
