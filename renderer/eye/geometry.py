"""The eye's meshes: rings around the gaze axis, densest at the limbus. Pure numpy.

Every vertex lies exactly on the surface of ``optics``. The globe is closed as far as any camera can
see between the lids; the hole behind it is inside the head.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.eye.anatomy import GLOBE_RADIUS_MM, LIMBUS_RADIUS_MM, PROFILE_END_MM
from renderer.eye.optics import surface_height, surface_normal, unit

Array = npt.NDArray[np.float64]

BACK_ANGLE_DEG: Final = 130.0  # polar angle from the gaze axis where the mesh ends

# Rings and segments per number of triangles in the table: segments * (2 * rings - 1) triangles.
_GRIDS: Final = {150: (7, 12), 500: (11, 24), 2000: (21, 48), 8000: (45, 90)}


@dataclass(frozen=True)
class Mesh:
    """Triangles: positions and normals (n_vertices, 3) in mm, indices (n_triangles, 3)."""

    positions: Array
    normals: Array
    triangles: npt.NDArray[np.int32]


def eye_mesh(triangles: int, *, facets: bool = False) -> Mesh:
    """Build the globe with about ``triangles`` triangles: 150, 500, 2000 or 8000.

    With ``facets`` each triangle has vertices and a normal of its own. Raises ValueError for a
    number that has no mesh.
    """
    if triangles not in _GRIDS:
        accepted = ", ".join(map(str, _GRIDS))
        raise ValueError(f"no eye mesh of {triangles} triangles; choose one of {accepted}")
    rings, segments = _GRIDS[triangles]
    positions = _vertices(ring_polar(rings), segments)
    mesh = Mesh(positions, surface_normal(positions), _indices(rings, segments))
    return _split_facets(mesh) if facets else mesh


def ring_polar(rings: int) -> Array:
    """Return each ring's (r, z) in mm, apex left out: denser at the limbus and on the cornea.

    Ring spacing follows the inverse of a density over arc length that peaks at the limbus, where
    the surface bends most; one ring sits on the limbus itself.
    """
    profile = _profile()
    lengths = np.hypot(*np.diff(profile, axis=0).T)
    arc = np.concatenate([[0.0], np.cumsum(lengths)])
    limbus = float(
        np.interp(LIMBUS_RADIUS_MM, profile[: len(profile) // 2, 0], arc[: len(arc) // 2])
    )
    density = np.where(arc < limbus, 1.0, 0.55) + 2.2 * np.exp(-(((arc - limbus) / 0.9) ** 2))
    steps = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * lengths)])
    share = steps / steps[-1] * rings
    at_limbus = np.interp(limbus, arc, share)
    wanted = np.arange(1, rings + 1, dtype=np.float64)
    nearest = int(np.argmin(np.abs(wanted - at_limbus)))
    stretched = np.where(
        wanted <= wanted[nearest],
        wanted * at_limbus / wanted[nearest],
        rings - (rings - wanted) * (rings - at_limbus) / (rings - wanted[nearest]),
    )
    along = np.interp(stretched, share, arc)
    return _on_surface(np.interp(along, arc, _polar(profile)))


def _profile(samples: int = 4001) -> Array:
    """Sample the surface's section (r, z) from the apex to the mesh's end."""
    r = np.linspace(0.0, PROFILE_END_MM, samples)
    back = np.linspace(
        math.asin(PROFILE_END_MM / GLOBE_RADIUS_MM), math.radians(BACK_ANGLE_DEG), samples
    )
    globe = GLOBE_RADIUS_MM * np.column_stack([np.sin(back), np.cos(back)])
    return np.concatenate([np.column_stack([r, surface_height(r)[0]]), globe[1:]])


def _polar(profile: Array) -> Array:
    return np.arctan2(profile[:, 0], profile[:, 1])


def _on_surface(polar: Array) -> Array:
    """Return the exact surface points (r, z) near polar angles: r interpolated, z evaluated."""
    profile = _profile()
    r = np.interp(polar, _polar(profile), profile[:, 0])
    r = np.where(
        polar < math.asin(PROFILE_END_MM / GLOBE_RADIUS_MM), r, GLOBE_RADIUS_MM * np.sin(polar)
    )
    on_front = (polar < math.pi / 2) & (r < PROFILE_END_MM)
    z = np.where(
        on_front, surface_height(np.minimum(r, PROFILE_END_MM))[0], GLOBE_RADIUS_MM * np.cos(polar)
    )
    return np.column_stack([r, z])


def _vertices(rings: Array, segments: int) -> Array:
    """Place the apex and the rings; every other ring is turned by half a segment."""
    turn = 2 * math.pi / segments
    points = [np.array([[0.0, 0.0, float(surface_height(0.0)[0])]])]
    for number, (r, z) in enumerate(rings):
        angles = turn * (np.arange(segments) + 0.5 * (number % 2))
        points.append(
            np.column_stack([r * np.cos(angles), r * np.sin(angles), np.full(segments, z)])
        )
    return np.concatenate(points)


def _indices(rings: int, segments: int) -> npt.NDArray[np.int32]:
    """Join the rings, counter-clockwise seen from outside."""
    this = np.arange(segments)
    following = (this + 1) % segments
    faces = [np.column_stack([np.zeros(segments, int), 1 + this, 1 + following])]
    for ring in range(rings - 1):
        inner, outer = 1 + ring * segments, 1 + (ring + 1) * segments
        if ring % 2 == 0:  # the outer ring is the turned one
            faces.append(np.column_stack([inner + this, outer + this, inner + following]))
            faces.append(np.column_stack([inner + following, outer + this, outer + following]))
        else:
            faces.append(np.column_stack([inner + this, outer + this, outer + following]))
            faces.append(np.column_stack([inner + this, outer + following, inner + following]))
    return np.concatenate(faces).astype(np.int32)


def _split_facets(mesh: Mesh) -> Mesh:
    corners = mesh.positions[mesh.triangles]
    normals = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    count = len(mesh.triangles)
    triangles = np.arange(3 * count, dtype=np.int32).reshape(count, 3)
    return Mesh(corners.reshape(-1, 3), np.repeat(normals, 3, axis=0), triangles)
