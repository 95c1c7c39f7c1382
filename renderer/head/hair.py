"""The main character's hair, combed back and tied: a cap for the mass, ribbons for its look.

Pure numpy, world space in mm. The cap is the scalp lifted by the hair's thickness; thousands of
narrow ribbons follow the comb over it and fray at the hairline.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from renderer.body.makehuman import Floats, Indices
from renderer.head.face_mesh import FaceMesh
from renderer.head.lashes import Strands

COLOUR: Final = (0.060, 0.033, 0.019)
KNOT_MM: Final = (0.0, 18.0, -205.0)  # where the comb gathers the hair
THICKNESS_MM: Final = 9.0
STRANDS: Final = 2600
WISPS: Final = 1200
POINTS: Final = 6
RIBBON_MM: Final = 1.9  # a ribbon stands for a lock of hairs; its shader draws strands on it
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
    """The mass under the ribbons: points (n, 3) mm, normals, triangles, comb direction (n, 3)."""

    points_mm: Floats
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
    points, normals = scalp.points_mm, scalp.normals
    above = inside_hairline(points)
    is_ear = _is_ear(points)
    lift = THICKNESS_MM * _ease((above - 2.0) / 38.0)
    chosen = (above[scalp.triangles] > -6.0).all(axis=1) & ~is_ear[scalp.triangles].any(axis=1)
    used, rows = np.unique(scalp.triangles[chosen], return_inverse=True)
    rows, above = rows.reshape(-1, 3), above[used]
    lifted = points[used] + normals[used] * (lift[used] - 0.4 * (above < 3.0))[:, None]
    return HairCap(
        lifted,
        normals[used],
        rows[(above[rows] > 0.0).all(axis=1)],
        rows[(above[rows] > -3.0).all(axis=1)],
        _comb(lifted, normals[used]),
    )


def _is_ear(points: Floats) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    x, y, z = np.abs(points[:, 0]), points[:, 1], points[:, 2]
    return np.asarray((x > 72.0) & (y < 5.0) & (y > -60.0) & (z > -101.0) & (z < -60.0))


def _ease(x: Floats) -> Floats:
    x = np.clip(x, 0.0, 1.0)
    return np.asarray(x * x * (3 - 2 * x))


def _comb(points: Floats, normals: Floats) -> Floats:
    """Return unit directions along the scalp towards the knot."""
    towards = np.asarray(KNOT_MM) - points
    # From the forehead hair runs up and back first, not straight through the head.
    towards[:, 1] += 1.1 * np.clip(points[:, 2] - AXIS_Z_MM, 0.0, None)
    along = towards - normals * (towards * normals).sum(axis=1, keepdims=True)
    return np.asarray(along / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9))


def grow_hair(cap: HairCap, rng: np.random.Generator) -> Strands:
    """Return ribbons over the cap and finer wisps along the hairline."""
    tree = _Surface(cap)
    groups = []
    for count, at_border, length_mm in ((STRANDS, False, 85.0), (WISPS, True, 40.0)):
        roots = _scatter_roots(cap, rng, count, only_border=at_border)
        groups.append(_comb_over(tree, roots, rng, length_mm=length_mm))
    (mass, depth), (wisps, shallow) = groups
    width = np.concatenate(
        [
            RIBBON_MM * rng.uniform(0.6, 1.3, len(mass)),
            rng.uniform(0.15, 0.6, len(wisps)),
        ]
    )
    points = np.concatenate([mass, wisps])
    # Hairs that lie deeper stand in the others' shade.
    tone = rng.uniform(0.6, 1.6, size=(len(points), 1))
    tone *= 0.35 + 0.65 * np.concatenate([depth, shallow])[:, None]
    warm = 1 + np.array([0.12, 0.0, -0.1]) * rng.normal(0, 1, size=(len(points), 1))
    return Strands(points, width, np.array(COLOUR) * tone * np.clip(warm, 0.6, 1.4))


def _scatter_roots(
    cap: HairCap, rng: np.random.Generator, count: int, *, only_border: bool
) -> Floats:
    """Return roots (count, 3) spread evenly over the cap, or along its lower border."""
    corners = cap.points_mm[cap.growth]
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    if only_border:
        areas = areas * (inside_hairline(corners.mean(axis=1)) < 8.0)
    chosen = rng.choice(len(areas), size=count, p=areas / areas.sum())
    u, v = rng.uniform(0, 1, (2, count))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    a, b, c = (corners[chosen, k] for k in range(3))
    return np.asarray(a + u[:, None] * (b - a) + v[:, None] * (c - a))


class _Surface:
    """Nearest points of the cap: height, normal and comb direction."""

    def __init__(self, cap: HairCap) -> None:
        self._cap = cap
        self._tree = cKDTree(cap.points_mm)

    def at(self, points: Floats) -> tuple[Floats, Floats, Floats]:
        """Return foot points, normals and comb directions (n, 3), blended from four neighbours."""
        distance, near = map(np.asarray, self._tree.query(points, k=4))
        weight = 1 / (distance + 0.5)
        weight /= weight.sum(axis=1, keepdims=True)
        normal = (self._cap.normals[near] * weight[..., None]).sum(axis=1)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        offset = ((self._cap.points_mm[near] - points[:, None]) * normal[:, None]).sum(axis=2)
        foot = points + normal * (offset * weight).sum(axis=1, keepdims=True)
        return foot, normal, (self._cap.comb[near] * weight[..., None]).sum(axis=1)


def _comb_over(
    surface: _Surface, roots: Floats, rng: np.random.Generator, *, length_mm: float
) -> tuple[Floats, Floats]:
    """Follow the comb over the cap: hairs (n, POINTS, 3) and how high each lies, 0 to 1."""
    count = len(roots)
    length = length_mm * rng.uniform(0.6, 1.25, count)
    high = rng.uniform(0, 1, count)
    lift = 0.7 + 1.0 * high
    sway = rng.normal(0, 0.10, count)
    place, points = roots.copy(), []
    for number in range(POINTS):
        foot, normal, comb = surface.at(place)
        s = number / (POINTS - 1)
        height = lift * np.sin(np.pi * np.clip(0.08 + 0.9 * s, 0, 1)) - 0.5 * (number == 0)
        points.append(foot + normal * height[:, None])
        side = np.cross(normal, comb)
        step = comb + side * (sway * np.sin(5 * s + 9 * sway))[:, None]
        place = foot + step * (length / (POINTS - 1))[:, None]
    return np.stack(points, axis=1), high
