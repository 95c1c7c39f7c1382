"""Fewer triangles for a mesh while it keeps its shape: half-edge collapse by quadric error.

Vertices are dropped, never moved or made, so shapes and skin weights of the full mesh still fit
what remains: one decimation serves every phenotype. Pure numpy.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.body.living_mesh import Indices, LivingMesh

Floats = npt.NDArray[np.float64]

_BORDER_WEIGHT: Final = 30.0  # open rims (neck, wrists) keep their line
_FLIP_COSINE: Final = 0.2  # a triangle may not turn further than this while a vertex goes


@dataclass
class _Surface:
    """The mesh while it shrinks."""

    vertices: Floats
    mesh: LivingMesh
    quadrics: Floats


def decimate(
    vertices: Floats, triangles: Indices, *, target: int, importance: Floats | None = None
) -> Indices:
    """Return at most about ``target`` triangles (m, 3) over a part of the same vertices.

    ``importance`` (n,) multiplies the error around each vertex: 4 keeps twice the detail of 1.
    Stops early where every further step would fold the surface (Garland and Heckbert 1997).
    """
    weight = np.ones(len(vertices)) if importance is None else importance
    surface = _surface(vertices, triangles, weight)
    edges = {tuple(sorted(edge)) for row in triangles.tolist() for edge in _edges(row)}
    heap = [step for edge in sorted(edges) for step in _steps(surface, *edge)]
    heapq.heapify(heap)
    version = [0] * len(vertices)
    living = len(triangles)
    while living > target and heap:
        _, gone, kept, then = heapq.heappop(heap)
        if then != version[gone] + version[kept] or not _may_collapse(surface, gone, kept):
            continue
        living -= surface.mesh.merge(gone, kept)
        surface.quadrics[kept] += surface.quadrics[gone]
        version[gone] = -(1 << 40)
        version[kept] += 1
        for other in sorted(surface.mesh.neighbours(kept)):
            for cost, start, end, _ in _steps(surface, kept, other):
                heapq.heappush(heap, (cost, start, end, version[kept] + version[other]))
    return surface.mesh.left()


def _surface(vertices: Floats, triangles: Indices, weight: Floats) -> _Surface:
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    double_area = np.linalg.norm(normal, axis=1)
    normal /= np.maximum(double_area, 1e-12)[:, None]
    planes = np.concatenate([normal, -(normal * a).sum(axis=1, keepdims=True)], axis=1)
    quadric = planes[:, :, None] * planes[:, None, :] * double_area[:, None, None]
    quadrics = np.zeros((len(vertices), 4, 4))
    for k in range(3):
        np.add.at(quadrics, triangles[:, k], quadric)
    _guard_borders(quadrics, vertices, triangles=triangles, normal=normal)
    return _Surface(
        vertices, LivingMesh(triangles, len(vertices)), quadrics * weight[:, None, None]
    )


def _guard_borders(
    quadrics: Floats, vertices: Floats, *, triangles: Indices, normal: Floats
) -> None:
    """Add to open edges a plane that stands upright on them."""
    owners: dict[tuple[int, ...], list[int]] = {}
    for row, corners in enumerate(triangles.tolist()):
        for edge in _edges(corners):
            owners.setdefault(tuple(sorted(edge)), []).append(row)
    for (start, end), rows in owners.items():
        if len(rows) > 1:
            continue
        along = vertices[end] - vertices[start]
        upright = np.cross(along, normal[rows[0]])
        length = float(np.linalg.norm(upright))
        if length == 0:
            continue
        plane = np.append(upright / length, -(upright / length) @ vertices[start])
        guard = np.outer(plane, plane) * length**2 * _BORDER_WEIGHT
        quadrics[start] += guard
        quadrics[end] += guard


def _edges(corners: list[int]) -> list[tuple[int, int]]:
    a, b, c = corners
    return [(a, b), (b, c), (c, a)]


def _steps(surface: _Surface, a: int, b: int) -> list[tuple[float, int, int, int]]:
    """Return both ways to collapse an edge as (cost, gone, kept, version 0)."""
    joint = surface.quadrics[a] + surface.quadrics[b]
    steps = []
    for gone, kept in ((a, b), (b, a)):
        place = np.append(surface.vertices[kept], 1.0)
        # A little length keeps flat regions from collapsing into slivers in index order.
        length = float(np.sum((surface.vertices[a] - surface.vertices[b]) ** 2))
        steps.append((float(place @ joint @ place) + 1e-3 * length, gone, kept, 0))
    return steps


def _may_collapse(surface: _Surface, gone: int, kept: int) -> bool:
    """Whether the surface stays a surface and no triangle folds over."""
    mesh = surface.mesh
    shared = mesh.around[gone] & mesh.around[kept]
    common = mesh.neighbours(gone) & mesh.neighbours(kept)
    if not shared or len(common) != len(shared):
        return False
    for row in mesh.around[gone] - shared:
        corners = mesh.triangles[row]
        before = _normal(surface.vertices, corners)
        after = _normal(surface.vertices, [kept if k == gone else k for k in corners])
        size = np.linalg.norm(before) * np.linalg.norm(after)
        if size == 0 or before @ after < _FLIP_COSINE * size:
            return False
    return True


def _normal(vertices: Floats, corners: list[int]) -> Floats:
    a, b, c = vertices[corners]
    u, v = b - a, c - a
    # Written out: numpy's cross is slow for single vectors.
    return np.array(
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    )
