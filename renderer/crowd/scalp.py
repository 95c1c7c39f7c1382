"""Where hair grows: places on the base mesh's scalp, which the same weights carry to every build.

A place is found by its direction from the middle of the head, as the angle from the crown and the
turn around it. Pure numpy; millimetres of the base mesh, +z forwards.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from renderer.body.makehuman import Floats, Indices, base_mesh
from renderer.body.normals import unit
from renderer.crowd.pieces import group_triangles, quad_centres

MIDDLE_MM: Final = (0.0, 745.0, 45.0)
_CROWN_BACK_DEG: Final = 20.0  # where hair whirls: behind the top of the head
_LOWEST_MM: Final = 560.0  # of what belongs to head and neck
_WIDEST_MM: Final = 125.0
_FIRST_DEG: Final = 30.0  # from the crown: no hairline comes so near
_LAST_DEG: Final = 150.0
_STEPS: Final = 49
_NEAREST: Final = 32  # triangles around a direction, among which the ray's own is
# Height of the hairline over depth: nape, behind and above the ear, temple, brow.
_HAIRLINE: Final = (
    (-60.0, -8.0, 6.0, 18.0, 34.0, 60.0, 88.0, 96.0, 120.0, 145.0),
    (664.0, 668.0, 690.0, 738.0, 746.0, 742.0, 746.0, 776.0, 796.0, 801.0),
)


@dataclass(frozen=True)
class Places:
    """Places on a mesh: corners (k, 3) of the triangles they lie in, and the corners' weights."""

    corners: Indices
    weights: Floats

    def of(self, values: Floats) -> Floats:
        """Return what lies there of values (n, c) per vertex: (k, c)."""
        return np.asarray(np.einsum("kc,kcd->kd", self.weights, values[self.corners]))


def head_triangles() -> Indices:
    """Return the triangles of head and neck."""
    centre = quad_centres("body")
    is_head = (centre[:, 1] > _LOWEST_MM) & (np.abs(centre[:, 0]) < _WIDEST_MM)
    return np.asarray(group_triangles("body")[is_head])


def directions(polar: Floats, turn: Floats) -> Floats:
    """Return unit vectors (..., 3): radians from the crown, and around it from the brow on."""
    back = np.radians(_CROWN_BACK_DEG)
    crown = np.array([0.0, np.cos(back), -np.sin(back)])
    brow = np.array([0.0, np.sin(back), np.cos(back)])
    side = np.array([1.0, 0.0, 0.0])
    around = np.cos(turn)[..., None] * brow + np.sin(turn)[..., None] * side
    return np.asarray(np.cos(polar)[..., None] * crown + np.sin(polar)[..., None] * around)


def places(towards: Floats) -> Places:
    """Return the places on the head where rays from its middle come out first, along (k, 3)."""
    vertices, triangles = base_mesh().vertices_mm, head_triangles()
    middle = np.array(MIDDLE_MM)
    _, near = cKDTree(unit(vertices[triangles].mean(axis=1) - middle)).query(towards, k=_NEAREST)
    candidates = triangles[near]
    way, weights = hits(vertices[candidates], middle, towards)
    rows, nearest = np.arange(len(towards)), way.argmin(axis=1)
    return Places(candidates[rows, nearest], weights[rows, nearest])


def hits(corners: Floats, origins: Floats, rays: Floats) -> tuple[Floats, Floats]:
    """Return how far rays (k, 3) go to triangles that they leave through, and where.

    Each meets its own triangles, ``corners`` (k, m, 3, 3); ``origins`` (3,) or (k, 3). Ways (k, m),
    infinite where there is no such hit, and the weights of the corners (k, m, 3). Moeller and
    Trumbore 1997, "Fast, minimum storage ray-triangle intersection".
    """
    a, b, c = (corners[:, :, corner] for corner in range(3))
    ray = rays[:, None]
    p = np.cross(ray, c - a)
    det = ((b - a) * p).sum(axis=2)
    inverse = 1 / np.where(np.abs(det) < 1e-9, np.inf, det)
    off = np.broadcast_to(origins, rays.shape)[:, None] - a
    v = (off * p).sum(axis=2) * inverse
    q = np.cross(off, b - a)
    w = (ray * q).sum(axis=2) * inverse
    way = ((c - a) * q).sum(axis=2) * inverse
    leaves = (ray * np.cross(b - a, c - a)).sum(axis=2) > 0
    is_hit = (v >= -1e-9) & (w >= -1e-9) & (v + w <= 1 + 1e-9) & (way > 0) & leaves
    return np.where(is_hit, way, np.inf), np.stack([1 - v - w, v, w], axis=2)


@functools.cache
def hairline(turns: tuple[float, ...]) -> Floats:
    """Return how far from the crown hair grows, in radians, at turns around it (k,)."""
    turn = np.array(turns)
    polar = np.radians(np.linspace(_FIRST_DEG, _LAST_DEG, _STEPS))
    towards = directions(*np.meshgrid(polar, turn))
    found = places(towards.reshape(-1, 3)).of(base_mesh().vertices_mm)
    above = (found[:, 1] - np.interp(found[:, 2], *_HAIRLINE)).reshape(len(turn), -1)
    last = np.argmax(above < 0, axis=1)
    last = np.maximum(last, 1)
    rows = np.arange(len(turn))
    high, low = above[rows, last - 1], above[rows, last]
    share = np.clip(high / np.maximum(high - low, 1e-9), 0.0, 1.0)
    return np.asarray(polar[last - 1] + share * (polar[last] - polar[last - 1]))
