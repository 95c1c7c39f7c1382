"""Take the light off an iris: what the cornea mirrors, what the limbus veils, what falls unevenly.

From what a photograph shows to what the tissue reflects. How bright the light was, no photograph
says; the white of the eye serves as the white card.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage, optimize

from renderer.eye.chamber import chamber_irradiance
from renderer.iris.maps import IRIS_RADIUS_MM, PUPIL_RADIUS_MM
from renderer.unrefraction.texels import Field, Texels

Mask = npt.NDArray[np.bool_]

# Linear Rec. 709 reflectance of healthy sclera at the side of the iris (reference 1.6).
SCLERA: Final = np.array([0.72, 0.66, 0.60], np.float32)
# An iris in its maps' colours is drawn 1 / 0.88 times as bright as sclera of the same reflectance:
# the maps hold what shows through a cornea (eyes.APPARENT_GAIN = 1.3 brightens them) and the layers
# take some of the light away (LAYERS_RETURN = 0.86 in shaders/subsurface.glsl, and the gain that
# renderer.eye.subsurface normalises in the clip's own light). Measured under an even sky with
# portraits at "ultra", blue and brown alike within 1 %: change either and measure again, for
# test_unrefraction compares brightness without fitting any gain.
IRIS_TO_WHITE: Final = 0.88
CAST: Final = 1.5  # at most so much of a colour cast is taken for the light's
VEIL_PERCENTILE: Final = 40.0  # of the pupil, which is black but for what the cornea mirrors
WAVES: Final = 2  # turns of the light around the eye that are taken for light, not for tissue
TOO_STEEP: Final = 0.7  # of the logarithm: no light falls off further over an iris


@dataclass(frozen=True)
class Limbus:
    """The veil's shape: share of iris = 1 / (1 + exp((r - middle) / width)), r on the surface.

    Half-way the limbal ring dims both iris and veil to ``ring``; 1 is none.
    """

    middle_mm: float
    width_mm: float
    ring: float = 1.0

    def clear(self, surface_mm: Field) -> Field:
        """Return the share of light that comes from the iris."""
        far = np.clip((surface_mm - self.middle_mm) / self.width_mm, -30, 30)
        return np.asarray(1.0 / (1.0 + np.exp(far)), np.float32)

    def dimmed(self, surface_mm: Field) -> Field:
        """Return the share of light that the limbal ring leaves."""
        share = self.clear(surface_mm)
        edge = 4.0 * share * (1.0 - share)
        return np.asarray(1.0 + (self.ring - 1.0) * edge * edge, np.float32)


def find_limbus(colour: Field, texels: Texels) -> tuple[Limbus, Field]:
    """Fit the veil to the sides of a map's colours; return it and the sclera's colour (3,)."""
    angle = np.degrees(np.abs(texels.angle))
    sides = np.minimum(angle, 180 - angle) < 30
    r = texels.surface_mm[sides]
    light = colour[sides]
    bins = np.arange(4.9, 6.31, 0.05)
    number = np.digitize(r, bins)
    curve = np.array(
        [
            np.median(light[number == k], axis=0) if (number == k).any() else [np.nan] * 3
            for k in range(1, len(bins))
        ]
    )
    at = 0.5 * (bins[1:] + bins[:-1])
    known = np.isfinite(curve[:, 0])
    at, shade = at[known], curve[known].mean(axis=-1)
    if len(at) < 8:
        return Limbus(5.76, 0.15), SCLERA

    def error(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        iris, slope, sclera, middle, width, ring = values
        share = 1 / (1 + np.exp(np.clip((at - middle) / width, -30, 30)))
        dimmed = 1 + (ring - 1) * (4 * share * (1 - share)) ** 2
        drawn = dimmed * (share * (iris + slope * (at - 5.3)) + (1 - share) * sclera)
        return np.asarray(drawn - shade)

    fit = optimize.least_squares(
        error,
        [shade[0], 0.0, shade[-1], 5.76, 0.15, 0.8],
        bounds=([0, -0.3, 0, 5.4, 0.04, 0.3], [2, 0.0, 4, 6.0, 0.35, 1.0]),
    )
    limbus = Limbus(*(float(v) for v in fit.x[3:]))
    outside = r > limbus.middle_mm + 3.0 * limbus.width_mm
    white = np.median(light[outside], axis=0) if outside.sum() > 20 else curve[known][-1]
    return limbus, np.asarray(white, np.float32)


def lift_veils(colour: Field, texels: Texels, *, limbus: Limbus, white: Field) -> Field:
    """Return a map's colours without mirrored light, sclera's veil and the cornea's losses."""
    inner = colour[texels.radius_mm < 0.8 * PUPIL_RADIUS_MM]
    veil = np.percentile(inner, VEIL_PERCENTILE, axis=0).astype(np.float32)
    share = np.maximum(limbus.clear(texels.surface_mm), 0.2)[..., None]
    bright = colour / limbus.dimmed(texels.surface_mm)[..., None]
    bare = (bright - (1.0 - share) * white) / share - veil
    return np.maximum(bare / np.maximum(texels.transmitted, 0.5)[..., None], 1e-4)


