"""Take the light off an iris: what the cornea mirrors, what the limbus veils, what falls unevenly.

From what a photograph shows to what the tissue reflects. How bright the light was, no photograph
says; the white of the eye serves as the white card.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.eye.chamber import chamber_irradiance
from renderer.iris.maps import IRIS_RADIUS_MM, PUPIL_RADIUS_MM
from renderer.unrefraction.limbus import Limbus
from renderer.unrefraction.limbus_fit import SCLERA, mirrored
from renderer.unrefraction.texels import Field, Texels

Mask = npt.NDArray[np.bool_]

# An iris in its maps' colours is drawn 1 / 0.89 times as bright as sclera of the same reflectance:
# the maps hold what shows through a cornea (eyes.APPARENT_GAIN = 1.3 brightens them) and the layers
# take some of the light away (LAYERS_RETURN = 0.86 in shaders/subsurface.glsl, and the gain that
# renderer.eye.subsurface normalises in the clip's own light). Measured under an even sky with
# portraits at "ultra", blue and brown alike within 2 %: change either and measure again, for
# test_unrefraction compares brightness without fitting any gain.
IRIS_TO_WHITE: Final = 0.89
CAST: Final = 1.5  # at most so much of a colour cast is taken for the light's
WAVES: Final = 2  # turns around the eye that light makes; tissue makes all
TISSUE_WAVES: Final = 6  # up to so many turns say how much tissue alone waves
TOO_STEEP: Final = 0.7  # of the logarithm: no light falls off further over an iris


def lift_veils(colour: Field, texels: Texels, *, limbus: Limbus, white: Field) -> Field:
    """Return a map's colours without mirrored light, sclera's veil and the cornea's losses."""
    veil = mirrored(colour, texels)
    share = np.maximum(limbus.clear(texels.surface_mm, texels.bearing), 0.2)[..., None]
    bright = (colour - veil) / limbus.dimmed(texels.surface_mm, texels.bearing)
    bare = (bright - (1.0 - share) * (white - veil)) / share
    return np.maximum(bare / np.maximum(texels.transmitted, 0.5)[..., None], 1e-4)


def even_light(colour: Field, texels: Texels, *, seen: Mask, pupil_mm: float) -> Field:
    """Return colours (n, n, 3) as under one even light.

    The light's fall towards the limbus is that of an even sky through the cornea. What then turns
    once or twice around the eye in smooth waves is taken for the light's as far as it exceeds what
    three to six turns show of the tissue's own sectors, so that a darkening of one half of an iris
    that stands out from them is lost, while colours and narrower sectors stay.
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
    lights = fitted[20:] * _lights_share(fitted[20:])
    basis = _wave_basis(texels.radius_mm, texels.angle)
    return np.asarray(np.clip(basis @ lights, -TOO_STEEP, TOO_STEEP), np.float32)


def _lights_share(waves: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return which share of each wave is the light's (Wiener): the rest is the tissue's own.

    Narrow sectors of tissue wave less than wide ones: their power is taken to fall as 1 / turns.
    """
    power = np.square(waves).reshape(-1, 2).sum(axis=-1)
    turns = np.arange(1, TISSUE_WAVES + 1)
    tissue = (turns * power)[WAVES:].mean() / turns
    share = np.clip(1.0 - tissue / np.maximum(power, 1e-12), 0.0, 1.0)
    share[WAVES:] = 0.0
    return np.repeat(share, 2)


def _wave_basis(r: Field, angle: Field) -> Field:
    """Return waves around the eye that grow from its middle, (..., 2 TISSUE_WAVES)."""
    reach = np.clip(r / 5.0, 0.0, 1.2)
    parts = [
        reach ** min(k, WAVES) * f(k * angle)
        for k in range(1, TISSUE_WAVES + 1)
        for f in (np.cos, np.sin)
    ]
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
