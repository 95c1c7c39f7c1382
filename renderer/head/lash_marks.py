"""What lashes leave on the skin: the pores that they leave it by, and their soft shade.

Pure numpy, patch space (see ``lid_fit``) in mm.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.body.makehuman import Floats
from renderer.head.lash_rows import Growth, LashRow
from renderer.head.lid_fit import LidPatch
from renderer.head.lid_ground import on_skin, rim_step_mm
from renderer.head.strand_group import Strands, joined

POINTS: Final = 5
SHADE_MM: Final = 0.42  # width of the soft shadow along a hair
CAST: Final = 0.7  # how far light from above throws a hair's shade, per mm of its height
PORE_MM: Final = (0.30, 0.44)  # width of the skin that closes round a hair
PORE_LENGTH_MM: Final = 0.55
PORE_COLOUR: Final = (0.20, 0.062, 0.045)  # skin over the root's sheath: redder and darker
PORE_DARK: Final = (0.30, 0.58)  # thin hairs, thick hairs
LIP_COLOUR: Final = (0.72, 0.47, 0.38)  # the pore's raised far lip, which faces the light
LIP_SHARE: Final = 0.22


def root_shades(
    lid: LidPatch, row: LashRow, growth: Growth, *, column: Floats, local_mm: Floats
) -> Strands:
    """Lay a soft shadow on the skin under the first part of each hair.

    ``column`` (n,) says where hairs root, ``local_mm`` (n, k, 3) how they run in their frames.
    """
    step = rim_step_mm(lid)
    reach = np.linspace(0.0, 0.42 if row.is_upper else 0.6, POINTS)
    at = np.rint(reach * (local_mm.shape[1] - 1)).astype(int)
    along, out, height = (local_mm[:, at, axis] for axis in range(3))
    # Light comes from above: it throws the shade down, over the lower lid's skin away from the rim.
    out = np.maximum(out, 0.0) + (0.0 if row.is_upper else CAST) * np.maximum(height, 0.0)
    turn = -1.0 if row.is_upper else 1.0
    points = [
        on_skin(lid, column + turn * along[:, k] / step, growth.beyond_mm + out[:, k])
        for k in range(POINTS)
    ]
    return _marks(
        points, np.full(row.count, SHADE_MM), (0.0, 0.0, 0.0), np.full(row.count, row.shadow)
    )


def pores(lid: LidPatch, row: LashRow, growth: Growth, *, column: Floats) -> Strands:
    """Lay a small reddish pit round each root, and before it the lip of raised skin."""
    thick = growth.width_mm / row.width_mm[1]
    lean = np.tan(np.radians(np.clip(growth.lean_deg, -50, 50))) * (-1.0 if row.is_upper else 1.0)
    step = rim_step_mm(lid)
    size = np.interp(thick, (0.4, 1.0), PORE_MM)
    groups = []
    for colour, dark, width, start in (
        (LIP_COLOUR, np.full(row.count, LIP_SHARE), 1.25 * size, 0.14),
        (PORE_COLOUR, np.interp(thick, (0.4, 1.0), PORE_DARK), size, -0.12),
    ):
        ways = start + PORE_LENGTH_MM * np.linspace(0.0, 1.0, POINTS)
        points = [on_skin(lid, column + lean * way / step, growth.beyond_mm + way) for way in ways]
        groups.append(_marks(points, width, colour, dark))
    return joined(groups)


def _marks(
    points: list[Floats], width: Floats, colour: tuple[float, float, float], share: Floats
) -> Strands:
    return Strands(np.stack(points, axis=1), width, np.tile(colour, (len(width), 1)), share)