def even_light(colour: Field, texels: Texels, *, seen: Mask, pupil_mm: float) -> Field:
    """Return colours (n, n, 3) as under one even light.

    The light's fall towards the limbus is that of an even sky through the cornea. What then turns
    once or twice around the eye in smooth waves is taken for the light's, so that a real
    darkening of one half of an iris is lost, while colours and narrower sectors stay.
    """
    true = np.where(
        texels.radius_mm < PUPIL_RADIUS_MM,
        texels.radius_mm,
        pupil_mm
        + (texels.radius_mm - PUPIL_RADIUS_MM)
        * ((IRIS_RADIUS_MM - pupil_mm) / (IRIS_RADIUS_MM - PUPIL_RADIUS_MM)),
    )
    fall = np.interp(true, *_sky_fall()).astype(np.float32)
    gradient = _smooth_waves(colour.mean(axis=-1) / fall, texels, seen)
    return np.asarray(colour / (fall * np.exp(gradient))[..., None], np.float32)


@lru_cache(maxsize=1)
def _sky_fall() -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Return radius in mm and irradiance, relative to the middle, under an even sky."""
    inside = chamber_irradiance(np.ones_like, np.eye(3), rims=None, size_px=32)[..., 1]
    edge = (np.arange(32) + 0.5) / 32 * 12 - 6
    line = 0.5 * (inside[15] + inside[16])[16:]
    radius = np.hypot(edge[16:], edge[16])
    return radius, np.maximum(line / line[:3].mean(), 0.25)


def _smooth_waves(light: Field, texels: Texels, seen: Mask) -> Field:
    """Return the logarithm of the light's part that waves around the eye, robustly fitted."""
    step = max(1, light.shape[0] // 256)
    coarse = ndimage.uniform_filter(np.log(np.maximum(light, 1e-4)), 2 * step)
    sparse = (slice(None, None, step), slice(None, None, step))
    use = seen[sparse] & (texels.radius_mm[sparse] < 5.2)
    value, r, angle = (f[sparse][use] for f in (coarse, texels.radius_mm, texels.angle))
    ring = np.clip((r - 2.0) / 0.2, 0, 19).astype(int)
    rings = np.eye(20)[ring]
    waves = _wave_basis(r, angle)
    design = np.concatenate([rings, waves], axis=1)
    weight: npt.NDArray[np.floating[Any]] = np.ones(len(value))
    ridge = np.concatenate([np.full(20, 1e-3), np.full(waves.shape[1], 2e-3 * len(value))])
    fitted = np.zeros(design.shape[1])
    for _ in range(4):
        normal = design.T @ (design * weight[:, None]) + np.diag(ridge)
        fitted = np.linalg.solve(normal, design.T @ (weight * value))
        off = np.abs(value - design @ fitted)
        weight = 1.0 / np.maximum(1.0, off / (1.5 * np.median(off) + 1e-6))
    basis = _wave_basis(texels.radius_mm, texels.angle)
    return np.clip(basis @ fitted[20:], -TOO_STEEP, TOO_STEEP).astype(np.float32)


def _wave_basis(r: Field, angle: Field) -> Field:
    """Return waves around the eye that grow from its middle, (..., 2 WAVES)."""
    reach = np.clip(r / 5.0, 0.0, 1.2)
    parts = [reach**k * f(k * angle) for k in range(1, WAVES + 1) for f in (np.cos, np.sin)]
    return np.stack(parts, axis=-1)


def to_reflectance(
    colour: Field, white: Field | None, *, is_monochrome: bool
) -> tuple[Field, float]:
    """Return reflectance, scaled by the sclera as white card, and the cast that was removed.

    ``white`` None means that no sclera is seen: the photograph's own levels are kept.
    """
    if white is None:
        return np.clip(colour, 0.0, 0.95), 1.0
    gain = np.asarray(IRIS_TO_WHITE * SCLERA / np.maximum(white, 0.02), np.float32)
    if is_monochrome:
        gain = np.full_like(gain, gain.mean())
    cast = np.clip(gain / gain[1], 1 / CAST, CAST)
    return np.clip(colour * (gain[1] * cast), 0.0015, 0.95), float(np.max(np.abs(np.log(cast))))
