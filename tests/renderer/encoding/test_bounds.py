"""What is accepted of an encoding, and which quality is tried next."""

from __future__ import annotations

from dataclasses import replace

import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.encoding.bounds import Attempt, better, max_bytes, missed_bounds, next_quality
from renderer.encoding.comparison import Fidelity

SPEC = ClipSpec(left=Detail.uniform("low"), right=Detail.uniform("ultra"))
LIMIT = 8_000_000


def attempt(quality: float, file_bytes: int, share: float | None = None) -> Attempt:
    lods = None if share is None else [0.3, 0.1]
    encoding = None if share is None else [0.3 * share, 0.1 * share]
    signal = {"psnr_db": [40.0, 40.0], "ssim": [0.99, 0.99]}
    fidelity = Fidelity(**signal, flip_encoding=encoding, flip_lods=lods)
    return Attempt(quality, file_bytes, fidelity)


def test_five_seconds_at_1080_lines_may_have_eight_megabytes() -> None:
    assert max_bytes(SPEC) == 8_000_000
    assert max_bytes(SPEC.resized(1280, 720)) == 8_000_000
    assert max_bytes(SPEC.resized(3840, 2160)) == 32_000_000


def test_the_bound_follows_a_clips_time_but_leaves_room_for_a_key_frame() -> None:
    assert max_bytes(replace(SPEC, duration_s=10.0)) == 16_000_000
    assert max_bytes(replace(SPEC, duration_s=0.1)) == 1_600_000


def test_what_misses_a_bound_is_said_with_found_and_accepted() -> None:
    assert missed_bounds(attempt(25, 7_900_000, 0.099), limit=LIMIT) == []
    assert missed_bounds(attempt(25, 9_250_000, 0.123), limit=LIMIT) == [
        "the file has 9.25 MB; at most 8.00 MB are accepted",
        "FLIP of the encoding is 0.123 of FLIP between its LoDs; at most 0.1 is accepted",
    ]


def test_without_a_difference_only_the_size_counts() -> None:
    assert missed_bounds(attempt(25, 7_000_000), limit=LIMIT) == []
    assert next_quality([attempt(25, 7_000_000)], limit=LIMIT) is None
    alike = Fidelity(psnr_db=[1], ssim=[1], flip_encoding=[0.2, 0.2], flip_lods=[0.0, 0.0])
    assert alike.flip_share is None


def test_a_file_too_large_is_tried_coarser_by_its_octaves() -> None:
    assert next_quality([attempt(25, 16_000_000, 0.2)], limit=LIMIT) == pytest.approx(
        30.37, abs=0.01
    )
    assert next_quality([attempt(25, 8_000_001)], limit=LIMIT) == 25.5
    assert next_quality([attempt(49, 64_000_000)], limit=LIMIT) == 50.0
    assert next_quality([attempt(50, 64_000_000)], limit=LIMIT) is None


def test_a_share_too_large_is_tried_finer_as_far_as_there_is_room() -> None:
    assert next_quality([attempt(25, 3_800_000, 0.2)], limit=LIMIT) == pytest.approx(20.0)
    assert next_quality([attempt(25, 100_000, 0.2)], limit=LIMIT) == 13.0
    assert next_quality([attempt(25, 7_700_000, 0.2)], limit=LIMIT) is None
    assert next_quality([attempt(8, 100_000, 0.2)], limit=LIMIT) is None


def test_two_attempts_tell_how_much_a_step_saves() -> None:
    tried = [attempt(26, 16_000_000), attempt(31, 11_313_708)]  # half an octave in 5 steps
    assert next_quality(tried, limit=LIMIT) == pytest.approx(31 + 10 * 0.574, abs=0.01)


def test_the_better_one_fits_and_then_is_the_finer() -> None:
    large, fits, finer = attempt(20, 9_000_000), attempt(25, 6_000_000), attempt(23, 7_500_000)
    assert better(large, fits, limit=LIMIT) is fits
    assert better(fits, finer, limit=LIMIT) is finer
    assert better(large, attempt(18, 11_000_000), limit=LIMIT) is large
