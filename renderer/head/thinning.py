"""Fewer triangles where fewer show the same: half-edge collapse by quadrics over all that shades.

Vertices are dropped, never moved or made, so light is still baked at all of them. A vertex is a
point in as many dimensions as it has properties, each in units of the error that may be seen
(Garland and Heckbert 1998, "Simplifying surfaces with color and texture"). Pure numpy.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.body.living_mesh import LivingMesh
from renderer.body.makehuman import Floats, Indices
from renderer.body.normals import unit

FLIP_COSINE: Final = 0.3  # a triangle may not turn further than this while a vertex goes
LEAST_HEIGHT: Final = 0.1  # of a triangle over its longest edge: slivers shade badly
MOST_ERROR: Final = 1.0  # mean square over the surface that a vertex stands for, in units
CHUNK: Final = 2000  # triangles whose quadrics are added at once: bounds the memory


def thin(
    properties: Floats, triangles: Indices, *, shapes: list[Floats], longest_mm: float
) -> Indices:
    """Return triangles (m, 3) over a part of the same vertices; open edges stay as they are.

    ``properties`` (n, k) are in units of the error that may be seen. ``shapes`` are the points
    (n, 3) in mm in each pose that the mesh takes: in the first one nothing folds over, and no edge
    that comes about is longer than ``longest_mm``.
    """
    surface = _Surface(properties, triangles, shapes[0])
    heap: list[tuple[float, int, int, int, int]] = []
    for vertex in range(len(properties)):
        later = sorted(other for other in surface.neighbours(vertex) if other > vertex)
        surface.push_steps(heap, vertex, later)
    while heap:
        _, gone, kept, *then = heapq.heappop(heap)
        now = [surface.version[gone], surface.version[kept]]
        if then == now and surface.may_collapse(gone, kept, longest_mm=longest_mm):
            surface.collapse(gone, kept)
            surface.push_steps(heap, kept, sorted(surface.neighbours(kept)))
    return surface.left()


@dataclass
class _Quadrics:
    """Weighted sums of squared distances from triangles' planes: v A v + 2 b v + c, and weights."""

    square: Floats
    linear: Floats
    constant: Floats
    weight: Floats

    def of(self, rows: list[int]) -> _Quadrics:
        """Return those of some vertices."""
        return _Quadrics(
            self.square[rows], self.linear[rows], self.constant[rows], self.weight[rows]
        )

    def add(self, kept: int, gone: int) -> None:
        """Let one vertex stand for another's triangles too."""
        for values in (self.square, self.linear, self.constant, self.weight):
            values[kept] += values[gone]


class _Surface(LivingMesh):
    """The mesh while it shrinks, with what each vertex looks like."""

    def __init__(self, properties: Floats, triangles: Indices, points_mm: Floats) -> None:
        super().__init__(triangles, len(properties))
        self.properties = np.asarray(properties, dtype=float)
        self.points_mm = points_mm
        self.version = [0] * len(properties)
        edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        edges, owners = np.unique(edges, axis=0, return_counts=True)
        self._stays = np.zeros(len(properties), dtype=bool)
        self._stays[edges[owners != 2].ravel()] = True
        self._quadrics = _quadrics(self.properties, triangles, points_mm)

    def push_steps(
        self, heap: list[tuple[float, int, int, int, int]], vertex: int, others: list[int]
    ) -> None:
        """Push every collapse along edges from a vertex that errs little enough."""
        if not others:
            return
        own, theirs = self._quadrics.of([vertex]), self._quadrics.of(others)
        square, linear = own.square + theirs.square, own.linear + theirs.linear
        constant, weight = own.constant + theirs.constant, own.weight + theirs.weight
        for gone_is_other in (False, True):
            place = self.properties[[vertex] * len(others) if gone_is_other else others]
            error = ((square @ place[..., None])[..., 0] + 2 * linear) * place
            error = (error.sum(axis=1) + constant) / weight
            for other, cost in zip(others, error.tolist(), strict=True):
                gone, kept = (other, vertex) if gone_is_other else (vertex, other)
                if cost < MOST_ERROR and not self._stays[gone]:
                    step = (cost, gone, kept, self.version[gone], self.version[kept])
                    heapq.heappush(heap, step)

    def may_collapse(self, gone: int, kept: int, *, longest_mm: float) -> bool:
        """Whether the surface stays a surface, without folds, slivers or too long edges."""
        shared = self.around[gone] & self.around[kept]
        beside = self.neighbours(gone)
        if len(shared) != 2 or len(beside & self.neighbours(kept)) != 2:
            return False
        away = self.points_mm[sorted(beside - {kept})] - self.points_mm[kept]
        if (away * away).sum(axis=1).max() > longest_mm**2:
            return False
        before = np.array([self.triangles[row] for row in self.around[gone] - shared])
        old, _ = _faces(self.points_mm, before)
        new, longest = _faces(self.points_mm, np.where(before == gone, kept, before))
        size = np.linalg.norm(new, axis=1)
        turned = (old * new).sum(axis=1) < FLIP_COSINE * np.linalg.norm(old, axis=1) * size
        return not (turned | (size < LEAST_HEIGHT * longest**2)).any()

    def collapse(self, gone: int, kept: int) -> None:
        """Carry out a step."""
        self.merge(gone, kept)
        self._quadrics.add(kept, gone)
        self.version[gone] = -1
        self.version[kept] += 1


def _faces(points: Floats, triangles: Indices) -> tuple[Floats, Floats]:
    """Return normals (m, 3) twice as long as areas, and longest edges (m,)."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    edges = np.stack([b - a, c - a, c - b])
    return np.cross(edges[0], edges[1]), np.sqrt((edges**2).sum(axis=2).max(axis=0))


def _quadrics(properties: Floats, triangles: Indices, points_mm: Floats) -> _Quadrics:
    """Return the vertices' quadrics, weighted by the area of their triangles."""
    n, k = properties.shape
    sums = _Quadrics(np.zeros((n, k, k)), np.zeros((n, k)), np.zeros(n), np.zeros(n))
    for start in range(0, len(triangles), CHUNK):
        rows = triangles[start : start + CHUNK]
        p, q, r = (properties[rows[:, corner]] for corner in range(3))
        first = unit(q - p)
        second = unit(r - p - ((r - p) * first).sum(axis=1, keepdims=True) * first)
        along = [(p * axis).sum(axis=1, keepdims=True) for axis in (first, second)]
        area = np.linalg.norm(_faces(points_mm, rows)[0], axis=1) / 2 + 1e-9
        square = (
            np.eye(k) - first[:, :, None] * first[:, None] - second[:, :, None] * second[:, None]
        )
        linear = along[0] * first + along[1] * second - p
        constant = (p * p).sum(axis=1) - along[0][:, 0] ** 2 - along[1][:, 0] ** 2
        for corner in range(3):
            np.add.at(sums.square, rows[:, corner], square * area[:, None, None])
            np.add.at(sums.linear, rows[:, corner], linear * area[:, None])
            np.add.at(sums.constant, rows[:, corner], constant * area)
            np.add.at(sums.weight, rows[:, corner], area)
    return sums
