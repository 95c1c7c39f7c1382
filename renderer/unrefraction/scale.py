"""The photograph's scale from the whole slope of the limbus instead of its half-way mark alone.

Half of the step between iris and sclera is climbed up to 0.03 mm further out on pale irises than on
dark ones, because the limbal ring and the iris's own brightness tilt the slope. The fitted veil
(renderer.unrefraction.light) tells both apart. In red, where irises of all colours are most alike,
it agrees within 0.005 mm over blue, grey, green and brown ones.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

import numpy as np

from renderer.eye.anatomy import LIMBUS_INSET_MM, LIMBUS_RADIUS_MM
from renderer.unrefraction.light import find_limbus
from renderer.unrefraction.pose import Pose
from renderer.unrefraction.sighting import Sighting
from renderer.unrefraction.texels import place_texels, sample

SIZE_PX: Final = 512  # of the coarse maps: the slope is 0.6 mm wide
MOST: Final = 0.015  # a larger correction means that the slope was not the limbus's


def on_scale(sighting: Sighting) -> Sighting:
    """Return the eye that was found with its scale mended; everything in mm follows."""
    texels = place_texels(sighting.pose, SIZE_PX)
    red = np.repeat(sample(sighting.crop.pixels, texels)[..., :1], 3, axis=-1)
    limbus, _ = find_limbus(red, texels)
    ratio = limbus.middle_mm / (LIMBUS_RADIUS_MM - LIMBUS_INSET_MM)
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
