"""Where the encoder spends its bits: what the lids leave open, as boxes for every part of a clip.

Boxes cannot move, so a clip is cut into stretches of few frames: the boxes of each cover the
opening in all of them. Around them lids and lashes are a little finer than skin.
"""

from __future__ import annotations

import itertools
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.camera import views
from renderer.clip import ClipSpec
from renderer.encoding.regions import Box, Stretch
from renderer.eye.place import eye_centre_mm
from renderer.eye_rectangles import Rectangle, frame_rectangles
from renderer.head.lid_pose import lid_poses
from renderer.head.lid_rims import rim_curves
from renderer.view import View

Mask = npt.NDArray[np.bool_]
Points = npt.NDArray[np.float64]

MACROBLOCK_PX: Final = 16  # H.264 changes the quantiser from one to the next
MOST_BLOCKS: Final = 120  # across a picture; a command line takes no more boxes
STRETCHES: Final = 15  # 8 degrees each of an orbit of 120
MARGIN_MM: Final = 0.5  # around the opening: its rims' shade is part of the eye
_RIM_SAMPLES: Final = 129  # 10 pixels apart at macroscopic: no macroblock is missed
_ACROSS: Final = np.linspace(0.0, 1.0, 49)  # from the lower rim to the upper one


def eye_boxes(spec: ClipSpec, *, eye_steps: float, lid_steps: float) -> list[Stretch]:
    """Return boxes for every stretch of a clip, in order.

    The openings are ``eye_steps`` finer than the picture, the rectangles around ``lid_steps``.
    """
    length = -(-spec.frame_count // STRETCHES)
    parts = [
        range(first, min(first + length, spec.frame_count))
        for first in range(0, spec.frame_count, length)
    ]
    return [
        Stretch(
            part[0],
            (*_openings(spec, part, steps=eye_steps), *_lids(spec, part, steps=lid_steps)),
        )
        for part in parts
    ]


def _openings(spec: ClipSpec, part: range, *, steps: float) -> list[Box]:
    block = MACROBLOCK_PX * -(-spec.width // (MACROBLOCK_PX * MOST_BLOCKS))
    shape = (-(-spec.height // block), -(-spec.width // block))
    boxes = []
    for eye, rims in enumerate(_rims_mm(spec)):
        covered = np.zeros(shape, bool)
        for number in _samples(part):
            _cover(covered, _opening_px(spec, number, eye, rims) / block)
        boxes += [
            Box(x * block, y * block, wide * block, tall * block, steps)
            for x, y, wide, tall in _columns(covered)
        ]
    return [_on_picture(box, spec) for box in boxes]


def _lids(spec: ClipSpec, part: range, *, steps: float) -> list[Box]:
    """Return a box for each eye's rectangles in all frames of a part."""
    every = [frame_rectangles(spec, number) for number in _samples(part)]
    return [_around([pair[eye] for pair in every], steps=steps) for eye in (0, 1)]


def _around(rectangles: list[Rectangle], *, steps: float) -> Box:
    top, left = (min(pair[axis].start for pair in rectangles) for axis in (0, 1))
    bottom, right = (max(pair[axis].stop for pair in rectangles) for axis in (0, 1))
    return Box(left, top, right - left, bottom - top, steps)


def _samples(part: range) -> set[int]:
    """Return the frames that stand for a part: the camera goes one way between them."""
    return {part[0], part[len(part) // 2], part[-1]}


def _on_picture(box: Box, spec: ClipSpec) -> Box:
    width, height = min(box.width, spec.width - box.x), min(box.height, spec.height - box.y)
    return box._replace(width=width, height=height)


def _rims_mm(spec: ClipSpec) -> list[tuple[Points, Points]]:
    """Return the upper and the lower rim of both eyes in world space, a margin apart from it."""
    margin = np.array([0.0, MARGIN_MM, 0.0])
    rims = []
    for eye, pose in enumerate(lid_poses(spec)):
        to_world = [2.0 * eye - 1.0, 1.0, 1.0]  # patch space has the temple at +x
        upper, lower = (
            curve * to_world + eye_centre_mm(eye)
            for curve in rim_curves(pose, samples=_RIM_SAMPLES)
        )
        rims.append((upper + margin, lower - margin))
    return rims


def _opening_px(spec: ClipSpec, number: int, eye: int, rims: tuple[Points, Points]) -> Points:
    """Return points (n, 2) all over one eye's opening: columns and rows of a frame in pixels."""
    upper, lower = rims
    shown = views(spec, spec.azimuth_deg(number), distance_px=spec.distance_px(number))
    view = next(view for view in shown if eye in view.eyes)
    above, below = _on_frame(upper, view, spec.height), _on_frame(lower, view, spec.height)
    between = _ACROSS[:, None, None] * (above - below) + below
    return np.asarray(between.reshape(-1, 2))


def _on_frame(points_mm: Points, view: View, lines: int) -> Points:
    x0, y0, width, height = view.rectangle
    whole = np.column_stack([points_mm, np.ones(len(points_mm))])
    clip = whole @ (view.projection @ view.view_matrix).T
    x, y = (clip[:, :2] / clip[:, 3:] + 1).T / 2
    inside = np.clip(x, 0, 1) * (width - 1)
    return np.column_stack([x0 + inside, lines - 1 - (y0 + y * height)])


def _cover(covered: Mask, points: Points) -> None:
    rows, columns = covered.shape
    blocks = np.floor(points).astype(int)
    covered[np.clip(blocks[:, 1], 0, rows - 1), np.clip(blocks[:, 0], 0, columns - 1)] = True


def _columns(covered: Mask) -> list[tuple[int, int, int, int]]:
    """Return x, y, width and height of each run of columns that are covered alike."""
    columns = [int(column) for column in np.flatnonzero(covered.any(axis=0))]
    spans = [np.flatnonzero(covered[:, column])[[0, -1]].tolist() for column in columns]
    found = []
    for (top, bottom), run in itertools.groupby(zip(spans, columns, strict=True), lambda x: x[0]):
        across = [column for _, column in run]
        found.append((across[0], top, len(across), bottom + 1 - top))
    return found
