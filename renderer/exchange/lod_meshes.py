"""The real meshes of a LoD as an engine wants them: parts, tangents, a pupil that opens.

Pure numpy. Eye space in mm. The globe is the mesh that the renderer draws at this level, cut at
the limbus.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.detail import Detail
from renderer.exchange.eye_parts import iris_disc, sclera_uv, stretched
from renderer.exchange.meshes import Floats, Mesh, Triangles
from renderer.eye.anatomy import IRIS_MAP_RADIUS_MM, LIMBUS_RADIUS_MM, MAP_PUPIL_RADIUS_MM
from renderer.eye.geometry import eye_mesh
from renderer.eye.optics import unit
from renderer.iris.maps import MAP_EDGE_MM

# Rings and segments of the iris beside the globe's triangles at each level of tessellation.
IRIS_GRIDS: Final = {150: (2, 12), 500: (4, 24), 2000: (8, 48), 8000: (16, 90)}
PUPIL_TARGETS_MM: Final = (1.5, 8.0)  # the ends of a clip's range


@dataclass(frozen=True)
class LodMesh:
    """One eye at one LoD: the white, the clear cornea (None where nothing shows it), the iris."""

    sclera: Mesh
    cornea: Mesh | None
    iris: Mesh


def lod_meshes(detail: Detail, *, pupil_mm: float, mirror: bool) -> LodMesh:
    """Return a LoD's meshes; ``mirror`` is set for the viewer's right eye."""
    count = int(detail.setting("tessellation", "triangles"))
    has_facets = detail.setting("tessellation", "normals") == "facet"
    globe = eye_mesh(count, facets=has_facets)
    middle = globe.positions[globe.triangles].mean(axis=1)
    is_clear = (np.hypot(*middle[:, :2].T) < LIMBUS_RADIUS_MM) & (middle[:, 2] > 0)
    rings, segments = IRIS_GRIDS[count]
    white = _part(globe.positions, globe.normals, globe.triangles[~is_clear])
    shows_cornea = detail.setting("reflection", "mode") != "none" or detail.setting(
        "refraction", "refracts"
    )
    return LodMesh(
        sclera=Mesh(
            white.positions,
            white.normals,
            white.triangles,
            sclera_uv(white.positions, mirror=mirror),
        ),
        cornea=_part(globe.positions, globe.normals, globe.triangles[is_clear])
        if shows_cornea
        else None,
        iris=iris_disc(pupil_mm=pupil_mm, mirror=mirror, rings=rings, segments=segments),
    )


def iris_targets(iris: Mesh, *, pupil_mm: float) -> list[Floats]:
    """Return by how much each vertex moves (n, 3) to reach each pupil of PUPIL_TARGETS_MM.

    Tissue moves along its radius in proportion to the pupil's, so weights between 0 and 1 give
    every pupil in between exactly.
    """
    if iris.uv is None:
        raise ValueError("an iris without map coordinates cannot be stretched")
    on_map = (2.0 * iris.uv - 1.0) * MAP_EDGE_MM
    tissue = np.minimum(np.hypot(*on_map.T), IRIS_MAP_RADIUS_MM)
    is_tissue = tissue[:, None] > 0.5 * MAP_PUPIL_RADIUS_MM  # not the black behind the pupil
    now = stretched(tissue, 0.5 * pupil_mm)
    radius = np.maximum(np.hypot(*iris.positions[:, :2].T), 1e-9)
    outward = iris.positions * [1.0, 1.0, 0.0] / radius[:, None]
    return [
        is_tissue * outward * (stretched(tissue, 0.5 * target) - now)[:, None]
        for target in PUPIL_TARGETS_MM
    ]


def iris_tangents(iris: Mesh, *, mirror: bool) -> Floats:
    """Return tangents (n, 4): along u, and the sign that turns the bitangent up the map."""
    along = np.tile([-1.0 if mirror else 1.0, 0.0, 0.0], (len(iris.positions), 1))
    return _tangents(along, iris.normals, mirror=mirror)


def sclera_tangents(sclera: Mesh, *, mirror: bool) -> Floats:
    """Return tangents (n, 4): the direction that +z takes +x to on its way to the point."""
    c = unit(sclera.positions)
    k = 1.0 / (1.0 + np.maximum(c[:, 2], -0.9))
    along = np.stack([1.0 - c[:, 0] ** 2 * k, -c[:, 0] * c[:, 1] * k, -c[:, 0]], axis=-1)
    return _tangents(along * (-1.0 if mirror else 1.0), sclera.normals, mirror=mirror)


def _tangents(along: Floats, normals: Floats, *, mirror: bool) -> Floats:
    across = along - normals * (along * normals).sum(axis=1, keepdims=True)
    # Where the normal lies along u, any direction across will do.
    short = np.linalg.norm(across, axis=1) < 1e-6
    across[short] = np.cross(normals[short], [0.0, 1.0, 0.0])
    sign = np.full((len(along), 1), -1.0 if mirror else 1.0)
    return np.concatenate([unit(across), sign], axis=1)


def _part(positions: Floats, normals: Floats, triangles: Triangles) -> Mesh:
    used, corners = np.unique(triangles, return_inverse=True)
    return Mesh(positions[used], normals[used], corners.reshape(-1, 3))
