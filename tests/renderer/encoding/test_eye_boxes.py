"""The encoder's boxes cover what is seen of the eyes in every frame and stay on the picture."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.clip_values import DISTANCES
from renderer.detail import Detail
from renderer.encoding.eye_boxes import STRETCHES, eye_boxes
from renderer.encoding.regions import Box, Stretch
from renderer.eye_rectangles import frame_rectangles

LOW = Detail.uniform("low")
STEPS, LID_STEPS = 20.0, 3.0


@functools.cache
def stretches_of(spec: ClipSpec) -> list[Stretch]:
    return eye_boxes(spec, eye_steps=STEPS, lid_steps=LID_STEPS)


def covered(spec: ClipSpec, boxes: list[Box]) -> np.ndarray:
    """Return where some boxes lie, (height, width)."""
    found = np.zeros((spec.height, spec.width), bool)
    for box in boxes:
        assert 0 <= box.x < box.x + box.width <= spec.width
        assert 0 <= box.y < box.y + box.height <= spec.height
        found[box.y : box.y + box.height, box.x : box.x + box.width] = True
    return found


def boxes_of(spec: ClipSpec, number: int, *, steps: float = STEPS) -> list[Box]:
    """Return the boxes of a frame that are so much finer."""
    last = [stretch for stretch in stretches_of(spec) if stretch.first <= number][-1]
    return [box for box in last.boxes if box.steps == steps]


@pytest.mark.parametrize("distance", DISTANCES)
def test_the_boxes_hold_both_pupils_in_every_frame(distance: str) -> None:
    spec = ClipSpec(left=LOW, right=LOW, distance=distance, fps=6)
    for number in range(spec.frame_count):
        opening = covered(spec, boxes_of(spec, number))
        rectangles = covered(spec, boxes_of(spec, number, steps=LID_STEPS))
        for rows, columns in frame_rectangles(spec, number):
            assert rectangles[rows, columns].all()
            y, x = (rows.start + rows.stop) // 2, (columns.start + columns.stop) // 2
            assert opening[y, x], (number, distance)


def test_each_stretch_of_a_clip_has_its_own_boxes() -> None:
    spec = ClipSpec(left=LOW, right=LOW, distance="near")
    stretches = stretches_of(spec)
    assert [stretch.first for stretch in stretches] == list(range(0, 150, 10))
    assert len({tuple(stretch.boxes) for stretch in stretches}) == len(stretches) == STRETCHES
    short = stretches_of(replace(spec, duration_s=0.1))
    assert [stretch.first for stretch in short] == [0, 1, 2]


def test_the_opening_comes_before_the_lids_which_it_lies_in() -> None:
    for stretch in stretches_of(ClipSpec(left=LOW, right=LOW, fps=6)):
        assert [box.steps for box in stretch.boxes] == sorted(
            (box.steps for box in stretch.boxes), reverse=True
        )


def test_lids_and_lashes_are_left_out() -> None:
    spec = ClipSpec(left=LOW, right=LOW, distance="macroscopic")
    shares = [
        covered(spec, boxes_of(spec, number))[rows, columns].mean()
        for number in (0, 75, 149)
        for rows, columns in frame_rectangles(spec, number)
    ]
    assert 0.3 < min(shares) < max(shares) < 0.7


def test_shut_lids_leave_next_to_nothing_open() -> None:
    spec = ClipSpec(left=LOW, right=LOW, distance="macroscopic")
    shut = covered(spec, boxes_of(replace(spec, blink=1.0), 75))
    assert shut.sum() < 0.35 * covered(spec, boxes_of(spec, 75)).sum()


@pytest.mark.parametrize("size", [(1280, 720), (3840, 2160), (7680, 4320)])
def test_a_command_line_can_take_the_boxes_of_any_size(size: tuple[int, int]) -> None:
    spec = ClipSpec(left=LOW, right=LOW).resized(*size)
    stretches = stretches_of(spec)
    covered(spec, [box for stretch in stretches for box in stretch.boxes])
    assert sum(len(stretch.boxes) for stretch in stretches) < 1200
