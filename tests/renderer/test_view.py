"""Cameras as matrices: what they show where, and parts of their pictures."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from renderer.view import View, cropped, look_at, perspective

FOV_DEG, ASPECT = 12.0, 16 / 9
POSITION, TARGET = np.array([300.0, 100.0, 900.0]), np.array([20.0, -10.0, 5.0])
VIEW = View(
    (0, 0, 1920, 1080),
    look_at(POSITION, TARGET),
    perspective(FOV_DEG, ASPECT, 100.0, 60000.0),
    POSITION,
    (0, 1),
)


def shown(view: View, point_mm: np.ndarray) -> np.ndarray:
    """Return where a point lies in pixels from the view's lower left."""
    clip = view.projection @ view.view_matrix @ np.append(point_mm, 1.0)
    return np.asarray((clip[:2] / clip[3] + 1.0) / 2.0 * view.rectangle[2:])


def test_a_camera_looks_at_its_target_upright() -> None:
    assert shown(VIEW, TARGET) == pytest.approx([960.0, 540.0], abs=1e-2)
    above = shown(VIEW, TARGET + [0.0, 5.0, 0.0])
    assert above[0] == pytest.approx(960.0, abs=1e-2)
    assert above[1] > 540.0
    turn = VIEW.view_matrix[:3, :3]
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-6)


def test_the_field_of_view_fills_the_height() -> None:
    away = 900.0
    half = away * math.tan(math.radians(FOV_DEG) / 2)
    ahead = replace(VIEW, view_matrix=look_at(np.array([0.0, 0.0, away]), np.zeros(3)))
    assert shown(ahead, np.array([0.0, half, 0.0]))[1] == pytest.approx(1080.0, abs=0.01)
    assert shown(ahead, np.array([half * ASPECT, 0.0, 0.0]))[0] == pytest.approx(1920.0, abs=0.01)


def test_a_part_of_a_view_shows_the_same_at_the_same_size() -> None:
    part = cropped(VIEW, (300, 400, 600, 200))
    assert part.rectangle == (0, 0, 600, 200)
    for point in (TARGET, TARGET + [3.0, -2.0, 11.0]):
        assert shown(part, point) == pytest.approx(shown(VIEW, point) - [300, 400], abs=1e-2)


def test_what_programs_know_of_a_view_cannot_change() -> None:
    for array in VIEW.uniforms.values():
        with pytest.raises(ValueError, match="read-only"):
            np.asarray(array)[...] = 0.0
