"""The four layers of an iris for subsurface texture mapping: thickness maps and coefficients.

Artist-calibrated, not measured: no table of iris tissue could be read (reference/eye-rendering.md,
1.5 and 2.3). The coefficients are built so that a marched column keeps the family's hue whether it
is thin (reflectance follows sigma_s) or thick (reflectance follows sigma_s / sigma_t).
"""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.colour import luminance, srgb_to_linear
from renderer.eye.subsurface import Tissue
from renderer.iris.layout import IRIS_RADIUS_MM
from renderer.iris.pigment import Family, family
from renderer.iris.plane import Plane, blur
from renderer.iris.relief import Relief
from renderer.textures.noise import Field
from renderer.textures.sizes import shrink, smoothstep

# Piecewise-linear marching with a few nodes is right for features of 0.22 mm and more
# (reference/eye-rendering.md, 2.3): a Gaussian of this width leaves 1 % at half that wavelength.
BAND_LIMIT_MM: Final = 0.075
THICKNESS_SHARE: Final = 4  # the bake keeps thickness at a quarter of the colour's resolution


def build_thickness(plane: Plane, relief: Relief, albedo: Field, melanin: Field) -> Field:
    """Return the layers' thickness in mm, front to back, (n / 4, n / 4, 4).

    Border layer, front stroma (the fibres), back stroma, pigment epithelium. Brighter tissue is
    thicker front stroma (Francois et al. 2006, after the thesis's section 4.5); melanin thickens
    the border layer, crypts open it.
    """
    n = plane.size_px // THICKNESS_SHARE
    tissue = smoothstep(0.0, 0.15, plane.radius_mm - plane.pupil_mm)
    inside = (plane.radius_mm > plane.pupil_mm + 0.1) & (plane.radius_mm < IRIS_RADIUS_MM)
    bright = luminance(albedo)
    bright = bright / np.float32(bright[inside].mean(dtype=np.float64))
    closed = np.float32(1.0) - np.float32(0.85) * relief.crypt
    border = (np.float32(0.006) + np.float32(0.034) * melanin) * closed
    front = np.float32(0.12) * np.clip(bright, 0.1, 2.5)
    back = np.float32(0.10) + np.float32(0.30) * relief.height
    back = back * (np.float32(1.0) - np.float32(0.4) * relief.crypt) - 0.03 * relief.furrow
    sheet = np.full_like(border, 0.05)
    # On the shrunk grid the blur needs its own texel size.
    return np.stack(
        [
            blur(shrink((layer * tissue).astype(np.float32), n), BAND_LIMIT_MM, n)
            for layer in (border, front, back, sheet)
        ],
        axis=-1,
    )


def build_melanin(relief: Relief, core: Field, look: Family) -> Field:
    """Return the share of the border layer's full pigment, 0 to 1."""
    share = np.float32(look.veil) + core + np.float32(0.10) * relief.patches
    return np.clip(share, 0.0, 1.0).astype(np.float32)


def scattering(colour: str) -> Tissue:
    """Return the four layers' coefficients of a colour family.

    ``sigma_s`` and ``sigma_t`` are (4, 3) per mm and Rec. 709 channel, ``anisotropy`` (4,); layers
    front to back: border layer, front stroma, back stroma, pigment epithelium. Extinction is grey
    in the pigmented layers, so that their hue does not change with depth; the stroma loses little.
    """
    look = family(colour)
    stops = srgb_to_linear(look.stops).astype(np.float64)
    pigment = _hue(0.5 * srgb_to_linear(look.core) + 0.5 * srgb_to_linear(look.stops[2]))
    front, back = _hue(stops[2:5].mean(axis=0)), _hue(stops[3:5].mean(axis=0))
    # per mm: 20 is melanin's 35 to 96 (Donner and Jensen 2006) in a sheet that is partly pigment;
    # the stroma's 5 and 4 lie in the 1 to 6 of the reference's fit.
    sigma_s = np.stack([20.0 * 0.90 * pigment, 5.0 * front, 4.0 * back, 0.4 * pigment])
    sigma_t = np.stack([np.full(3, 20.0), sigma_s[1] + 0.6, sigma_s[2] + 0.9, np.full(3, 60.0)])
    return Tissue(sigma_s, sigma_t, np.array([0.25, 0.30, 0.30, 0.0]))


def _hue(colour: Field) -> Field:
    """Return a colour with its largest channel at 1."""
    return np.asarray(colour / np.max(colour))
