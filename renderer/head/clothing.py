"""The main character's roll-neck sweater, made from MakeHuman's helper geometry. Pure numpy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.body.makehuman import Floats, Indices
from renderer.body.normals import vertex_normals
from renderer.body.subdivide import subdivide, triangles_of
from renderer.head.character import Figure

LOWEST_MM: Final = -760.0  # the far view ends at -525
COLLAR_MM: Final = -131.0  # the helper's own edge runs up to the ears: folded down to here
LOOSENESS_MM: Final = 5.0
SMOOTHING_STEPS: Final = 6  # wool bridges the hollows of the body
COLOUR: Final = (0.055, 0.105, 0.125)  # linear; a dull blue-green that leaves the face alone
STITCH_MM: Final = 3.6  # width of one rib


@dataclass(frozen=True)
class Garment:
    """Points (n, 3) mm, unit normals, triangles (m, 3), knit (n, 2) in ribs and rows."""

    points_mm: Floats
    normals: Floats
    triangles: Indices
    knit: Floats


def sweater(body: Figure) -> Garment:
    """Return the sweater on a posed figure."""
    mesh = body.mesh
    quads = mesh.quads[mesh.quads_of("helper-tights")]
    quads = quads[body.vertices_mm[quads].mean(axis=1)[:, 1] > LOWEST_MM]
    used, rows = np.unique(quads, return_inverse=True)
    quads = rows.reshape(-1, 4)
    points = _loosen(body.vertices_mm[used], quads)
    rest = mesh.vertices_mm[used]
    carried = np.column_stack([points, rest])
    carried, quads = subdivide(carried, quads)
    triangles = triangles_of(quads)
    points = carried[:, :3]
    return Garment(points, vertex_normals(points, triangles), triangles, _knit(carried[:, 3:]))


def _loosen(points: Floats, quads: Indices) -> Floats:
    """Smooth the body's forms away below the neck and lift the cloth off the skin."""
    edges = np.unique(
        np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], -1).reshape(-1, 2)), axis=0
    )
    both = np.concatenate([edges, edges[:, ::-1]])
    degree = np.bincount(both[:, 0], minlength=len(points))[:, None]
    neck = np.clip((points[:, 1:2] + 190.0) / 40.0, 0, 1)
    for _ in range(SMOOTHING_STEPS):
        total = np.stack(
            [
                np.bincount(both[:, 0], points[both[:, 1], k], minlength=len(points))
                for k in range(3)
            ],
            1,
        )
        points = points + 0.6 * (1 - neck) * (total / np.maximum(degree, 1) - points)
    normals = vertex_normals(points, triangles_of(quads))
    loose = points + normals * (LOOSENESS_MM - 3.0 * neck)
    above = np.maximum(loose[:, 1] - COLLAR_MM, 0.0)
    loose[:, 1] -= 0.96 * above
    return np.asarray(loose)


def _knit(rest: Floats) -> Floats:
    """Return ribs and rows from the rest pose, so that sleeves carry ribs along the arm."""
    x, y, z = rest.T
    on_arm = np.clip((np.abs(x) - 180.0) / 30.0, 0, 1)
    around_body = 150.0 * np.arctan2(x, z + 20.0)
    around_arm = 55.0 * np.arctan2(y - 530.0 + (np.abs(x) - 150.0) * 0.9, z)
    ribs = around_body * (1 - on_arm) + around_arm * on_arm
    rows = y * (1 - on_arm) - np.abs(x) * 1.3 * on_arm
    return np.column_stack([ribs, rows]) / STITCH_MM


def knit_tile(size: int = 128) -> npt.NDArray[np.uint8]:
    """Return one period of the knit (size, size, 4) uint8: slope x, slope y, openness, fuzz."""
    y, x = np.indices((size, size)) / size
    wave = np.abs(x - 0.5) * 2
    row = (y * 4 + 0.5 * wave) % 1.0
    height = 0.55 * np.sqrt(np.clip(1 - wave**2, 0, 1)) + 0.28 * np.sin(np.pi * row) * (
        1 - 0.4 * wave
    )
    rng = np.random.Generator(np.random.PCG64(5))
    fuzz = rng.standard_normal((size, size))
    height += 0.02 * fuzz
    slope_x = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) * size / 8
    slope_y = (np.roll(height, -1, 0) - np.roll(height, 1, 0)) * size / 8
    layers = [0.5 + 0.2 * slope_x, 0.5 + 0.2 * slope_y, 0.25 + 0.8 * height, 0.5 + 0.12 * fuzz]
    return np.stack([np.clip(layer * 255, 0, 255).astype(np.uint8) for layer in layers], -1)
