"""What bounds a rate: the longer of the GPU's time and the processor's, or waiting."""

from __future__ import annotations

from typing import Any

import pytest

from renderer.benchmark.result import Cost
from renderer.benchmark.verdicts import bound_by, frames_per_s


def whole(**says: Any) -> Cost:
    row: dict[str, Any] = {
        "part": "lods", "renderer": "a GPU", "size": "64x64", "distance": "far", "iris_px": 12.0,
        "eyes": 2, "lod": "ultra", "ms_median": 5.0, "ms_mad": 0.1, "n": 9, "load": 0.5,
    }  # fmt: skip
    return Cost(**(row | says))


@pytest.mark.parametrize(
    ("gpu_ms", "processor_ms", "wait_ms", "bound"),
    [
        (6.0, 3.0, 0.0, "neither"),
        (8.0, 3.0, 0.0, "GPU"),
        (3.0, 8.0, 0.0, "processor"),
        (8.0, 7.6, 0.0, "both"),
        (7.6, 8.0, 0.0, "both"),
        (8.0, 3.0, 0.7, "GPU"),
        (4.0, 3.0, 3.0, "read-backs"),
    ],
)
def test_the_longer_time_bounds_the_rate_unless_one_waits(
    gpu_ms: float, processor_ms: float, wait_ms: float, bound: str
) -> None:
    row = whole(ms_median=gpu_ms, processor_ms=processor_ms, row_ms=8.1, wait_ms=wait_ms)
    assert bound_by(row) == bound


def test_without_rows_nothing_is_said_of_bounds() -> None:
    assert bound_by(whole(processor_ms=3.0)) == ""
    assert bound_by(whole()) == ""


def test_a_rate_is_that_of_a_row_where_there_is_one() -> None:
    assert frames_per_s(whole()) == 200.0
    assert frames_per_s(whole(row_ms=4.0)) == 250.0
    assert frames_per_s(whole(ms_median=0.0)) is None
