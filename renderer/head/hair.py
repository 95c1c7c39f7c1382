"""The main character's hair, combed back and tied: a cap for the mass, ribbons for its look.

Pure numpy, world space in mm. The cap is the scalp lifted by the hair's thickness; thousands of
locks follow the comb over it, densest where they root along the hairline. Single hairs and short
new ones blur the line itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from renderer.body.makehuman import Floats, Indices
from renderer.body.normals import vertex_normals
from renderer.head.face_mesh import FaceMesh
from renderer.head.strand_group import Strands, joined
from renderer.textures.easing import ease

COLOUR: Final = (0.060, 0.033, 0.019)
KNOT_MM: Final = (0.0, 18.0, -205.0)  # where the comb gathers the hair
THICKNESS_MM: Final = 9.0
SUNK_MM: Final = 1.5  # of the mass at the hairline, which only hairs draw
POINTS: Final = 8


@dataclass(frozen=True)
class Layer:
    """Locks of one kind: how many, how long and wide in mm, where they root.

    ``border_mm`` is how fast their roots thin out away from the hairline; ``below_mm`` how far they
    may root before it; ``stray`` how much their direction strays from the comb, in radians.
    """

    count: int
    length_mm: float
    width_mm: tuple[float, float]
    border_mm: float
    below_mm: float
    stray: float
    lift_mm: float


LAYERS: Final = (
    Layer(2300, 88.0, (0.9, 1.9), 14.0, -1.0, 0.05, 0.6),
    Layer(1600, 46.0, (0.25, 0.7), 4.0, 2.0, 0.12, 0.6),
    Layer(800, 15.0, (0.05, 0.09), 2.5, 4.5, 0.45, 0.9),  # just grown
)
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


def grow_hair(cap: HairCap, rng: np.random.Generator) -> Strands:
    """Return locks over the cap, finer ones along the hairline, and short new hairs before it."""
    surface = _Surface(cap)
    groups = []
    for layer in LAYERS:
        roots = _scatter_roots(cap, rng, layer)
        points, high = _comb_over(surface, roots, rng, layer=layer)
        width = rng.uniform(*layer.width_mm, layer.count)
        # Hairs that lie deeper stand in the others' shade.
        tone = rng.uniform(0.6, 1.6, layer.count) * (0.35 + 0.65 * high)
        warm = 1 + np.array([0.12, 0.0, -0.1]) * rng.normal(0, 1, size=(layer.count, 1))
        colour = np.array(COLOUR) * tone[:, None] * np.clip(warm, 0.6, 1.4)
        # They are drawn in this order: what lies on top comes last.
        order = np.argsort(high, kind="stable")
        groups.append(Strands(points[order], width[order], colour[order]))
    return joined(groups)


def _scatter_roots(cap: HairCap, rng: np.random.Generator, layer: Layer) -> Floats:
    """Return roots (count, 3) of a layer: everywhere a few, most along the hairline."""
    corners = cap.foot_mm[cap.growth]
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    above = inside_hairline(corners.mean(axis=1))
    inner = 0.16 if layer.border_mm > 10.0 else 0.0
    dense = (inner + np.exp(-np.maximum(above, 0.0) / layer.border_mm)) * (above > -layer.below_mm)
    share = areas * dense
    chosen = rng.choice(len(areas), size=layer.count, p=share / share.sum())
    u, v = rng.uniform(0, 1, (2, layer.count))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    a, b, c = (corners[chosen, k] for k in range(3))
    return np.asarray(a + u[:, None] * (b - a) + v[:, None] * (c - a))


class _Surface:
    """Nearest points of the cap: height, normal and comb direction."""

    def __init__(self, cap: HairCap) -> None:
        self._cap = cap
        self._tree = cKDTree(cap.foot_mm)

    def at(self, points: Floats) -> tuple[Floats, Floats, Floats]:
        """Return foot points, normals and comb directions (n, 3), smooth over some 5 mm."""
        distance, near = map(np.asarray, self._tree.query(points, k=12))
        weight = np.exp(-((distance / 4.5) ** 2)) + 1e-6
        weight /= weight.sum(axis=1, keepdims=True)
        normal = (self._cap.normals[near] * weight[..., None]).sum(axis=1)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        offset = ((self._cap.foot_mm[near] - points[:, None]) * normal[:, None]).sum(axis=2)
        foot = points + normal * (offset * weight).sum(axis=1, keepdims=True)
        return foot, normal, (self._cap.comb[near] * weight[..., None]).sum(axis=1)


def _comb_over(
    surface: _Surface, roots: Floats, rng: np.random.Generator, *, layer: Layer
) -> tuple[Floats, Floats]:
    """Follow the comb over the cap: hairs (n, POINTS, 3) and how high each lies, 0 to 1."""
    length = layer.length_mm * rng.uniform(0.6, 1.25, layer.count)
    high = rng.uniform(0, 1, layer.count)
    lift = 1.2 + layer.lift_mm * high
    sway = rng.normal(0, 0.06, layer.count)
    stray = rng.normal(0, layer.stray, layer.count)
    place, points = roots.copy(), []
    for number in range(POINTS):
        foot, normal, comb = surface.at(place)
        s = number / (POINTS - 1)
        height = lift * min(7.0 * s, 1.0) - 0.3 * (number == 0)
        points.append(foot + normal * np.reshape(height, (-1, 1)))
        side = np.cross(normal, comb)
        turn = sway * np.sin(5 * s + 9 * sway) + stray * (1 - s)
        place = foot + (comb + side * turn[:, None]) * (length / (POINTS - 1))[:, None]
    way = np.stack(points, axis=1)
    way[:, 1:-1] = (way[:, :-2] + 2 * way[:, 1:-1] + way[:, 2:]) / 4
    return way, high
