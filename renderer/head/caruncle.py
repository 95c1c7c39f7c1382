"""The pink bump in the inner corner of the eye, and the membrane that closes the outer corner.

Pure numpy, patch space (see ``lid_fit``): both bridge what lies between the rims where they have
left the globe.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.body.makehuman import Floats, Indices
from renderer.head.lid_rims import LATERAL_MM, MEDIAL_MM, globe_height, rim_curves

CARUNCLE_END_MM: Final = -9.2  # towards the pupil: under the globe's surface from here on
MEMBRANE_START_MM: Final = 10.2
ROWS: Final = 26
COLUMNS: Final = 18


def caruncle() -> tuple[Floats, Indices, Floats, Floats]:
    """Return points (n, 3) in mm, quads (m, 4), and how much each point is caruncle or sclera."""
    points, a, b = _sheet(MEDIAL_MM[0], CARUNCLE_END_MM)
    x, y, z = (points[..., axis] for axis in range(3))
    hump = np.exp(-(((a - 0.33) / 0.25) ** 2) - ((b - 0.44) / 0.32) ** 2)
    plica = np.exp(-(((a - 0.66 - 0.10 * (b - 0.5)) / 0.07) ** 2)) * np.sin(np.pi * b)
    lobes = 0.12 * np.sin(9.0 * x + 3.0 * y) * np.sin(7.0 * y - 2.0 * x) * hump
    sag = 0.9 * np.sin(np.pi * b) * np.clip(a * 4, 0, 1)
    height = z - sag + 1.9 * hump + 0.45 * plica + lobes
    globe = globe_height(np.minimum(np.hypot(x, y), 10.9))
    near, under = _ease((a - 0.40) / 0.42), _ease((a - 0.8) / 0.2)
    points[..., 2] = height * (1 - near) + (globe + 0.12 + 0.5 * plica - 0.6 * under) * near
    pink = np.clip(1.25 * hump, 0, 1).ravel()
    return points.reshape(-1, 3), _quads(), pink, 0.85 * _ease((a - 0.48) / 0.45).ravel()


def outer_membrane() -> tuple[Floats, Indices, Floats]:
    """Return points (n, 3) in mm and quads (m, 4) of the conjunctiva in the outer corner.

    The third array says how much each point looks like sclera.
    """
    points, a, b = _sheet(LATERAL_MM[0], MEMBRANE_START_MM)
    globe = globe_height(np.minimum(np.hypot(points[..., 0], points[..., 1]), 11.2))
    near, under = _ease(a / 0.6), _ease((a - 0.6) / 0.4)
    sheet = points[..., 2] - 0.4 * np.sin(np.pi * b)
    points[..., 2] = sheet * (1 - near) + (globe + 0.03 - 0.5 * under) * near
    return points.reshape(-1, 3), _quads()[:, ::-1], 0.6 * _ease((a - 0.2) / 0.6).ravel()


def _sheet(corner_x: float, inner_x: float) -> tuple[Floats, Floats, Floats]:
    """Span a sheet between the rims from a canthus inwards; a runs inwards, b upwards, 0 to 1."""
    a, b = np.meshgrid(np.linspace(0, 1, ROWS), np.linspace(-0.03, 1.04, COLUMNS), indexing="ij")
    # The inner edge is a crescent around the pupil.
    crescent = inner_x + np.sign(corner_x) * 1.2 * (2 * np.clip(b, 0, 1) - 1) ** 2
    x = corner_x + (crescent - corner_x) * a
    upper, lower = (
        [np.interp(x, curve[:, 0], curve[:, axis]) for axis in (1, 2)]
        for curve in rim_curves(samples=513)
    )
    y = lower[0] * (1 - b) + upper[0] * b
    z = lower[1] * (1 - b) + upper[1] * b
    return np.stack([x, y, z], axis=-1), a, np.clip(b, 0, 1)


def _ease(x: Floats) -> Floats:
    x = np.clip(x, 0.0, 1.0)
    return np.asarray(x * x * (3 - 2 * x))


def _quads() -> Indices:
    i, j = np.meshgrid(np.arange(ROWS - 1), np.arange(COLUMNS - 1), indexing="ij")
    corners = [(i + di) * COLUMNS + j + dj for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1))]
    return np.stack(corners, axis=-1).reshape(-1, 4)
