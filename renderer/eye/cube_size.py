"""How large the cubes are that a cornea mirrors: Table 5.1's size, or what its picture can show.

Pure: no GL.
"""

from __future__ import annotations

import math
from typing import Final

from renderer.camera import IRIS_DIAMETER_MM, IRIS_PX
from renderer.clip import ClipSpec
from renderer.clip_values import REFERENCE_LINES
from renderer.detail import Detail
from renderer.eye.anatomy import CORNEA_RADIUS_MM

# Texels per pixel's angle: the reflection reads the cube one level down, where people's edges are
# averages of four texels.
FINER: Final = 2.0
NEARER: Final = 1.1  # the larger eye of an orbit's ends, against the one seen in front


def cube_px(detail: Detail, spec: ClipSpec) -> int:
    """Return the edge in texels of the cubes that a LoD mirrors in a clip; 0 for none.

    ``spec.cube_size`` "table" is the LoD's own size, "auto" never more than the clip can show.
    """
    own = int(detail.setting("reflection", "cube_px"))
    return own if spec.cube_size == "table" else min(own, shown_cube_px(largest_iris_px(spec)))


def shown_cube_px(iris_px: float) -> int:
    """Return a power of two: the cube that an eye with so wide an iris shows all of.

    A pixel spans 1 / r of the cornea's turn per mm, and mirrors twice that angle.
    """
    pixel_rad = 2.0 * IRIS_DIAMETER_MM / iris_px / CORNEA_RADIUS_MM
    return int(2 ** math.ceil(math.log2(FINER * 0.5 * math.pi / pixel_rad)))


def largest_iris_px(spec: ClipSpec) -> float:
    """Return the largest diameter of an iris in pixels that the clip's own path comes to."""
    is_approach = spec.motion == "approach"
    ends = (spec.approach_start_px, spec.approach_end_px)
    distance_px = max(ends) if is_approach else IRIS_PX[spec.distance]
    return NEARER * distance_px * spec.height / REFERENCE_LINES
