"""How much of the stimulus survives encoding: PSNR and SSIM inside the eyes' rectangles."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.ndimage import gaussian_filter

from renderer.camera import IRIS_DIAMETER_MM, eye_centre_mm, views
from renderer.clip import ClipSpec

Pixels = npt.NDArray[np.uint8]
Rectangle = tuple[slice, slice]

APERTURE_IRISES: Final = (2.6, 1.1)  # the open eye's width and height in iris diameters
PEAK: Final = 255.0
IDENTICAL_DB: Final = 99.0  # what a PSNR without any error is written as


def eye_rectangles(
    spec: ClipSpec, azimuth_deg: float, *, distance_px: float | None = None
) -> tuple[Rectangle, Rectangle]:
    """Return each eye's rectangle on the picture as (rows, columns), left and right eye."""
    found: dict[int, Rectangle] = {}
    for view in views(spec, azimuth_deg, distance_px=distance_px):
        x0, y0, width, height = view.rectangle
        for eye in view.eyes:
            clip = view.projection @ view.view_matrix @ np.append(eye_centre_mm(eye), 1.0)
            centre_x = x0 + (clip[0] / clip[3] + 1) / 2 * width
            centre_y = spec.height - (y0 + (clip[1] / clip[3] + 1) / 2 * height)
            px_per_mm = view.projection[1, 1] / clip[3] * height / 2
            half_w, half_h = (0.5 * n * IRIS_DIAMETER_MM * px_per_mm for n in APERTURE_IRISES)
            found[eye] = (
                _span(centre_y, half_h, 0, spec.height),
                _span(centre_x, half_w, x0, x0 + width),
            )
    return found[0], found[1]


def _span(centre: float, half: float, low: int, high: int) -> slice:
    start = min(max(int(centre - half), low), high - 8)
    return slice(start, max(min(math.ceil(centre + half), high), start + 8))


def psnr_db(reference: Pixels, test: Pixels) -> float:
    """Return the peak signal-to-noise ratio over all channels in dB, at most 99."""
    error = np.mean((reference.astype(np.float64) - test.astype(np.float64)) ** 2)
    return IDENTICAL_DB if error == 0 else min(IDENTICAL_DB, 10 * math.log10(PEAK**2 / error))


def ssim(reference: Pixels, test: Pixels) -> float:
    """Return the mean structural similarity of luma (Wang et al. 2004, Gaussian 1.5 px)."""
    a, b = _luma(reference), _luma(test)
    c1, c2 = (0.01 * PEAK) ** 2, (0.03 * PEAK) ** 2

    def blur(image: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return np.asarray(gaussian_filter(image, 1.5, truncate=3.5))

    mean_a, mean_b = blur(a), blur(b)
    var_a, var_b = blur(a * a) - mean_a**2, blur(b * b) - mean_b**2
    covariance = blur(a * b) - mean_a * mean_b
    similarity = ((2 * mean_a * mean_b + c1) * (2 * covariance + c2)) / (
        (mean_a**2 + mean_b**2 + c1) * (var_a + var_b + c2)
    )
    return float(similarity.mean())


def _luma(pixels: Pixels) -> npt.NDArray[np.float64]:
    return np.asarray(pixels @ np.array([0.2126, 0.7152, 0.0722]))
