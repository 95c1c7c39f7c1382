"""From an iris's colours to its relief and its layers: a plausible guess, not a measurement.

Brighter tissue is taken for higher and thicker tissue, as Francois et al. 2009 do (thesis section
4.5). Berard et al. 2014 show that brightness says this only roughly: a pale deep fibre and a dark
high one are mistaken. The forms are those of the procedural iris (renderer.iris.layers, relief), so
that both kinds of iris look alike under the same light.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.colour import luminance
from renderer.eye.subsurface import Tissue, henyey_greenstein, subsurface_gain
from renderer.iris.maps import IRIS_RADIUS_MM, PUPIL_RADIUS_MM
from renderer.iris.plane import blur, enlarge
from renderer.textures.sizes import shrink, smoothstep

Field = npt.NDArray[np.float32]

STRAND_MM: Final = 0.025  # sigma of the fine mean: with BUNDLE_MM a band of 40 to 80 um strands
BUNDLE_MM: Final = 0.09
RELIEF_MM: Final = 0.5
THICKNESS_PX: Final = 512
MULTIPLE_SHARE: Final = 0.45  # as renderer.eye.maps has it, which needs GL; a test compares them
LEAST_SHADE: Final = 0.35  # no cavity or thin layer is brightened more than to 1 / 0.35
BAND_LIMIT_MM: Final = 0.075  # of the layers: see renderer.iris.layers


def build_height(albedo: Field, radius_mm: Field) -> tuple[Field, Field]:
    """Return the relief (n, n) from 0 to 1 and the openness of its cavities (n, n)."""
    n = albedo.shape[0]
    light = np.log2(np.maximum(luminance(albedo), 2e-3))
    fine, broad = blur(light, STRAND_MM, n), blur(light, BUNDLE_MM, n)
    wide = blur(light, 0.4, n)
    detail = np.clip(light - fine, -1.5, 1.5)
    height = 0.42 + 0.16 * np.tanh(fine - broad) + 0.07 * detail + 0.10 * np.tanh(broad - wide)
    height = height + _cross_section(radius_mm)
    edge = smoothstep(0.0, 0.16, radius_mm - np.float32(PUPIL_RADIUS_MM))
    height = np.clip(height * edge + 0.05, 0.0, 1.0).astype(np.float32)
    dark = sum(
        np.float32(weight) * np.maximum(blur(height, sigma, n) - height, 0.0)
        for sigma, weight in ((0.03, 0.9), (0.09, 0.8), (0.30, 0.6))
    )
    return height, np.exp(np.float32(-2.2) * np.asarray(dark, np.float32))


def surface_mm(height: Field) -> Field:
    """Return the surface's relief in mm: fibres are sunk in jelly that fills most of each gap."""
    broad = blur(height, 0.07, height.shape[0])
    return np.maximum(np.float32(RELIEF_MM) * (broad + np.float32(0.08) * (height - broad)), 0.0)


def _cross_section(radius_mm: Field) -> Field:
    """Return an iris's own profile: thickest 1.5 mm from the pupil, thinnest at the root."""
    beyond = radius_mm - np.float32(PUPIL_RADIUS_MM + 1.5)
    hump = np.exp(-((beyond / np.float32(0.4)) ** 2))
    fall = np.float32(0.16) * smoothstep(0.0, 2.4, beyond)
    return np.asarray(
        np.float32(0.12) * hump - fall - np.float32(0.06) * smoothstep(0.0, -1.4, beyond)
    )


def build_thickness(albedo: Field, height: Field, radius_mm: Field) -> Field:
    """Return border layer, front and back stroma, pigment epithelium in mm, (512, 512, 4)."""
    light = luminance(albedo)
    inside = (radius_mm > PUPIL_RADIUS_MM + 0.1) & (radius_mm < IRIS_RADIUS_MM)
    bright = light / np.float32(light[inside].mean(dtype=np.float64))
    tissue = smoothstep(0.0, 0.15, radius_mm - np.float32(PUPIL_RADIUS_MM))
    opening = smoothstep(0.30, 0.12, blur(height, STRAND_MM, len(height)))
    closed = 1.0 - np.float32(0.85) * opening
    border = (np.float32(0.006) + np.float32(0.034) * brownness(albedo)) * closed
    front = np.float32(0.12) * np.clip(bright, 0.1, 2.5)
    back = (0.10 + np.float32(0.30) * height) * (1.0 - np.float32(0.4) * opening)
    layers = (border, front, back, np.full_like(border, 0.05))
    n = min(THICKNESS_PX, len(height))
    return np.stack(
        [blur(shrink((part * tissue).astype(np.float32), n), BAND_LIMIT_MM, n) for part in layers],
        axis=-1,
    )


