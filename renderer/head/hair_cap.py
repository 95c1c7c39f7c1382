"""The mass under the main character's locks: the scalp, lifted by the hair's thickness.

It knows where hair grows and which way it is combed. Pure numpy, world space in mm.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.body.makehuman import Floats, Indices
from renderer.body.normals import vertex_normals
from renderer.head.face_mesh import FaceMesh
from renderer.textures.easing import ease

KNOT_MM: Final = (0.0, 18.0, -205.0)  # where the comb gathers the hair
THICKNESS_MM: Final = 9.0
SUNK_MM: Final = 1.5  # of the mass at the hairline, which only hairs draw
# The hairline as height in mm over the azimuth around the head (0 front, 180 back), face to nape.
HAIRLINE: Final = np.array(
    [
        (0.0, 79.0),
        (18.0, 78.0),
        (32.0, 71.0),
        (46.0, 56.0),
        (58.0, 38.0),
        (68.0, 22.0),
        (75.0, -2.0),
        (82.0, 4.0),
        (92.0, 9.0),
        (99.0, 5.0),
        (105.0, -14.0),
        (113.0, -40.0),
        (124.0, -58.0),
        (150.0, -66.0),
        (180.0, -70.0),
    ]
)
AXIS_Z_MM: Final = -82.0  # the head's vertical axis behind the eyes


@dataclass(frozen=True)
class HairCap:
    """The mass under the locks: points (n, 3) mm, normals, triangles, comb direction (n, 3).

    ``foot_mm`` (n, 3) is what locks lie on; before the hairline the mass itself is below the skin.
    """

    points_mm: Floats
    foot_mm: Floats
    normals: Floats
    triangles: Indices
    growth: Indices  # triangles that hair grows on; they reach over the hairline
    comb: Floats


def inside_hairline(points: Floats) -> Floats:
    """Return the height in mm above the hairline (n,): positive where hair grows."""
    azimuth = np.degrees(np.arctan2(np.abs(points[:, 0]), points[:, 2] - AXIS_Z_MM))
    return np.asarray(points[:, 1] - np.interp(azimuth, *HAIRLINE.T))


def hair_cap(face: FaceMesh) -> HairCap:
    """Return the cap that covers the scalp."""
    scalp = face.coarse
    above = inside_hairline(scalp.points_mm)
    is_ear = _is_ear(scalp.points_mm)
    near = (above[scalp.triangles] > -12.0).all(axis=1) & ~is_ear[scalp.triangles].any(axis=1)
    used, rows = np.unique(scalp.triangles[near], return_inverse=True)
    points, normals, rows = _refined(
        scalp.points_mm[used], scalp.normals[used], rows.reshape(-1, 3)
    )
    above = inside_hairline(points)
    lift = THICKNESS_MM * ease((above - 2.0) / 38.0)
    sunk = SUNK_MM * (1 - ease(above / 8.0))
    lifted, foot = (points + normals * height[:, None] for height in (lift - sunk, lift))
    normals = vertex_normals(lifted, rows)
    return HairCap(
        lifted,
        foot,
        normals,
        rows[(above[rows] > 1.0).all(axis=1)],
        rows[(above[rows] > -6.0).all(axis=1)],
        _comb(foot, normals),
    )


def _refined(points: Floats, normals: Floats, rows: Indices) -> tuple[Floats, Floats, Indices]:
    """Cut every triangle in four and round it off: Boubekeur and Alexa 2008, Phong tessellation."""
    edges = np.sort(rows[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    unique, number = np.unique(edges, axis=0, return_inverse=True)
    a, b = unique.T
    middle = (points[a] + points[b]) / 2
    for end in (a, b):
        out = ((middle - points[end]) * normals[end]).sum(axis=1, keepdims=True)
        middle = middle - 0.375 * out * normals[end]
    normal = normals[a] + normals[b]
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    ab, bc, ca = (number.reshape(-1, 3) + len(points)).T
    p, q, r = rows.T
    fourfold = [(p, ab, ca), (ab, q, bc), (ca, bc, r), (ab, bc, ca)]
    triangles = np.concatenate([np.stack(corners, axis=1) for corners in fourfold])
    return np.concatenate([points, middle]), np.concatenate([normals, normal]), triangles


def _is_ear(points: Floats) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    x, y, z = np.abs(points[:, 0]), points[:, 1], points[:, 2]
    return np.asarray((x > 72.0) & (y < 5.0) & (y > -60.0) & (z > -101.0) & (z < -60.0))


def _comb(points: Floats, normals: Floats) -> Floats:
    """Return unit directions along the scalp towards the knot."""
    towards = np.asarray(KNOT_MM) - points
    # From the forehead hair runs up and back first, not straight through the head.
    towards[:, 1] += 1.1 * np.clip(points[:, 2] - AXIS_Z_MM, 0.0, None)
    along = towards - normals * (towards * normals).sum(axis=1, keepdims=True)
    return np.asarray(along / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9))
