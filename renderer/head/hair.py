"""The main character's hair, combed back and tied: ribbons over a cap.

Thousands of locks follow the comb, densest where they root along the hairline. Single hairs and
short new ones blur the line itself. Pure numpy, world space in mm.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from renderer.body.makehuman import Floats
from renderer.head.hair_cap import HairCap, inside_hairline
from renderer.head.strand_group import Strands, joined

COLOUR: Final = (0.060, 0.033, 0.019)
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
