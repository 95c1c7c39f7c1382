"""How much of a picture survives: PSNR and SSIM. Pure numpy and scipy."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.ndimage import gaussian_filter

Pixels = npt.NDArray[np.uint8]

PEAK: Final = 255.0
IDENTICAL_DB: Final = 99.0  # what a PSNR without any error is written as


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
