"""One eye as surfaces for other renderers: cornea, sclera, iris. Pure numpy.

Eye space (mm, the globe's centre at the origin, +z the gaze). The renderer draws the eye as one
surface and finds the iris by ray; a path tracer and an engine want the parts themselves.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from renderer.body.normals import vertex_normals
from renderer.exchange.meshes import Floats, Mesh, Triangles, joined
from renderer.eye.anatomy import (
    IRIS_MAP_RADIUS_MM,
    IRIS_Z_MM,
    LIMBUS_RADIUS_MM,
    MAP_PUPIL_RADIUS_MM,
)
from renderer.eye.geometry import ring_polar
from renderer.eye.optics import surface_height, surface_normal, unit
from renderer.eye.sclera import EDGE_DEG
from renderer.iris.maps import MAP_EDGE_MM

FINE_RINGS: Final = 128  # of the globe: 0.1 mm on the cornea, flat within 0.2 micrometres
FINE_SEGMENTS: Final = 256
BEHIND_RADIUS_MM: Final = 4.6  # wider than the widest pupil, 0.3 mm behind its edge
BEHIND_MM: Final = 0.3
RELIEF_RINGS: Final = 160  # of the iris: 0.025 mm, half a strand
RELIEF_SEGMENTS: Final = 640


def cornea_and_sclera(
    *, mirror: bool, rings: int = FINE_RINGS, segments: int = FINE_SEGMENTS
) -> tuple[Mesh, Mesh]:
    """Return the front surface, split at the limbus: the clear part, then the white of the eye.

    Both share the limbus's vertices and the normals of the exact surface. The white has the
    coordinates of its maps; ``mirror`` is set for the viewer's right eye.
    """
    profile = ring_polar(rings)
    at_limbus = int(
        np.argmin(np.abs(np.where(profile[:, 1] > 0, profile[:, 0], np.inf) - LIMBUS_RADIUS_MM))
    )
    apex = np.array([[0.0, float(surface_height(0.0)[0])]])
    clear, clear_triangles = revolved(np.concatenate([apex, profile[: at_limbus + 1]]), segments)
    white, white_triangles = revolved(profile[at_limbus:], segments)
    return (
        Mesh(clear, surface_normal(clear), clear_triangles),
        Mesh(white, surface_normal(white), white_triangles, sclera_uv(white, mirror=mirror)),
    )


def iris_disc(*, pupil_mm: float, mirror: bool, rings: int = 24, segments: int = 128) -> Mesh:
    """Return the flat iris from the pupil's edge to its root, and the wall up to the limbus.

    Stretched for the pupil, so the maps stay as they are. The wall, the dark tissue of the
    chamber's angle, keeps anybody from looking past the root into the globe, and a black disc
    behind the pupil from looking through it.
    """
    return _iris(0.5 * pupil_mm, mirror=mirror, rings=rings, segments=segments, height_mm=None)


def iris_relief(height_mm: Floats, *, pupil_mm: float, mirror: bool) -> Mesh:
    """Return the iris with its relief, whose mean lies on the iris plane.

    ``height_mm`` (n, n) covers the square of the maps, row 0 below.
    """
    return _iris(
        0.5 * pupil_mm,
        mirror=mirror,
        rings=RELIEF_RINGS,
        segments=RELIEF_SEGMENTS,
        height_mm=height_mm,
    )


def stretched(map_radius_mm: Floats, pupil_radius_mm: float) -> Floats:
    """Return where tissue at a radius of the maps lies for a pupil (Pamplona et al. 2009)."""
    share = (map_radius_mm - MAP_PUPIL_RADIUS_MM) / (IRIS_MAP_RADIUS_MM - MAP_PUPIL_RADIUS_MM)
    return np.asarray(pupil_radius_mm + share * (IRIS_MAP_RADIUS_MM - pupil_radius_mm))


def _iris(
    pupil_radius_mm: float, *, mirror: bool, rings: int, segments: int, height_mm: Floats | None
) -> Mesh:
    map_radius = np.linspace(MAP_PUPIL_RADIUS_MM, IRIS_MAP_RADIUS_MM, rings)
    radius = stretched(map_radius, pupil_radius_mm)
    points, triangles = revolved(np.column_stack([radius, np.full(rings, IRIS_Z_MM)]), segments)
    on_map = revolved(np.column_stack([map_radius, np.zeros(rings)]), segments)[0][:, :2]
    uv = 0.5 + 0.5 * on_map * [-1.0 if mirror else 1.0, 1.0] / MAP_EDGE_MM
    if height_mm is not None:
        points[:, 2] += _sampled(height_mm, uv) - _mean_height(height_mm)
    tissue = Mesh(points, vertex_normals(points, triangles), triangles, uv)
    return joined([tissue, _wall(points[-segments:], uv[-segments:]), _behind_pupil(segments)])


def _behind_pupil(segments: int) -> Mesh:
    """Return the black that shows through any pupil: a disc in the colour of the maps' middle."""
    rim = [BEHIND_RADIUS_MM, IRIS_Z_MM - BEHIND_MM]
    points, triangles = revolved(np.array([[0.0, rim[1]], rim]), segments)
    count = len(points)
    forwards = np.tile([0.0, 0.0, 1.0], (count, 1))
    return Mesh(points, forwards, triangles, np.full((count, 2), 0.5))


