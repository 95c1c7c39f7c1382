"""Where skin lies in a flat tile: the face unrolled as rigidly as its shape allows.

Pure numpy and scipy, world space in mm. What unrolls is the face as a field of heights z(x, y);
beyond it the head is wound around a cylinder.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage, sparse
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

from renderer.body.makehuman import Floats, Indices
from renderer.cache import cached_array
from renderer.head.face_mesh import face_mesh

CYLINDER_MM: Final = 95.0  # radius of what the head is wound around
FACE_X_MM: Final = (-64, 64)
FACE_Y_MM: Final = (-75, 56)
SMOOTH_MM: Final = 1.2
ROUNDS: Final = 25
CELL_MM: Final = 2.0
DEEP_MM: Final = 11.0  # behind what lies in front within 2 to 4 mm
HOLD: Final = 1e-6  # of the place of a whole that only its shape decides


def unroll_mm(points_mm: Floats) -> Floats:
    """Return places (n, 2) in mm of points (n, 3) on the skin, wound around the head."""
    x, y, z = points_mm.T
    at = np.array([y - FACE_Y_MM[0], x - FACE_X_MM[0]])
    moved = cached_array("the face unrolled", _moves)
    across, up = (ndimage.map_coordinates(moved[k], at, order=1, mode="nearest") for k in (0, 1))
    wound = CYLINDER_MM * np.arctan2(x, z + CYLINDER_MM) + across
    is_ear = (np.abs(x) > 71.0) & (z < -60.0) & (np.abs(y + 15.0) < 50.0)
    return np.column_stack([np.where(is_ear, z, wound), y + up])


def _moves() -> npt.NDArray[np.generic]:
    """Return by how many mm to move what a cylinder would give: (2, y, x), across and up.

    A grid of 1 mm over FACE_Y_MM and FACE_X_MM.
    """
    points = _face_grid()
    rows, columns = points.shape[:2]
    wound = CYLINDER_MM * np.arctan2(points[..., 0], points[..., 2] + CYLINDER_MM)
    start = np.stack([wound, points[..., 1]], axis=-1).reshape(-1, 2)
    number = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (
        part.ravel()
        for part in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1])
    )
    triangles = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])
    flat = flatten(points.reshape(-1, 3), triangles, start=start)
    return (flat - start).T.reshape(2, rows, columns)


def flatten(points_mm: Floats, triangles: Indices, *, start: Floats) -> Floats:
    """Lay a mesh out flat, (n, 2), so that each triangle is turned rather than stretched.

    As rigid as possible: Liu et al. 2008, "A local/global approach to mesh parameterization".
    ``start`` (n, 2) is a first layout; it also says where the whole lies.
    """
    gradient, area = _gradients(points_mm, triangles)
    weight = sparse.diags_array(np.concatenate([area, area]))
    hold = HOLD * sparse.eye_array(len(points_mm))
    solver = splu(sparse.csc_array(gradient.T @ weight @ gradient + hold))
    flat = start
    for _ in range(ROUNDS):
        jacobian = np.asarray(gradient @ flat).reshape(2, len(triangles), 2).transpose(1, 2, 0)
        left, _, right = np.linalg.svd(jacobian)
        turn = left @ right
        wanted = turn.transpose(2, 0, 1).reshape(2 * len(triangles), 2)
        flat = solver.solve(np.asarray(gradient.T @ (weight @ wanted)) + HOLD * start)
    return np.asarray(flat)


def _gradients(points: Floats, triangles: Indices) -> tuple[sparse.csr_array, Floats]:
    """Return the operator (2 m, n) from values at points to gradients in triangles, and areas.

    Each triangle has axes of its own: its first edge and what is upright to it in its plane.
    """
    a, b, c = (points[triangles[:, k]] for k in range(3))
    along = (b - a) / np.linalg.norm(b - a, axis=1, keepdims=True)
    normal = np.cross(b - a, c - a)
    area = np.linalg.norm(normal, axis=1) / 2
    upright = np.cross(normal / (2 * area[:, None]), along)
    count = np.arange(len(triangles))
    rows, columns, entries = [], [], []
    for k, opposite in enumerate((c - b, a - c, b - a)):
        # The hat function of a corner rises against its opposite edge, turned by a quarter.
        for axis, share in ((0, -(opposite * upright).sum(1)), (1, (opposite * along).sum(1))):
            rows.append(count + axis * len(triangles))
            columns.append(triangles[:, k])
            entries.append(share / (2 * area))
    shape = (2 * len(triangles), len(points))
    places = (np.concatenate(rows), np.concatenate(columns))
    operator = sparse.coo_array((np.concatenate(entries), places), shape=shape)
    return sparse.csr_array(operator), area


def _face_grid() -> Floats:
    """Return the face's points (y, x, 3) in mm, lids and all, smoothed."""
    face = face_mesh()
    x = np.arange(FACE_X_MM[0], FACE_X_MM[1] + 1.0)
    y = np.arange(FACE_Y_MM[0], FACE_Y_MM[1] + 1.0)
    grid = np.stack(np.meshgrid(x, y), axis=-1)
    parts = [face.fine, face.coarse, *face.patches]
    front = np.concatenate([part.points_mm[part.normals[:, 2] > 0.05] for part in parts])
    front = _outermost(front[front[:, 2] > -60.0])
    distance, near = map(np.asarray, cKDTree(front[:, :2]).query(grid, k=6))
    share = 1 / (distance + 0.3) ** 2
    depth = (front[near, 2] * share).sum(axis=-1) / share.sum(axis=-1)
    depth = ndimage.gaussian_filter(depth, SMOOTH_MM, mode="nearest")
    return np.concatenate([grid, depth[..., None]], axis=-1)


def _outermost(points: Floats) -> Floats:
    """Drop points (n, 3) that lie deep behind others: the insides of nose and mouth."""
    cell = np.floor(points[:, :2] / CELL_MM).astype(int)
    cell -= cell.min(axis=0)
    front = np.full(cell.max(axis=0) + 1, -np.inf)
    np.maximum.at(front, (cell[:, 0], cell[:, 1]), points[:, 2])
    nearby = ndimage.maximum_filter(front, size=3)
    return np.asarray(points[points[:, 2] > nearby[cell[:, 0], cell[:, 1]] - DEEP_MM])
