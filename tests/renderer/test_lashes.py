"""Lashes and brows: numbers, places, directions, reproducibility."""

from __future__ import annotations

import numpy as np

from renderer.head import lashes
from renderer.head.face_mesh import face_mesh
from renderer.head.lid_rims import globe_height
from renderer.head.strands import ribbons


def rng() -> np.random.Generator:
    return np.random.Generator(np.random.PCG64(3))


def grown() -> lashes.Strands:
    return lashes.grow_lashes(face_mesh().lids[1], rng())


def test_the_number_of_lashes_is_human() -> None:
    strands = grown()
    assert len(strands.points_mm) == lashes.UPPER_COUNT + lashes.LOWER_COUNT
    assert 120 < lashes.UPPER_COUNT < 200
    assert 60 < lashes.LOWER_COUNT < 100


def test_lashes_root_on_their_lid_and_curl_away_from_the_pupil() -> None:
    points = grown().points_mm
    upper, lower = points[: lashes.UPPER_COUNT], points[lashes.UPPER_COUNT :]
    assert upper[:, 0, 1].min() > lower[:, 0, 1].max() - 3.0
    assert (upper[:, -1, 1] - upper[:, 0, 1]).mean() > 2.5
    assert (lower[:, -1, 1] - lower[:, 0, 1]).mean() < -1.0
    for row in (upper, lower):
        assert (row[:, -1, 2] - row[:, 0, 2]).mean() > 1.0


def test_no_lash_enters_the_globe() -> None:
    points = grown().points_mm.reshape(-1, 3)
    r = np.hypot(points[:, 0], points[:, 1])
    over = points[r < 11, 2] - globe_height(r[r < 11])
    assert over.min() > 0.0


def test_outer_lashes_point_to_the_temple_and_inner_ones_to_the_nose() -> None:
    points = grown().points_mm[: lashes.UPPER_COUNT]
    way = points[:, -1, 0] - points[:, 0, 0]
    assert way[points[:, 0, 0] > 6].mean() > 1.0
    assert way[points[:, 0, 0] < -6].mean() < -0.5


def test_the_same_seed_grows_the_same_hairs() -> None:
    np.testing.assert_array_equal(grown().points_mm, grown().points_mm)


def test_the_brow_lies_above_the_eye_close_to_the_skin() -> None:
    socket = face_mesh().sockets[1]
    strands = lashes.grow_brow(socket, rng())
    flat = strands.points_mm.reshape(-1, 3)
    assert flat[:, 1].min() > 8.0
    height = flat[:, 2] - socket.height(flat[:, :2])
    assert height.max() < 2.0
    assert np.median(height) > 0.1


def test_ribbons_have_two_vertices_a_point_and_name_their_side() -> None:
    strands = lashes.Strands(
        np.array([[[0.0, 0, 0], [0, 1, 0], [0, 2, 0]]]), np.array([0.1]), np.ones((1, 3))
    )
    rows, triangles = ribbons(strands, rng())
    assert rows.shape == (6, 13)
    assert sorted(rows[:, 6]) == [-1, -1, -1, 1, 1, 1]
    np.testing.assert_allclose(rows[:, 7], 0.05)
    assert triangles.shape == (4, 3)
    assert triangles.max() == 5
