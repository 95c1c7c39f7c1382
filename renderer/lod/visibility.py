"""How visible the difference of two pictures is: S-CIELAB. Pure numpy and scipy.

Zhang and Wandell 1996, "A spatial extension of CIELAB for digital color image reproduction": both
pictures are blurred as contrast sensitivity blurs them at a viewing distance, then their colour
difference is taken, here CIEDE2000. People just notice a difference of about 1 side by side.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from scipy.ndimage import gaussian_filter
from skimage import color

Values = npt.NDArray[np.float64]
Pixels = npt.NDArray[np.uint8]

PIXELS_PER_DEGREE: Final = 67.0  # a 24 inch monitor of 1920 pixels from 0.7 m, as FLIP assumes
JUST_NOTICEABLE: Final = 1.0  # mean CIEDE2000 over an eye's rectangle

# CIE XYZ to luminance, red-green, blue-yellow (the paper's table 1), and each channel's blur as
# (weight, standard deviation in degrees). The broad surround of luminance, 4.3 degrees, is wider
# than an eye's rectangle: its mean stands for it.
_OPPONENT: Final = np.array([[0.279, 0.72, -0.107], [-0.449, 0.29, -0.077], [0.086, -0.59, 0.501]])
_BLURS: Final = (
    ((0.921, 0.0283), (0.105, 0.133)),
    ((0.531, 0.0392), (0.330, 0.494)),
    ((0.488, 0.0536), (0.371, 0.386)),
)
_SURROUND: Final = (-0.108, 0.0, 0.0)


def visible_difference(shown: Pixels, ideal: Pixels) -> float:
    """Return the mean visible difference of two pictures (height, width, 3) of 8-bit sRGB."""
    seen = [_as_seen(picture) for picture in (ideal, shown)]
    difference: Callable[..., Any] = color.deltaE_ciede2000  # scikit-image has no types
    return float(np.mean(np.asarray(difference(*seen), dtype=np.float64)))


def _as_seen(picture: Pixels) -> Values:
    """Return a picture's CIELAB after contrast sensitivity's blur."""
    opponent = np.asarray(color.rgb2xyz(picture / 255.0)) @ _OPPONENT.T
    blurred = [
        _blurred(opponent[..., channel], blurs, surround)
        for channel, (blurs, surround) in enumerate(zip(_BLURS, _SURROUND, strict=True))
    ]
    xyz = np.stack(blurred, axis=-1) @ np.linalg.inv(_OPPONENT).T
    return np.asarray(color.xyz2lab(np.maximum(xyz, 0.0)))


def _blurred(values: Values, blurs: tuple[tuple[float, float], ...], surround: float) -> Values:
    total = surround * values.mean()
    for weight, deviation_deg in blurs:
        deviation_px = deviation_deg * PIXELS_PER_DEGREE
        total = total + weight * gaussian_filter(values, deviation_px, mode="nearest", truncate=3.0)
    return np.asarray(total / (surround + sum(weight for weight, _ in blurs)))
