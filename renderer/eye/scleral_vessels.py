"""The vessels of one eye's white on its map: which trees grow, and how dense they look.

The map's geometry stands here, because the vessels need it first.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from scipy import ndimage

from renderer.eye.anatomy import GLOBE_RADIUS_MM, LIMBUS_RADIUS_MM
from renderer.eye.veins import ARCADE, CAPILLARY, CONJUNCTIVAL, EPISCLERAL, arcades, grow, trunks
from renderer.textures.noise import Field
from renderer.textures.tubes import Tubes, draw_tubes, join_tubes

EDGE_DEG: Final = 110.0  # polar angle from the gaze axis at the map's edge
HALF_SIZE_MM: Final = GLOBE_RADIUS_MM * math.radians(EDGE_DEG)
LIMBUS_ARC_MM: Final = GLOBE_RADIUS_MM * math.asin(LIMBUS_RADIUS_MM / GLOBE_RADIUS_MM)


def vessel_density(seed: int, size_px: int) -> tuple[Field, Field]:
    """Return the optical density of the conjunctival and of the episcleral vessels, 0 to 1."""
    front, _ = draw_tubes(_front_tubes(seed), size_px, half_size_mm=HALF_SIZE_MM)
    behind, _ = draw_tubes(_deep_tubes(seed), size_px, half_size_mm=HALF_SIZE_MM)
    texel_mm = 2.0 * HALF_SIZE_MM / size_px
    # Conjunctiva is clear, yet its vessels lie a tenth of a millimetre under a wet surface.
    halo = ndimage.gaussian_filter(front, 0.06 / texel_mm, truncate=3.0)
    soft = ndimage.gaussian_filter(behind, 0.15 / texel_mm, truncate=3.0)
    return np.asarray(front + 0.30 * halo), np.asarray(soft)


def _front_tubes(seed: int) -> Tubes:
    rng = np.random.Generator(np.random.PCG64([seed, 0x5C1E]))
    trees = trunks(
        rng,
        int(rng.integers(16, 25)),
        start_mm=(15.0, 22.0),
        half_width_mm=(0.026, 0.052),
        density=(0.38, 0.75),
        length_mm=(6.0, 15.0),
    )
    hairs = trunks(
        rng,
        150,
        start_mm=(8.0, 20.0),
        half_width_mm=(0.007, 0.016),
        density=(0.12, 0.34),
        length_mm=(1.0, 4.0),
    )
    loops = arcades(rng, 300, limbus_mm=LIMBUS_ARC_MM)
    return join_tubes(
        [
            grow(trees, CONJUNCTIVAL, seed * 4 + 1),
            grow(hairs, CAPILLARY, seed * 4 + 2),
            grow(loops, ARCADE, seed * 4 + 3),
        ]
    )


def _deep_tubes(seed: int) -> Tubes:
    rng = np.random.Generator(np.random.PCG64([seed, 0xDEE9]))
    trees = trunks(
        rng,
        int(rng.integers(26, 36)),
        start_mm=(14.0, 21.0),
        half_width_mm=(0.06, 0.15),
        density=(0.40, 0.80),
        length_mm=(7.0, 14.0),
    )
    return grow(trees, EPISCLERAL, seed * 4 + 4)
