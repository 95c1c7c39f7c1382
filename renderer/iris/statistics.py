"""Measure an iris's albedo as strands are measured on photographs: along circles.

Definitions, since numbers hang on them, and their source (four super-macro photographs, through
reference/eye-rendering.md, 1.4) does not give its own. On circles of the ciliary zone the lightness
L* is smoothed by 10 micrometres. A strand is a peak whose prominence is at least half the standard
deviation about its surroundings; it is as wide as at half its prominence, and spacing is from peak
to peak. A ridge is where L* lies above its surroundings by RIDGE or more; coverage is the share of
ridges, and the split is the mean CIE L*a*b* of ridges minus that of all between them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage, signal

from renderer.iris.plane import HALF_SIZE_MM  # the maps' half side

Array = npt.NDArray[np.float64]

RIDGE: Final = 2.0  # L*: about what two fields side by side must differ by to be told apart
ZONE_MM: Final = (3.9, 5.2)
CIRCLES: Final = 40
STEP_MM: Final = 0.005
SMOOTH_MM: Final = 0.010
SURROUNDINGS_MM: Final = 0.20


@dataclass(frozen=True)
class Strands:
    """Medians of width and spacing in mm, share of ridges, and their split in L*, a*, b*."""

    width_mm: float
    spacing_mm: float
    coverage: float
    split: tuple[float, float, float]


def measure_strands(albedo: npt.NDArray[np.float32]) -> Strands:
    """Measure the strands of a linear albedo map (n, n, 3) that covers HALF_SIZE_MM."""
    widths, spacings, details = [], [], []
    for radius_mm in np.linspace(*ZONE_MM, CIRCLES):
        lab = to_lab(circle(albedo, radius_mm))
        step_mm = 2.0 * np.pi * radius_mm / len(lab)
        smooth, broad = (
            ndimage.gaussian_filter1d(lab, sigma_mm / step_mm, axis=0, mode="wrap")
            for sigma_mm in (SMOOTH_MM, SURROUNDINGS_MM)
        )
        details.append(smooth - broad)
        lightness = details[-1][:, 0]
        peaks, _ = signal.find_peaks(lightness, prominence=0.5 * lightness.std())
        widths.append(signal.peak_widths(lightness, peaks, rel_height=0.5)[0] * step_mm)
        spacings.append(np.diff(peaks) * step_mm)
    detail = np.concatenate(details)
    is_ridge = detail[:, 0] >= RIDGE
    split = detail[is_ridge].mean(axis=0) - detail[~is_ridge].mean(axis=0)
    return Strands(
        width_mm=float(np.median(np.concatenate(widths))),
        spacing_mm=float(np.median(np.concatenate(spacings))),
        coverage=float(is_ridge.mean()),
        split=(float(split[0]), float(split[1]), float(split[2])),
    )


def circle(albedo: npt.NDArray[np.float32], radius_mm: float) -> Array:
    """Return the colours along a circle, (count, 3), about every STEP_MM from angle 0 on."""
    count = round(2.0 * np.pi * radius_mm / STEP_MM)
    angle = np.arange(count) / count * 2.0 * np.pi
    at = [
        (radius_mm / HALF_SIZE_MM * turned + 1.0) * len(albedo) / 2.0 - 0.5
        for turned in (np.sin(angle), np.cos(angle))
    ]
    return np.stack(
        [ndimage.map_coordinates(albedo[..., c], at, order=1) for c in range(3)], axis=-1
    ).astype(np.float64)


def to_lab(linear: npt.ArrayLike) -> Array:
    """Return CIE 1976 L*a*b* of linear Rec. 709 colours under D65."""
    matrix = np.array(
        [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    )
    xyz = np.asarray(linear, np.float64) @ matrix.T / np.array([0.9505, 1.0, 1.089])
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16.0 / 116.0)
    lightness = 116.0 * f[..., 1] - 16.0
    return np.stack(
        [lightness, 500.0 * (f[..., 0] - f[..., 1]), 200.0 * (f[..., 1] - f[..., 2])], axis=-1
    )
