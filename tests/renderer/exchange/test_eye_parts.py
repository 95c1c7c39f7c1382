"""The exported eye's surfaces: exact, joined at the limbus, with the maps' coordinates."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from renderer.exchange.drawn import tubes
from renderer.exchange.eye_parts import (
    cornea_and_sclera,
    iris_disc,
    iris_relief,
    revolved,
    stretched,
)
from renderer.exchange.meshes import Mesh, joined, write_ply
from renderer.eye.anatomy import APEX_MM, GLOBE_RADIUS_MM, IRIS_Z_MM, LIMBUS_RADIUS_MM, LIMBUS_Z_MM
from renderer.eye.optics import surface_height


def face_normals(mesh: Mesh) -> np.ndarray:
    a, b, c = (mesh.positions[mesh.triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def corner_normals(mesh: Mesh) -> np.ndarray:
    mean = mesh.normals[mesh.triangles].mean(axis=1)
    return mean / np.linalg.norm(mean, axis=1, keepdims=True)


def test_cornea_and_sclera_are_the_exact_surface_and_share_the_limbus() -> None:
    cornea, sclera = cornea_and_sclera(mirror=False)
    for mesh in (cornea, sclera):
        r = np.hypot(*mesh.positions[:, :2].T)
        front = (mesh.positions[:, 2] > 0) & (r < 11.0)
        np.testing.assert_allclose(mesh.positions[front, 2], surface_height(r[front])[0], atol=1e-4)
        assert ((face_normals(mesh) * corner_normals(mesh)).sum(axis=1) > 0.99).all()
    assert cornea.positions[:, 2].max() == pytest.approx(APEX_MM, abs=0.01)
    assert np.hypot(*cornea.positions[:, :2].T).max() == pytest.approx(LIMBUS_RADIUS_MM, abs=0.02)
    rim = {tuple(np.round(p, 9)) for p in cornea.positions[-256:]}
    assert rim == {tuple(np.round(p, 9)) for p in sclera.positions[:256]}
    assert np.linalg.norm(sclera.positions, axis=1).max() < GLOBE_RADIUS_MM + 0.2


def test_the_whites_map_looks_along_the_gaze_and_is_mirrored_for_the_right_eye() -> None:
    left, right = (cornea_and_sclera(mirror=mirror)[1] for mirror in (False, True))
    assert left.uv is not None
    assert right.uv is not None
    angle = np.arccos(left.positions[:, 2] / np.linalg.norm(left.positions, axis=1))
    reach = np.hypot(*(2 * left.uv - 1).T)
    inside = angle < math.radians(100)
    np.testing.assert_allclose(reach[inside], angle[inside] / math.radians(110), rtol=1e-6)
    assert (
        np.sign(left.uv[:, 0] - 0.5) == np.sign(np.round(left.positions[:, 0], 6))
    ).mean() > 0.99
    np.testing.assert_allclose(right.uv, [1, 0] + left.uv * [-1, 1], atol=1e-12)


def test_the_iris_lies_on_its_plane_with_the_pupils_hole_and_a_wall() -> None:
    iris = iris_disc(pupil_mm=5.0, mirror=False)
    r, z = np.hypot(*iris.positions[:, :2].T), iris.positions[:, 2]
    on_plane, behind = np.isclose(z, IRIS_Z_MM), z < IRIS_Z_MM - 0.1
    wall = ~on_plane & ~behind
    assert r[on_plane].min() == pytest.approx(2.5)
    assert z[wall] == pytest.approx(LIMBUS_Z_MM, abs=0.1)
    np.testing.assert_allclose(r[wall], LIMBUS_RADIUS_MM)
    assert r[behind].max() > 4.0  # hides what lies behind an 8 mm pupil
    assert iris.uv is not None
    np.testing.assert_array_equal(iris.uv[behind], 0.5)  # the maps' black
    assert ((face_normals(iris) * corner_normals(iris)).sum(axis=1) > 0.6).all()
    assert (face_normals(iris)[:, 2] > -1e-9).all()


def test_tissue_stretches_with_the_pupil_and_keeps_its_place_on_the_map() -> None:
    np.testing.assert_allclose(stretched(np.array([2.0, 5.85]), 3.0), [3.0, 5.85])
    narrow, wide = (iris_disc(pupil_mm=p, mirror=False) for p in (2.0, 7.0))
    np.testing.assert_array_equal(narrow.uv, wide.uv)
    assert narrow.uv is not None
    edge = np.hypot(*(2 * narrow.uv[0] - 1)) * 6.0
    assert edge == pytest.approx(2.0)


def tissue_of(iris: Mesh) -> np.ndarray:
    r, z = np.hypot(*iris.positions[:, :2].T), iris.positions[:, 2]
    return (r > 1.9) & (r < 5.8) & (z > IRIS_Z_MM - 0.25)


def test_relief_rises_around_the_iris_plane_where_the_map_says_so() -> None:
    n = 64
    ramp = np.broadcast_to(np.linspace(0.0, 0.4, n, dtype=np.float32)[None, :], (n, n))
    left, right = (
        iris_relief(ramp.astype(float), pupil_mm=4.0, mirror=mirror) for mirror in (False, True)
    )
    tissue = left.positions[tissue_of(left)]
    fitted = np.polyfit(tissue[:, 0], tissue[:, 2] - IRIS_Z_MM, 1)
    np.testing.assert_allclose(fitted, [0.4 / 12, 0.0], atol=2e-3)
    tissue = right.positions[tissue_of(right)]
    assert np.polyfit(tissue[:, 0], tissue[:, 2], 1)[0] == pytest.approx(-0.4 / 12, abs=2e-3)


def test_a_revolved_profile_is_closed_around_the_axis() -> None:
    points, triangles = revolved(np.array([[0.0, 1.0], [1.0, 0.5], [2.0, 0.0]]), 8)
    assert len(points) == 1 + 2 * 8
    assert len(triangles) == 8 + 2 * 8
    edges = np.sort(
        np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    )
    _, uses = np.unique(edges, axis=0, return_counts=True)
    assert (uses == 1).sum() == 8  # the outer rim alone
    assert (uses <= 2).all()


def test_a_hair_becomes_a_tube_around_its_middle_line() -> None:
    line = np.linspace([0.0, 0.0, 0.0], [0.0, 3.0, 4.0], 6)[None]
    hair = tubes(line, np.full((1, 6), 0.05), np.full((1, 6, 3), 0.2))
    axis = np.array([0.0, 0.6, 0.8])
    off = hair.positions - (hair.positions @ axis)[:, None] * axis
    distance = np.linalg.norm(off, axis=1).reshape(6, -1)
    np.testing.assert_allclose(distance[0], 0.05, rtol=1e-6)
    assert (np.diff(distance.mean(axis=1)) < 0).all()
    assert ((face_normals(hair) * corner_normals(hair)).sum(axis=1) > 0.7).all()
    np.testing.assert_allclose(np.abs(hair.normals @ axis), 0.0, atol=1e-9)


def test_a_ply_file_says_what_it_holds(tmp_path: Path) -> None:
    mesh = Mesh(
        np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]),
        np.tile([0.0, 0, 1], (3, 1)),
        np.array([[0, 1, 2]]),
        albedo=np.full((3, 3), 0.2158605),  # sRGB 128 of 255
    )
    write_ply(tmp_path / "x.ply", joined([mesh, mesh]), comment="a word")
    head, _, body = (tmp_path / "x.ply").read_bytes().partition(b"end_header\n")
    lines = head.decode().splitlines()
    assert lines[:4] == [
        *("ply", "format binary_little_endian 1.0", "comment a word", "element vertex 6")
    ]
    assert "property list uchar int vertex_indices" in lines
    assert len(body) == 6 * (9 * 4 + 3) + 2 * 13
    assert body[36:39] == bytes([128, 128, 128])
    assert np.frombuffer(body[-12:], "<i4").tolist() == [3, 4, 5]
