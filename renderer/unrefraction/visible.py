"""Which part of the iris the photograph shows: not lids, not lashes, not glints, not the limbus.

Lids are two smooth curves across the eye; each pixel says by its colour whether it looks like the
iris at its distance from the pupil, as the sides that lids never cover show it. Knows no anatomy
but the eye's axes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.unrefraction.texels import Texels

Field = npt.NDArray[np.float32]
Mask = npt.NDArray[np.bool_]

GRID_PX: Final = 256  # of the map on which lids are searched: 0.047 mm
SIDE_DEG: Final = 38.0  # lids are never nearer than this to the line between their corners
LID_MARGIN_MM: Final = 0.3  # wet edge and shadow of a lid's rim
RINGS: Final = 24
BLACK: Final = 1.4  # in the logarithm: darker against its ring than any shade of a lid
GLINT_MARGIN_MM: Final = 0.08
LIMBUS_CLEAR: Final = 0.85  # where less light than this comes from the iris, it is not used


@dataclass(frozen=True)
class Lids:
    """Upper and lower lid over the map's columns: y in mm, one value per grid column.

    ``alien`` (GRID_PX, GRID_PX) marks single texels that look unlike any iris.
    """

    x_mm: Field
    upper_mm: Field
    lower_mm: Field
    alien: Mask


def find_lids(colour: Field, texels: Texels, *, clear: Field) -> Lids:
    """Return where lids end, from the map's linear colours (n, n, 3) at n = GRID_PX.

    ``clear`` is the share of light that the limbus lets through. Lids that hide nothing lie
    outside.
    """
    inside = (clear > LIMBUS_CLEAR) & (texels.radius_mm > 2.1)
    alien = _strangeness(colour, texels, inside)
    line = texels_line(GRID_PX)
    upper, lower = _lid(alien, inside), _lid(alien[::-1], inside[::-1])
    return Lids(line, upper, -lower, ndimage.binary_dilation(alien > 2.0, iterations=2))


def texels_line(size_px: int) -> Field:
    """Return the coordinates in mm of the texels along one side of a map."""
    return (((np.arange(size_px) + 0.5) / size_px * 2 - 1) * 6.0).astype(np.float32)


def _strangeness(colour: Field, texels: Texels, inside: Mask) -> Field:
    """Return evidence per texel against iris (> 0) or for it (< 0), around -1 to 4."""
    smooth = ndimage.gaussian_filter(np.log(np.maximum(colour, 1e-3)), (2.5, 2.5, 0))
    features = np.stack(
        [smooth.mean(axis=-1), smooth[..., 0] - smooth[..., 1], smooth[..., 1] - smooth[..., 2]],
        axis=-1,
    )
    angle = np.degrees(texels.angle)
    sides = np.minimum(np.abs(angle), 180 - np.abs(angle)) < SIDE_DEG
    ring = np.clip((texels.radius_mm - 2.0) / 3.85 * RINGS, 0, RINGS).astype(int)
    evidence = np.zeros(ring.shape, np.float32)
    for number in range(RINGS):
        here = inside & (ring == number)
        known = features[here & sides]
        if len(known) < 8:
            continue
        middle = np.median(known, axis=0)
        spread = 1.4826 * np.median(np.abs(known - middle), axis=0) + [0.20, 0.06, 0.06]
        far = (features[here] - middle) / spread
        # Lids shade the iris below them: darkness alone is weaker evidence than light or hue.
        light = np.where(far[:, 0] > 0, far[:, 0], -0.4 * far[:, 0])
        light[features[here][:, 0] < middle[0] - BLACK] = 8.0
        evidence[here] = np.clip(
            np.maximum(light, np.abs(far[:, 1:]).max(axis=-1)) - 4.2, -1.0, 4.0
        )
    return evidence


def _lid(alien: Field, inside: Mask) -> Field:
    """Return the parabola above which a map's texels look least like iris, per column in mm.

    The best of all parabolas y = top - bend x^2 + tilt x by the evidence above them.
    """
    n = alien.shape[0]
    line = texels_line(n)
    texel = 12.0 / n
    # Evidence summed from each row to the top: what a lid down to there would explain.
    above = np.cumsum((alien * inside)[::-1], axis=0)[::-1]
    above = np.concatenate([above, np.zeros((1, n))], axis=0)
    columns = np.arange(0, n, 4)
    x = line[columns].astype(np.float64)
    best, found = 0.0, np.full(n, 7.0)
    for top in np.arange(0.6, 6.0, 0.1):
        for bend in np.linspace(-0.02, 0.10, 7):
            for tilt in (-0.24, -0.16, -0.08, 0.0, 0.08, 0.16, 0.24):
                y = top - bend * x * x + tilt * x
                row = np.clip(np.rint((y + 6.0) / texel), 0, n).astype(int)
                gain = float(above[row, columns].sum())
                if gain > best:
                    best = gain
                    found = top - bend * line * line + tilt * line
    # A few odd texels are no lid.
    return found.astype(np.float32) if best > 0.004 * n * n else np.full(n, 7.0, np.float32)


def between_lids(lids: Lids, size_px: int) -> Mask:
    """Return which texels of a map lie between the lids, a margin kept."""
    line = texels_line(size_px)
    upper = np.interp(line, lids.x_mm, lids.upper_mm) - LID_MARGIN_MM
    lower = np.interp(line, lids.x_mm, lids.lower_mm) + LID_MARGIN_MM
    step = size_px // GRID_PX
    alien = np.repeat(np.repeat(lids.alien, step, axis=0), step, axis=1)
    inside = (line[:, None] < upper[None, :]) & (line[:, None] > lower[None, :])
    return np.asarray(inside & ~alien)


def find_glints(picture: Field, *, px_per_mm: float) -> Mask:
    """Return which pixels of a linear picture (height, width, 3) are burnt out or mirror a light.

    A glint is nearly white and much brighter than what lies around it. A margin is kept.
    """
    low = picture.min(axis=-1)
    around = ndimage.median_filter(low[::4, ::4], size=max(3, int(0.35 * px_per_mm) | 1))
    rows, columns = (
        np.minimum(np.arange(n) // 4, m - 1) for n, m in zip(low.shape, around.shape, strict=True)
    )
    around = around[rows[:, None], columns[None, :]]
    glint = (low > 0.93) | ((low > 0.25) & (low > 2.5 * around + 0.12))
    reach = max(1, round(GLINT_MARGIN_MM * px_per_mm))
    return np.asarray(ndimage.distance_transform_edt(~glint) <= reach) if glint.any() else glint


def find_lashes(colour: Field, texel_mm: float) -> Mask:
    """Return dark hairs on a map's linear colours (n, n, 3): thin, and nearly black.

    Crypts are as dark relative to their surroundings only where they are wider than a lash.
    """
    light = np.asarray(colour.mean(axis=-1), np.float32)
    reach = max(3, int(0.30 / texel_mm) | 1)
    closed = ndimage.grey_closing(light, size=(reach, reach))
    dark = light < 0.22 * closed
    hair = ndimage.binary_opening(dark, iterations=1)
    labels, count = ndimage.label(hair)
    if count == 0:
        return hair
    boxes = ndimage.find_objects(labels)
    long = [max(s.stop - s.start for s in box) * texel_mm > 1.0 for box in boxes]
    return np.asarray(
        ndimage.binary_dilation(np.concatenate([[False], long])[labels], iterations=2)
    )