def _wall(root: Floats, uv: Floats) -> Mesh:
    """Return the wall from the iris's root up to the limbus, in the colour of the maps' edge."""
    segments = len(root)
    limbus = root.copy()
    limbus[:, 2] = float(surface_height(LIMBUS_RADIUS_MM)[0])
    inward = unit(-root * [1.0, 1.0, 0.0])
    this = np.arange(segments)
    following = (this + 1) % segments
    # Seen from the axis: the winding of the iris goes on outwards and then up.
    triangles = np.concatenate(
        [
            np.column_stack([this, segments + this, segments + following]),
            np.column_stack([this, segments + following, following]),
        ]
    )
    both = np.concatenate
    return Mesh(both([root, limbus]), both([inward, inward]), triangles, both([uv, uv]))


def sclera_uv(positions: Floats, *, mirror: bool) -> Floats:
    """Return the coordinates of the white's maps: azimuthal equidistant about the gaze."""
    d = unit(positions)
    angle = np.arccos(np.clip(d[:, 2], -1, 1))[:, None]
    axis = d[:, :2] / np.maximum(np.linalg.norm(d[:, :2], axis=1, keepdims=True), 1e-9)
    reach = np.minimum(angle / math.radians(EDGE_DEG), 0.99)
    return np.asarray(0.5 + 0.5 * axis * reach * [-1.0 if mirror else 1.0, 1.0])


def revolved(profile: Floats, segments: int) -> tuple[Floats, Triangles]:
    """Turn a profile (k, 2) of radius and height about the axis: vertices and triangles.

    The profile runs outwards; triangles are counter-clockwise seen from +z. A first radius of 0 is
    one vertex.
    """
    has_tip = profile[0, 0] == 0.0
    rings = profile[1:] if has_tip else profile
    angles = 2 * math.pi * np.arange(segments) / segments
    around = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    points = np.concatenate(
        [
            (rings[:, None, :1] * around).reshape(-1, 2),
            np.repeat(rings[:, 1], segments)[:, None],
        ],
        axis=1,
    )
    this = np.arange(segments)
    following = (this + 1) % segments
    faces = []
    for ring in range(len(rings) - 1):
        inner, outer = ring * segments, (ring + 1) * segments
        faces.append(np.column_stack([inner + this, outer + this, outer + following]))
        faces.append(np.column_stack([inner + this, outer + following, inner + following]))
    if has_tip:
        tip = np.array([[0.0, 0.0, profile[0, 1]]])
        faces = [face + 1 for face in faces]
        faces.insert(0, np.column_stack([np.zeros(segments, int), 1 + this, 1 + following]))
        points = np.concatenate([tip, points])
    return points, np.concatenate(faces)


def _sampled(height_mm: Floats, uv: Floats) -> Floats:
    """Interpolate a map bilinearly."""
    size = height_mm.shape[0]
    at = np.clip(uv * size - 0.5, 0.0, size - 1.0)
    low = np.minimum(at.astype(int), max(size - 2, 0))
    share = at - low
    x, y = low.T
    right, above = np.minimum(x + 1, size - 1), np.minimum(y + 1, size - 1)
    lower = height_mm[y, x] * (1 - share[:, 0]) + height_mm[y, right] * share[:, 0]
    upper = height_mm[above, x] * (1 - share[:, 0]) + height_mm[above, right] * share[:, 0]
    return np.asarray(lower * (1 - share[:, 1]) + upper * share[:, 1])


def _mean_height(height_mm: Floats) -> float:
    """Return the mean between pupil and root: what lies on the iris plane."""
    size = height_mm.shape[0]
    axis = ((np.arange(size) + 0.5) / size * 2 - 1) * MAP_EDGE_MM
    radius = np.hypot(*np.meshgrid(axis, axis))
    tissue = (radius > MAP_PUPIL_RADIUS_MM + 0.1) & (radius < IRIS_MAP_RADIUS_MM - 0.1)
    return float(height_mm[tissue].mean() if tissue.any() else height_mm.mean())
