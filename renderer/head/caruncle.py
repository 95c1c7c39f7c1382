"""The pink bump in the inner corner of the eye, and the membrane that closes the outer corner.

Pure numpy, patch space (see ``lid_fit``): both bridge what lies between the rims where they have
left the globe.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.body.makehuman import Floats, Indices
from renderer.head.lid_rims import LATERAL_MM, MEDIAL_MM, globe_height, rim_curves

CARUNCLE_END_MM: Final = -8.6  # towards the pupil: under the globe's surface from here on
COVER_MM: Final = (-9.2, -11.0)  # the conjunctiva fades in over the sclera between these
PLICA_MM: Final = -12.1  # the fold, a crescent open towards the pupil
BUMP_MM: Final = (-14.2, 1.45)  # the caruncle's middle and half width along x
MEMBRANE_START_MM: Final = 10.2
ROWS: Final = 52
COLUMNS: Final = 28


@dataclass(frozen=True)
class Corner:
    """A sheet of conjunctiva: points (n, 3) in mm, quads (m, 4), and per point 0 to 1

    ``pink`` how much it is caruncle, ``sclera`` how much sclera shines through, ``cover`` how
    much of the globe it hides.
    """

    points_mm: Floats
    quads: Indices
    pink: Floats
    sclera: Floats
    cover: Floats


def caruncle() -> Corner:
    """Return the inner corner: conjunctiva off the sclera, the plica's fold, the caruncle."""
    points, _, b = _sheet(MEDIAL_MM[0], CARUNCLE_END_MM)
    x, y, z = (points[..., axis] for axis in range(3))
    crescent = x + 0.9 * (2 * b - 1) ** 2  # lines of equal depth bend around the pupil
    hump = np.exp(-(((x - BUMP_MM[0]) / BUMP_MM[1]) ** 2) - ((b - 0.47) / 0.30) ** 2)
    plica = np.exp(-(((crescent - PLICA_MM) / 0.42) ** 2)) * np.sin(np.pi * b)
    sag = 0.75 * np.sin(np.pi * b) * _ease((x - MEDIAL_MM[0]) / 1.5)
    height = z - sag + 1.25 * hump + 0.35 * plica + _lumps(x, y) * np.sqrt(hump)
    globe = globe_height(np.minimum(np.hypot(x, y), 11.2))
    near = _ease((crescent + 12.6) / 2.0)
    under = _ease((crescent + 9.3) / 0.6)
    points[..., 2] = height * (1 - near) + (globe + 0.09 + 0.25 * plica - 0.6 * under) * near
    cover = _ease((COVER_MM[0] - crescent) / (COVER_MM[0] - COVER_MM[1]))
    cover = np.maximum(cover, _beside_globe(x, y))
    return Corner(
        points.reshape(-1, 3),
        _quads(),
        np.clip(1.25 * hump, 0, 1).ravel(),
        (0.95 * _ease((crescent + 12.7) / 2.4)).ravel(),
        cover.ravel(),
    )


def _beside_globe(x: Floats, y: Floats) -> Floats:
    """Return 1 where no globe would be seen through the sheet, 0 well inside its outline."""
    return _ease((np.hypot(x, y) - 10.75) / 0.4)


def _lumps(x: Floats, y: Floats) -> Floats:
    """Return the caruncle's glands in mm: lobes of a millimetre with finer grains on them."""
    lobes = np.sin(5.1 * x + 2.3 * y + 0.4) * np.sin(4.7 * y - 2.9 * x)
    grains = np.sin(11.3 * x - 4.1 * y) * np.sin(9.7 * y + 5.3 * x + 1.0)
    return np.asarray(0.11 * lobes + 0.045 * grains)


def outer_membrane() -> Corner:
    """Return the conjunctiva in the outer corner."""
    points, a, b = _sheet(LATERAL_MM[0], MEMBRANE_START_MM)
    globe = globe_height(np.minimum(np.hypot(points[..., 0], points[..., 1]), 11.2))
    near, under = _ease(a / 0.6), _ease((a - 0.6) / 0.4)
    sheet = points[..., 2] - 0.4 * np.sin(np.pi * b)
    points[..., 2] = sheet * (1 - near) + (globe + 0.08 - 0.55 * under) * near
    return Corner(
        points.reshape(-1, 3),
        _quads()[:, ::-1],
        np.zeros(a.size),
        (0.9 * _ease(a / 0.6)).ravel(),
        np.maximum(
            1.0 - _ease((a - 0.15) / 0.5), _beside_globe(points[..., 0], points[..., 1])
        ).ravel(),
    )


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
