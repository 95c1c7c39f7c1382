"""Normals of meshes: a closed form, weights by area, and points of no triangle."""

from __future__ import annotations

import numpy as np

from renderer.body.normals import unit, vertex_normals


def test_a_corner_of_a_box_weighs_its_facets_by_area() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 2], [5, 5, 5]], dtype=float)
    triangles = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1]])
    normals = vertex_normals(points, triangles)
    np.testing.assert_allclose(normals[0], np.array([2, 2, 1]) / 3)
    np.testing.assert_allclose(np.linalg.norm(normals[:4], axis=1), 1.0)
    np.testing.assert_array_equal(normals[4], 0.0)  # in no triangle


def test_what_has_no_length_stays_so() -> None:
    np.testing.assert_array_equal(unit(np.zeros((2, 3))), np.zeros((2, 3)))
    np.testing.assert_allclose(unit(np.array([[[3.0, 4.0]]])), [[[0.6, 0.8]]])
