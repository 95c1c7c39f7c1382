"""The rims of the eyelids as curves, and how freely rays pass between them.

They shade the globe and bound what the cornea reflects.

Pure numpy. Eye space: millimetres, origin at the globe's centre, +z the gaze, +x the viewer's
right, +y up.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

Curve = npt.NDArray[np.float64]
Array = npt.NDArray[np.float64]

LID_FRONT_MM: Final = 13.4  # radius of the lids' middle surface, which rays pass or hit
LID_SOFTNESS_MM: Final = 0.5
LID_SOFTENING: Final = 0.12  # per mm of way: grazing rays meet lashes and a rounded edge


@dataclass(frozen=True)
class LidRims:
    """Inner edges of upper and lower lid in eye space, (n, 3) in mm, ordered by ascending x."""

    upper_mm: Curve
    lower_mm: Curve


def lid_openness(points: Array, directions: Array, rims: LidRims) -> Array:
    """Return how freely rays (n, 3) leave the lids' opening: 1 open, 0 on a lid.

    ``shaders/lids.glsl`` has the same rule: the ray is followed to the lids' middle surface and
    compared with the rims there.
    """
    along = np.sum(points * directions, axis=-1)
    excess = np.sum(points**2, axis=-1) - LID_FRONT_MM**2
    reach = np.maximum(-along + np.sqrt(np.maximum(along**2 - excess, 0.0)), 0.0)
    at = points + reach[:, None] * directions
    upper = np.interp(at[:, 0], rims.upper_mm[:, 0], rims.upper_mm[:, 1])
    lower = np.interp(at[:, 0], rims.lower_mm[:, 0], rims.lower_mm[:, 1])
    room = np.minimum(upper - at[:, 1], at[:, 1] - lower)
    softness = LID_SOFTNESS_MM + LID_SOFTENING * reach
    share = np.clip(0.5 + room / (2 * softness), 0.0, 1.0)
    return np.asarray(share * share * (3.0 - 2.0 * share))
