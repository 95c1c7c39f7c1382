"""The photograph's scale from the whole slope of the limbus instead of its half-way mark alone.

Half of the step between iris and sclera is climbed 0.15 mm outside of the middle of the soft edge,
because the dark ring tilts the slope; how much, depends on the ring and on how pale the iris is.
The fitted limbus (renderer.unrefraction.limbus_fit) tells them apart: on rendered irises of five
colours its edge lies within 0.015 mm of the eye's own. What is left is the edge's wandering.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

from renderer.unrefraction.limbus import EDGE_MM, mean_edge_mm
from renderer.unrefraction.limbus_fit import find_limbus
from renderer.unrefraction.pose import Pose
from renderer.unrefraction.sighting import Sighting
from renderer.unrefraction.texels import place_texels, sample

SIZE_PX: Final = 512  # of the coarse maps: the slope is 0.8 mm wide
MOST: Final = 0.015  # a larger correction means that the slope was not the limbus's


def on_scale(sighting: Sighting) -> Sighting:
    """Return the eye that was found with its scale mended; everything in mm follows."""
    texels = place_texels(sighting.pose, SIZE_PX)
    limbus, _ = find_limbus(sample(sighting.crop.pixels, texels), texels)
    ratio = mean_edge_mm(limbus) / EDGE_MM
    if abs(math.log(ratio)) > MOST:
        return sighting
    return replace(sighting, pose=_scaled(sighting.pose, ratio))


def _scaled(pose: Pose, ratio: float) -> Pose:
    return replace(
        pose,
        px_per_mm=pose.px_per_mm * ratio,
        pupil_mm=pose.pupil_mm / ratio,
        pupil_x_mm=pose.pupil_x_mm / ratio,
        pupil_y_mm=pose.pupil_y_mm / ratio,
    )
