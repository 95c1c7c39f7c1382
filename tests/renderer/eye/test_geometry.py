from __future__ import annotations

import math

import numpy as np
import pytest

from renderer.eye.anatomy import GLOBE_RADIUS_MM, LIMBUS_RADIUS_MM, PROFILE_END_MM
from renderer.eye.geometry import BACK_ANGLE_DEG, eye_mesh, ring_polar
from renderer.eye.optics import surface_height

SIZES = (150, 500, 2000, 8000)


@pytest.mark.parametrize("triangles", SIZES)
def test_meshes_have_about_the_tables_triangles(triangles: int) -> None:
    assert len(eye_mesh(triangles).triangles) == pytest.approx(triangles, rel=0.05)


@pytest.mark.parametrize("triangles", SIZES)
def test_vertices_lie_exactly_on_the_profile(triangles: int) -> None:
    p = eye_mesh(triangles).positions
    r = np.hypot(p[:, 0], p[:, 1])
    front = (p[:, 2] > 0) & (r < PROFILE_END_MM)
    np.testing.assert_allclose(p[front, 2], surface_height(r[front])[0], atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(p[~front], axis=1), GLOBE_RADIUS_MM, atol=1e-6)


@pytest.mark.parametrize("triangles", SIZES)
def test_triangles_face_outwards_and_close_the_globe(triangles: int) -> None:
    mesh = eye_mesh(triangles)
    corners = mesh.positions[mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.sum(normals * corners.mean(axis=1), axis=1) > 0).all()
    edges = np.sort(mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, counts = np.unique(edges, axis=0, return_counts=True)
    open_edges = int((counts == 1).sum())
    assert set(counts) == {1, 2}
    assert open_edges == (len(mesh.positions) - 1) // len(ring_polar_of(triangles))
    lowest = np.degrees(np.arccos(mesh.positions[:, 2].min() / GLOBE_RADIUS_MM))
    assert lowest == pytest.approx(BACK_ANGLE_DEG, abs=0.01)


def ring_polar_of(triangles: int) -> np.ndarray:
    return ring_polar({150: 7, 500: 11, 2000: 21, 8000: 45}[triangles])


@pytest.mark.parametrize("triangles", [500, 2000, 8000])
def test_rings_are_densest_at_the_limbus(triangles: int) -> None:
    rings = ring_polar_of(triangles)
    steps = np.hypot(*np.diff(rings, axis=0).T)
    narrowest = int(np.argmin(steps))
    assert abs(rings[narrowest, 0] - LIMBUS_RADIUS_MM) < 0.7
    assert np.min(np.abs(rings[:, 0] - LIMBUS_RADIUS_MM)) < 0.01


def test_finer_meshes_lie_closer_to_the_surface() -> None:
    errors = []
    for triangles in SIZES:
        mesh = eye_mesh(triangles)
        centres = mesh.positions[mesh.triangles].mean(axis=1)
        r = np.hypot(centres[:, 0], centres[:, 1])
        front = (centres[:, 2] > 0) & (r < PROFILE_END_MM)
        errors.append(np.abs(surface_height(r[front])[0] - centres[front, 2]).max())
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < 0.02


def test_facets_have_normals_of_their_own() -> None:
    mesh = eye_mesh(150, facets=True)
    normals = mesh.normals.reshape(-1, 3, 3)
    assert len(mesh.positions) == 3 * len(mesh.triangles)
    np.testing.assert_array_equal(normals[:, 0], normals[:, 2])
    edge = mesh.positions[1::3] - mesh.positions[::3]
    np.testing.assert_allclose(np.sum(edge * normals[:, 0], axis=1), 0.0, atol=1e-12)


def test_vertex_normals_are_the_surfaces() -> None:
    mesh = eye_mesh(500)
    apex = int(np.argmax(mesh.positions[:, 2]))
    np.testing.assert_allclose(mesh.normals[apex], [0, 0, 1], atol=1e-9)
    assert math.isclose(float(np.linalg.norm(mesh.normals, axis=1).min()), 1.0, rel_tol=1e-12)


def test_other_sizes_are_refused() -> None:
    with pytest.raises(ValueError, match=r"no eye mesh of 151 triangles; choose one of 150, 500"):
        eye_mesh(151)
