"""The square of texels that the iris's maps share: coordinates, blur, enlargement, steps.

Millimetres on the iris plane; knows no colour and no relief.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.iris.angles import over_angle
from renderer.iris.layout import IRIS_RADIUS_MM, PUPIL_RADIUS_MM, IrisLayout
from renderer.textures.noise import Field

# Half the side of the square that the maps cover: the iris's radius and 0.15 mm of margin.
HALF_SIZE_MM: Final = 6.0
# Curves over the angle are read by sector: 1.1 micrometres wide at the root, a fifth of a texel.
SECTORS: Final = 32768


@dataclass(frozen=True)
class Plane:
    """The texels' coordinates: radius in mm, angle in radians, sector, zone curves."""

    size_px: int
    x_mm: Field
    y_mm: Field
    radius_mm: Field
    angle: Field
    sector: npt.NDArray[np.intp]
    pupil_mm: Field
    collarette_mm: Field

    def around(self, curve: Field) -> Field:
        """Read a closed curve of samples over the angle at every texel."""
        return np.asarray(_fine(curve)[self.sector])

    @property
    def radius01(self) -> Field:
        """0 at the pupil's mean edge, 1 at the root."""
        return (self.radius_mm - np.float32(PUPIL_RADIUS_MM)) / np.float32(
            IRIS_RADIUS_MM - PUPIL_RADIUS_MM
        )

    @property
    def turns(self) -> Field:
        """The angle in whole turns."""
        return self.angle * np.float32(0.5 / np.pi)


def iris_plane(layout: IrisLayout, size_px: int) -> Plane:
    """Return the coordinates of all texel centres; row 0 is the lowest."""
    line = ((np.arange(size_px) + 0.5) / size_px * 2.0 - 1.0) * HALF_SIZE_MM
    x = np.broadcast_to(line.astype(np.float32)[None, :], (size_px, size_px))
    y = np.broadcast_to(line.astype(np.float32)[:, None], (size_px, size_px))
    angle = np.arctan2(y, x)
    turns = np.mod(angle * np.float32(0.5 / np.pi), np.float32(1.0))
    sector = np.minimum((turns * np.float32(SECTORS)).astype(np.intp), SECTORS - 1)
    return Plane(
        size_px=size_px,
        x_mm=x,
        y_mm=y,
        radius_mm=np.sqrt(x * x + y * y),
        angle=angle,
        sector=sector,
        pupil_mm=np.asarray(_fine(layout.pupil_mm)[sector]),
        collarette_mm=np.asarray(_fine(layout.collarette_mm)[sector]),
    )


def _fine(curve: Field) -> Field:
    """Return a closed curve's values in the middle of SECTORS sectors."""
    middle = (np.arange(SECTORS) + 0.5) / SECTORS * (2.0 * np.pi)
    return over_angle(curve, middle.astype(np.float32))


def blur(field: Field, sigma_mm: float, size_px: int) -> Field:
    """Blur with a Gaussian; wide ones at a quarter of the resolution, where they lose nothing."""
    sigma_px = sigma_mm * size_px / (2.0 * HALF_SIZE_MM)
    if sigma_px > 8.0 and size_px % 4 == 0:
        n = size_px // 4
        coarse = field.reshape(n, 4, n, 4).mean(axis=(1, 3), dtype=np.float32)
        coarse = ndimage.gaussian_filter(coarse, sigma_px / 4.0, mode="nearest", truncate=3.0)
        return enlarge(coarse, size_px)
    blurred: Field = ndimage.gaussian_filter(field, sigma_px, mode="nearest", truncate=3.0)
    return blurred


def enlarge(field: Field, size_px: int) -> Field:
    """Enlarge a square field to ``size_px`` with linear interpolation between texel centres."""
    n = field.shape[0]
    at = np.clip((np.arange(size_px) + 0.5) * n / size_px - 0.5, 0.0, n - 1.0)
    low = np.minimum(at.astype(np.int64), n - 2)
    t = (at - low).astype(np.float32)
    rows = field[low] * (1.0 - t)[:, None] + field[low + 1] * t[:, None]
    enlarged: Field = rows[:, low] * (1.0 - t)[None, :] + rows[:, low + 1] * t[None, :]
    return enlarged