def brownness(albedo: Field) -> Field:
    """Return the share of the border layer's full pigment, 0 to 1, from colours (..., 3).

    Melanin absorbs blue most: red stands far above blue in brown tissue and below it in blue.
    """
    red, blue = albedo[..., 0], albedo[..., 2]
    ratio = (red - blue) / np.maximum(red + blue, 1e-3)
    return np.asarray(np.clip(0.15 + 1.1 * ratio, 0.0, 1.0), np.float32)


def scattering_of(mean_albedo: Field) -> Tissue:
    """Return the layers' coefficients for a mean colour (3,): see renderer.iris.layers."""
    mean = np.asarray(mean_albedo, dtype=np.float64)
    hue = mean / mean.max()
    # Melanin's own hue, where the whole is pale or blue: warm, and fully the iris's where brown.
    share = float(brownness(np.asarray(mean, np.float32)))
    pigment = share * hue + (1 - share) * np.array([1.0, 0.75, 0.5])
    sigma_s = np.stack([18.0 * pigment, 5.0 * hue, 4.0 * hue, 0.4 * pigment])
    sigma_t = np.stack([np.full(3, 20.0), sigma_s[1] + 0.6, sigma_s[2] + 0.9, np.full(3, 60.0)])
    return Tissue(sigma_s, sigma_t, np.array([0.25, 0.30, 0.30, 0.0]))


def layered_share(thickness_mm: Field, tissue: Tissue, *, mean_mm: Field) -> Field:
    """Return the share of their colour that layers (n, n, 4) reflect, (n, n, 3).

    What ``shaders/subsurface.glsl`` draws where layers lie flat, seen and lit along the axis: each
    layer's single scattering in closed form. 1 where the layers have their mean thickness.
    """
    phase = henyey_greenstein(-1.0, tissue.anisotropy)
    single = np.zeros((*thickness_mm.shape[:2], 3))
    left = np.ones_like(single)
    for layer in range(thickness_mm.shape[-1]):
        both_ways = 2.0 * tissue.sigma_t[layer]
        through = left * np.exp(-both_ways * thickness_mm[..., layer : layer + 1])
        single += tissue.sigma_s[layer] * phase[layer] * (left - through) / both_ways
        left = through
    white = np.pi * subsurface_gain(np.asarray(mean_mm, np.float64), tissue) * single
    return np.asarray(white + (1.0 - white) * MULTIPLE_SHARE, np.float32)


def unshaded(
    look: Field, height: Field, cavity: Field, radius_mm: Field
) -> tuple[Field, Field, Tissue]:
    """Split a look into colour (n, n, 3), layers in mm (512, 512, 4) and their coefficients.

    Gaps are dark in a photograph because they lie deep and their layers are thin. Whoever draws
    the maps adds both again, so both are taken out of the colour.
    """
    n = look.shape[0]
    tissue = (radius_mm > PUPIL_RADIUS_MM + 0.1) & (radius_mm < IRIS_RADIUS_MM)
    open_look = np.asarray(look / np.maximum(cavity, LEAST_SHADE)[..., None], np.float32)
    layers = build_thickness(open_look, height, radius_mm)
    scattering = scattering_of(open_look[tissue].mean(axis=0))
    coarse = shrink(tissue.astype(np.float32), layers.shape[0]) > 0.99
    mean = layers[coarse].mean(axis=0, dtype=np.float64)
    share = layered_share(layers, scattering, mean_mm=mean)
    share = np.stack([enlarge(share[..., c], n) for c in range(3)], axis=-1)
    share = np.where(tissue[..., None], np.maximum(share, LEAST_SHADE), np.float32(1.0))
    return np.clip(open_look / share, 0.0015, 0.95).astype(np.float32), layers, scattering
