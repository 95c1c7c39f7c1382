"""Eyebrows: where they grow, which way, how thick."""

from __future__ import annotations

import numpy as np
import pytest

from renderer.head.brows import BROW, COUNT, grow_brow, stubble
from renderer.head.face_mesh import face_mesh
from renderer.head.strand_group import Strands


@pytest.fixture(scope="module")
def brow() -> Strands:
    return grow_brow(face_mesh().sockets[1], np.random.Generator(np.random.PCG64(3)))


def test_the_brow_lies_above_the_eye_close_to_the_skin(brow: Strands) -> None:
    flat = brow.points_mm.reshape(-1, 3)
    assert flat[:, 1].min() > 7.0
    height = flat[:, 2] - face_mesh().sockets[1].height(flat[:, :2])
    assert height.max() < 1.2
    assert np.median(height) > 0.1


def test_hairs_rise_beside_the_nose_lie_along_the_body_and_fall_at_the_tail(brow: Strands) -> None:
    points = brow.points_mm[:COUNT]
    x, way = points[:, 0, 0], points[:, -1] - points[:, 0]
    angle = np.degrees(np.arctan2(way[:, 1], way[:, 0]))
    assert np.median(angle[x < -14]) > 55
    assert 5 < np.median(angle[(x > -4) & (x < 8)]) < 40
    assert np.median(angle[x > 18]) < -15


def test_the_brow_is_densest_in_its_middle_and_its_tail_thins_out(brow: Strands) -> None:
    x = brow.points_mm[:COUNT, 0, 0]
    per_mm = np.histogram(x, bins=[-18, -15, -8, 8, 18, 24, 29])[0] / [3, 7, 16, 10, 6, 5]
    assert per_mm[2] > per_mm[3] > per_mm[4] > per_mm[5]
    assert per_mm[2] > per_mm[0]


def test_hairs_at_the_outline_are_thinner_and_down_is_finest(brow: Strands) -> None:
    root = brow.points_mm[:COUNT, 0]
    middle, half = (np.interp(root[:, 0], BROW[:, 0], BROW[:, k]) for k in (1, 2))
    beyond = np.abs(root[:, 1] - middle) / half
    width = brow.width_mm[:COUNT]
    assert width[beyond > 0.9].mean() < 0.85 * width[beyond < 0.4].mean()
    assert brow.width_mm[COUNT:].max() < width.min()


def test_stubble_darkens_only_skin_under_the_brow() -> None:
    x = np.array([0.0, 0.0, 0.0, 28.0, -40.0])
    y = np.array([22.4, 30.0, 10.0, 17.4, 18.0])
    share = stubble(x, y)
    assert share[0] > 0.2
    assert share[1] < 0.01
    assert share[2] < 0.01
    assert share[3] < 0.1  # the tail is no black line
    assert share[4] == 0.0
