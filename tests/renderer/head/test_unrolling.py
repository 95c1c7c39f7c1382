"""Unrolling the face: what can be laid out flat without stretch is, the rest nearly."""

from __future__ import annotations

import numpy as np

from renderer.body.subdivide import triangles_of
from renderer.head.face_mesh import face_mesh
from renderer.head.skin_part import SkinPart
from renderer.head.unrolling import flatten, unroll_mm


def stretches(points: np.ndarray, triangles: np.ndarray, flat: np.ndarray) -> np.ndarray:
    """Return for each triangle its largest and smallest stretch (m, 2)."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    along = (b - a) / np.linalg.norm(b - a, axis=1, keepdims=True)
    normal = np.cross(b - a, c - a)
    upright = np.cross(normal / np.linalg.norm(normal, axis=1, keepdims=True), along)
    edges = np.stack([b - a, c - a], axis=-1)
    in_space = np.stack([(along[..., None] * edges).sum(1), (upright[..., None] * edges).sum(1)], 1)
    p, q, r = (flat[triangles[:, k]] for k in range(3))
    in_tile = np.stack([q - p, r - p], axis=-1)
    return np.asarray(np.linalg.svd(in_tile @ np.linalg.inv(in_space), compute_uv=False))


def test_a_bent_sheet_is_laid_out_without_stretch() -> None:
    turn, height = np.meshgrid(np.linspace(-1, 1, 33), np.linspace(-8, 8, 17), indexing="ij")
    points = np.stack([10 * np.sin(turn), height, 10 * np.cos(turn)], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(32), np.arange(16), indexing="ij")
    corner = (i * 17 + j).ravel()
    triangles = triangles_of(np.stack([corner, corner + 17, corner + 18, corner + 1], axis=1))
    flat = flatten(points, triangles, start=points[:, :2])
    np.testing.assert_allclose(stretches(points, triangles, flat), 1.0, atol=0.01)
    assert np.ptp(flat[:, 0]) > 19.5  # 20 mm of arc, less what the chords cut off


def faces_camera(part: SkinPart) -> np.ndarray:
    centre = part.points_mm[part.triangles].mean(axis=1)
    facing = part.normals[part.triangles].mean(axis=1)[:, 2]
    seen: np.ndarray = (facing > 0.1) & (centre[:, 2] > -40.0) & (np.abs(centre[:, 1]) < 50.0)
    return seen


def test_pores_stay_round_all_over_the_face() -> None:
    part = face_mesh().fine
    seen = faces_camera(part)
    triangles = part.triangles[seen]
    stretch = stretches(part.points_mm, triangles, unroll_mm(part.points_mm))
    a, b, c = (part.points_mm[triangles[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    oval = stretch[:, 0] / stretch[:, 1] > 1.6
    assert area[oval].sum() < 0.03 * area.sum()
    assert 0.85 < np.median(stretch) < 1.1


def test_face_and_lids_share_their_places_in_the_tile() -> None:
    """Points that lie next to each other on two meshes lie next to each other in the tile."""
    face = face_mesh()
    for patch in face.patches:
        outer = patch.points_mm[patch.lid < 0.01]
        outer = outer[np.abs(outer[:, 2]) < 60.0][:200]
        for point in outer[::20]:
            near = np.argmin(np.linalg.norm(face.fine.points_mm - point, axis=1))
            beside = face.fine.points_mm[near]
            apart = np.linalg.norm(beside - point)
            first, second = unroll_mm(np.stack([point, beside]))
            assert np.linalg.norm(first - second) < 2.0 * apart + 0.1
