"""Fewer triangles, the same surface: what thinning keeps, and what it may not do."""

import numpy as np
import numpy.typing as npt
import pytest
from scipy.spatial import cKDTree

from renderer.body.subdivide import triangles_of
from renderer.head.face_mesh import face_mesh
from renderer.head.lid_fit import ALONG, AROUND, grid_quads
from renderer.head.surfaces import SKIN_KINDS, skin_kinds
from renderer.head.thinned import distant_patch, near_corners, near_patch
from renderer.head.thinning import thin

SIDE = 12
Array = npt.NDArray[np.float64]


def plane() -> tuple[Array, npt.NDArray[np.int64]]:
    """Return a flat square grid, (n, 3) points a millimetre apart, and its triangles."""
    x, y = np.meshgrid(np.arange(SIDE), np.arange(SIDE), indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(SIDE * SIDE)]).astype(float)
    first = (np.arange(SIDE - 1)[:, None] * SIDE + np.arange(SIDE - 1)).ravel()
    quads = np.stack([first, first + SIDE, first + SIDE + 1, first + 1], axis=1)
    return points, triangles_of(quads)


def areas(points: Array, triangles: npt.NDArray[np.int64]) -> Array:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.asarray(np.cross(b - a, c - a)[:, 2] / 2)


def test_a_plane_needs_little_more_than_its_border() -> None:
    points, triangles = plane()
    thinned = thin(points, triangles, shapes=[points], longest_mm=100.0)
    assert len(thinned) < len(triangles) / 3
    assert areas(points, thinned).min() > 0.0
    assert areas(points, thinned).sum() == pytest.approx((SIDE - 1) ** 2)
    border = (points[:, :2] == 0).any(axis=1) | (points[:, :2] == SIDE - 1).any(axis=1)
    assert set(np.flatnonzero(border)) <= set(thinned.ravel())


def test_a_step_of_colour_stays_where_it_is() -> None:
    points, triangles = plane()
    dark = np.where(points[:, :1] >= 6, 50.0, 0.0)
    thinned = thin(np.hstack([points, dark]), triangles, shapes=[points], longest_mm=100.0)
    x = points[thinned, 0]
    assert not ((x.min(axis=1) < 5) & (x.max(axis=1) > 5)).any()
    assert not ((x.min(axis=1) < 6) & (x.max(axis=1) > 6)).any()
    assert len(thinned) < len(triangles) / 2


def test_no_edge_comes_about_that_is_too_long() -> None:
    points, triangles = plane()
    thinned = thin(points, triangles, shapes=[points], longest_mm=2.5)
    edges = points[thinned] - points[np.roll(thinned, 1, axis=1)]
    assert 1.5 < np.linalg.norm(edges, axis=2).max() <= 2.5


def test_what_another_pose_folds_is_not_bridged() -> None:
    points, triangles = plane()
    folded = points * [1, 1, 0] + [0, 0, 1] * np.abs(points[:, :1] - 5.0)
    flat = thin(points, triangles, shapes=[points, folded], longest_mm=100.0)
    both = thin(np.hstack([points, 10 * folded]), triangles, shapes=[points], longest_mm=100.0)
    spans = [
        (points[rows, 0].min(axis=1) < 5) & (points[rows, 0].max(axis=1) > 5)
        for rows in (flat, both)
    ]
    assert spans[0].any()
    assert not spans[1].any()


@pytest.mark.parametrize("eye", [0, 1])
def test_lids_keep_their_shape_with_a_third_of_the_triangles(eye: int) -> None:
    patch, triangles = face_mesh().patches[eye], near_patch(eye)
    assert len(triangles) < 2 * len(grid_quads(AROUND, ALONG)) / 3
    corners = patch.points_mm[triangles]
    shares = np.random.Generator(np.random.PCG64(5)).dirichlet(np.ones(3), size=12)
    drawn = np.einsum("sc,mck->smk", shares, corners).reshape(-1, 3)
    away, _ = cKDTree(np.concatenate([drawn, patch.points_mm[np.unique(triangles)]])).query(
        patch.points_mm
    )
    # Between samples of the triangles lie at most some tenths; a dent would be a millimetre.
    assert np.quantile(away, 0.99) < 0.35
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = (normals * patch.normals[triangles].mean(axis=1)).sum(axis=1)
    assert (facing > 0).mean() > 0.985


def test_both_eyes_and_all_distances_face_outwards() -> None:
    for choose in (near_patch, near_corners, distant_patch):
        np.testing.assert_array_equal(choose(0), choose(1)[:, ::-1])


def test_only_what_tears_wet_is_shaded_as_wet() -> None:
    face = face_mesh()
    assert not skin_kinds(face.fine, face.fine.triangles).any()
    triangles = near_patch(1)
    kinds = skin_kinds(face.patches[1], triangles)
    wet = (face.patches[1].wet[triangles] > 0).any(axis=1)
    np.testing.assert_array_equal(kinds == 2, wet)
    assert all((kinds == kind).mean() > 0.02 for kind in range(len(SKIN_KINDS)))
    assert (skin_kinds(face.corners[0], near_corners(0)) == 2).all()
