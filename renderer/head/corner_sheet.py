"""Sheets of conjunctiva between the lids' rims, from a corner of the eye inwards. Pure numpy.

Patch space (see ``lid_pose``).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.body.makehuman import Floats, Indices
from renderer.head.lid_pose import LidPose
from renderer.head.lid_rims import rim_curves

TUCKED_MM: Final = 0.3  # of the sheets' edges, below the lids
CRESCENT_MM: Final = 0.25  # how far its lines bend around the pupil towards the lids


@dataclass(frozen=True)
class Corner:
    """A sheet of conjunctiva: points (n, 3) in mm, quads (m, 4), and per point 0 to 1

    ``pink`` how much it is caruncle, ``grain`` how rough it is, ``sclera`` how much sclera shines
    through, ``cover`` how much of the globe it hides.
    """

    points_mm: Floats
    quads: Indices
    pink: Floats
    grain: Floats
    sclera: Floats
    cover: Floats


@dataclass(frozen=True)
class Sheet:
    """A grid between the rims: points in mm, places from canthus inwards and

    from lower to upper rim, 0 to 1, and how far apart the rims are there.
    """

    points_mm: Floats
    inwards: Floats
    upwards: Floats
    opening_mm: Floats


def span_sheet(corner_x: float, inner_x: float, pose: LidPose, *, grid: tuple[int, int]) -> Sheet:
    """Span a sheet between the rims from a canthus inwards."""
    rows, columns = grid
    a, b = np.meshgrid(np.linspace(0, 1, rows), np.linspace(-0.03, 1.03, columns), indexing="ij")
    # The inner edge is a crescent around the pupil.
    bend = 1.2 if corner_x > 0 else CRESCENT_MM
    crescent = inner_x + np.sign(corner_x) * bend * (2 * np.clip(b, 0, 1) - 1) ** 2
    x = corner_x + (crescent - corner_x) * a
    upper, lower = (
        [np.interp(x, curve[:, 0], curve[:, axis]) for axis in (1, 2)]
        for curve in rim_curves(pose, samples=513)
    )
    y = lower[0] * (1 - b) + upper[0] * b
    y += TUCKED_MM * np.clip((np.abs(b - 0.5) - 0.5) / 0.03, 0, 1) * np.sign(b - 0.5)
    z = lower[1] * (1 - b) + upper[1] * b
    opening = np.maximum(upper[0] - lower[0], 0.0)
    return Sheet(np.stack([x, y, z], axis=-1), a, np.clip(b, 0, 1), opening)


def sheet_quads(grid: tuple[int, int]) -> Indices:
    rows, columns = grid
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    corners = [(i + di) * columns + j + dj for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1))]
    return np.stack(corners, axis=-1).reshape(-1, 4)
