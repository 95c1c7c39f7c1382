"""Where FLIP is averaged: at the pixels in which the LoDs differ, in both eyes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.encoding.comparison import Comparison, flip_numbers, signal_numbers
from renderer.eye_rectangles import frame_rectangles

LOW, ULTRA = Detail.uniform("low"), Detail.uniform("ultra")
SPEC = ClipSpec(left=LOW, right=ULTRA, width=256, height=144, duration_s=0.2)


def test_the_frames_of_flip_are_the_middles_of_a_clips_thirds() -> None:
    whole = ClipSpec(left=LOW, right=ULTRA)
    assert flip_numbers(whole) == [25, 75, 125]
    assert flip_numbers(ClipSpec(left=LOW, right=ULTRA, duration_s=0.04)) == [0]
    assert signal_numbers(whole) == list(range(0, 150, 12))


def test_errors_count_only_where_the_lods_differ(monkeypatch: pytest.MonkeyPatch) -> None:
    raw = np.full((144, 256, 3), 120, np.uint8)
    other, decoded = raw.copy(), raw.copy()
    differs = np.zeros((144, 256), bool)
    for rows, columns in frame_rectangles(SPEC, 0):  # equal in all frames of a macroscopic clip
        middle = (columns.start + columns.stop) // 2
        differs[rows, middle : columns.stop] = True
        decoded[rows, columns.start : middle - 20] = 200  # wrong, but alike at every LoD
    other[differs] = 180
    comparison = Comparison(SPEC, with_flip=True)
    for number in range(SPEC.frame_count):
        comparison.take(number, raw)
    comparison.take_other(iter([other] * len(comparison.other_lods)))
    monkeypatch.setattr(
        "renderer.encoding.comparison.decode",
        lambda _path, numbers, **_size: dict.fromkeys(numbers, decoded),
    )
    found = comparison.compare(Path("clip.mp4"))
    assert found.flip_rectangle is not None
    assert min(found.flip_rectangle) > 0.1
    assert found.flip_encoding == pytest.approx([0.0, 0.0], abs=0.01)
    assert found.flip_lods is not None
    assert min(found.flip_lods) > 0.2
    assert found.flip_share == pytest.approx(0.0, abs=0.05)


def test_nothing_is_drawn_again_for_eyes_of_one_lod() -> None:
    assert Comparison(SPEC, with_flip=True).other_lods == flip_numbers(SPEC)
    assert Comparison(SPEC, with_flip=False).other_lods == []
    alike = ClipSpec(left=LOW, right=LOW)
    assert Comparison(alike, with_flip=True).other_lods == []
