"""The pink bump in the inner corner of the eye, and the membrane that closes the outer corner.

Pure numpy, patch space (see ``lid_fit``): both bridge what lies between the rims where they have
left the globe.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.anatomy import GLOBE_RADIUS_MM
from renderer.lid_fit import LATERAL_MM, MEDIAL_MM, globe_height, rim_curves
from renderer.makehuman import Floats, Indices

CARUNCLE_END_MM: Final = -9.2  # towards the pupil: under the globe's surface from here on
MEMBRANE_START_MM: Final = 9.0
ROWS: Final = 40
COLUMNS: Final = 28


def caruncle() -> tuple[Floats, Indices, Floats]:
    """Return points (n, 3) in mm, quads (m, 4) and how much each is caruncle (n,), 0 to 1."""
    points, a, b = _sheet(MEDIAL_MM[0], CARUNCLE_END_MM)
    x, y, z = (points[..., axis] for axis in range(3))
    hump = np.exp(-(((a - 0.30) / 0.22) ** 2) - ((b - 0.42) / 0.30) ** 2)
    plica = np.exp(-(((a - 0.66 - 0.10 * (b - 0.5)) / 0.07) ** 2)) * np.sin(np.pi * b)
    lobes = 0.12 * np.sin(9.0 * x + 3.0 * y) * np.sin(7.0 * y - 2.0 * x) * hump
    sag = 0.9 * np.sin(np.pi * b) * np.clip(a * 4, 0, 1)
    height = z - sag + 1.7 * hump + 0.45 * plica + lobes
    globe = np.where(np.hypot(x, y) < GLOBE_RADIUS_MM, globe_height(np.hypot(x, y)), 0.0)
    dive = np.clip((a - 0.62) / 0.38, 0, 1) ** 1.5
    points[..., 2] = height * (1 - dive) + (globe - 0.5) * dive
    return points.reshape(-1, 3), _quads(), np.clip(1.25 * hump, 0, 1).ravel()


def outer_membrane() -> tuple[Floats, Indices]:
    """Return points (n, 3) in mm and quads (m, 4) of the conjunctiva in the outer corner."""
    points, a, b = _sheet(LATERAL_MM[0], MEMBRANE_START_MM)
    r = np.hypot(points[..., 0], points[..., 1])
    globe = np.where(r < GLOBE_RADIUS_MM, globe_height(r), 0.0)
    dive = np.clip(a / 0.8, 0, 1)
    points[..., 2] += -0.5 * np.sin(np.pi * b)
    points[..., 2] = points[..., 2] * (1 - dive) + (globe - 0.4) * dive
    return points.reshape(-1, 3), _quads()[:, ::-1]


def _sheet(corner_x: float, inner_x: float) -> tuple[Floats, Floats, Floats]:
    """Span a sheet between the rims from a canthus inwards; a runs inwards, b upwards, 0 to 1."""
    a, b = np.meshgrid(np.linspace(0, 1, ROWS), np.linspace(-0.06, 1.06, COLUMNS), indexing="ij")
    x = corner_x + (inner_x - corner_x) * a
    upper, lower = (
        np.stack([np.interp(x[:, 0], c[:, 0], c[:, k]) for k in (1, 2)])
        for c in rim_curves(samples=513)
    )
    y = lower[0][:, None] * (1 - b) + upper[0][:, None] * b
    z = lower[1][:, None] * (1 - b) + upper[1][:, None] * b
    return np.stack([x, y, z], axis=-1), a, np.clip(b, 0, 1)


def _quads() -> Indices:
    i, j = np.meshgrid(np.arange(ROWS - 1), np.arange(COLUMNS - 1), indexing="ij")
    corners = [(i + di) * COLUMNS + j + dj for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1))]
    return np.stack(corners, axis=-1).reshape(-1, 4)
