"""Catmull-Clark subdivision of quad meshes. Pure numpy."""

from __future__ import annotations

import numpy as np

from renderer.body.makehuman import Floats, Indices


def subdivide(vertices: Floats, quads: Indices, *, levels: int = 1) -> tuple[Floats, Indices]:
    """Return the mesh after ``levels`` steps: vertices (n, k), quads (4 f, 4).

    All k columns are smoothed alike, so colours or coordinates may ride along. Boundary edges keep
    their curve (cubic B-spline rule). Source: Catmull and Clark 1978.
    """
    for _ in range(levels):
        vertices, quads = _step(vertices, quads)
    return vertices, quads


def _step(vertices: Floats, quads: Indices) -> tuple[Floats, Indices]:
    count, faces = len(vertices), len(quads)
    starts, ends = quads, np.roll(quads, -1, axis=1)
    pairs = np.sort(np.stack([starts, ends], axis=-1).reshape(-1, 2), axis=1)
    edges, edge_of = np.unique(pairs, axis=0, return_inverse=True)
    edge_of = edge_of.reshape(faces, 4)
    face_points = vertices[quads].mean(axis=1)
    middles = vertices[edges].mean(axis=1)
    uses = np.bincount(edge_of.ravel(), minlength=len(edges))
    beside = _scatter(edge_of, np.repeat(face_points[:, None], 4, axis=1), len(edges))
    inner = uses == 2
    edge_points = np.where(inner[:, None], (2 * middles + beside) / 4, middles)
    corners = _move_corners(vertices, quads, face_points, edges=edges, middles=middles, inner=inner)
    offsets = count + np.arange(faces)
    first = count + faces
    children = [
        np.stack(
            [quads[:, i], first + edge_of[:, i], offsets, first + edge_of[:, i - 1]],
            axis=1,
        )
        for i in range(4)
    ]
    return np.concatenate([corners, face_points, edge_points]), np.stack(children, 1).reshape(-1, 4)


def _move_corners(
    vertices: Floats,
    quads: Indices,
    face_points: Floats,
    *,
    edges: Indices,
    middles: Floats,
    inner: np.ndarray[tuple[int], np.dtype[np.bool_]],
) -> Floats:
    count = len(vertices)
    valence = np.bincount(quads.ravel(), minlength=count)[:, None]
    faces = _scatter(quads, np.repeat(face_points[:, None], 4, axis=1), count)
    spokes = _scatter(edges, np.repeat(middles[:, None], 2, axis=1), count)
    spoke_count = np.bincount(edges.ravel(), minlength=count)[:, None]
    n = np.maximum(valence, 1)
    smooth = (faces / n + 2 * spokes / np.maximum(spoke_count, 1) + (n - 3) * vertices) / n
    border = edges[~inner]
    along = _scatter(border, np.repeat(middles[~inner][:, None], 2, axis=1), count)
    is_border = np.bincount(border.ravel(), minlength=count)[:, None] == 2
    curve = (along + 2 * vertices) / 4
    return np.where(is_border, curve, np.where(valence > 0, smooth, vertices))


def _scatter(targets: Indices, values: Floats, size: int) -> Floats:
    """Sum ``values`` (..., k) into ``size`` rows chosen by ``targets`` (...)."""
    flat, rows = values.reshape(-1, values.shape[-1]), targets.ravel()
    columns = [np.bincount(rows, weights=column, minlength=size) for column in flat.T]
    return np.stack(columns, axis=1)


def triangles_of(quads: Indices) -> Indices:
    """Split quads (m, 4) into triangles (2 m, 3)."""
    return quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
