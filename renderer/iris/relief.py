"""From an iris's plan to its relief: height, tone and cavity on the square of texels.

All lengths in millimetres on the iris plane; knows no colour.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.iris.layout import IrisLayout
from renderer.iris.openings import crypt_mask, furrow_mask
from renderer.iris.plane import HALF_SIZE_MM, Plane, blur
from renderer.iris.strands import iris_tubes
from renderer.textures.noise import Field, noise_grid, polar_noise, sample_polar
from renderer.textures.sizes import smoothstep
from renderer.textures.tubes import draw_tubes

RELIEF_MM: Final = 0.50


@dataclass(frozen=True)
class Relief:
    """What the fibres leave: ``height`` in [0, 1], higher fibres lying over lower ones;
    ``height_mm`` the surface's true relief; ``tone`` carried by the fibres;
    ``cavity`` 1 in the open and 0 in deep gaps, ``crypt`` and ``furrow`` masks, ``mist`` where a
    thin sheet softens the fibres; ``detail`` the height above the mean of its surroundings;
    ``deep`` 1 where the back of the stroma lies open.
    """

    height: Field
    height_mm: Field
    tone: Field
    cavity: Field
    crypt: Field
    furrow: Field
    mist: Field
    detail: Field
    deep: Field
    streaks: Field
    patches: Field


def _macro_height(plane: Plane) -> Field:
    """The iris's cross-section: thickest at the collarette, thinnest at the root."""
    beyond = plane.radius_mm - plane.collarette_mm
    hump = np.exp(-((beyond / np.float32(0.32)) ** 2))
    outer = smoothstep(0.0, 2.4, beyond)
    inner = smoothstep(0.0, -1.4, beyond)
    ridge = np.exp(-((beyond / np.float32(0.13)) ** 2))
    height = (
        np.float32(0.14) * hump
        + np.float32(0.06) * ridge
        - np.float32(0.16) * outer
        - np.float32(0.06) * inner
    )
    return np.asarray(height)


def build_relief(plane: Plane, layout: IrisLayout, seed: int, *, veil: float) -> Relief:
    """Draw the fibres and shape them into the relief; ``veil`` covers them with a sheet."""
    n = plane.size_px
    # Points closer than a texel, also where a strand runs slantwise to the radius.
    strands = iris_tubes(layout, seed, step_mm=1.2 * HALF_SIZE_MM / n)
    fibres, tone = draw_tubes(strands, n, half_size_mm=HALF_SIZE_MM)
    key = seed * 64
    streaks = sample_polar(
        polar_noise(512, 2048, cells=(9.0, 420), seed=key + 1)
        + 0.7 * polar_noise(512, 2048, cells=(22.0, 900), seed=key + 2),
        plane.radius01,
        plane.turns,
    )
    streaks *= smoothstep(5.95, 5.75, plane.radius_mm)
    patches = noise_grid(n, n, cells=(9.0, 9.0), seed=key + 3)
    patches += np.float32(0.5) * noise_grid(n, n, cells=(23.0, 23.0), seed=key + 4)
    patches *= smoothstep(5.95, 5.75, plane.radius_mm)
    grain = noise_grid(n, n, cells=(300.0, 300.0), seed=key + 5)
    crypt = crypt_mask(plane, layout.crypts, key + 10)
    furrow = furrow_mask(plane, layout)
    floor = 0.045 + 0.030 * streaks + 0.012 * grain
    bare = fibres <= floor
    height = np.maximum(fibres, floor)
    tone = np.where(bare, np.float32(0.10) + np.float32(0.07) * streaks, tone)
    mist = np.clip(veil + 0.16 * patches - 0.6 * crypt, 0.0, 0.9)
    height, tone = _cover(plane, (height, tone), mist, streaks)
    height = height * (1.0 - 0.35 * crypt) + _macro_height(plane) - 0.14 * furrow
    edge = smoothstep(0.0, 0.16, plane.radius_mm - plane.pupil_mm)
    height = np.clip(height * edge + 0.05, 0.0, 1.0).astype(np.float32)
    return Relief(
        height=height,
        height_mm=_surface_mm(height, n),
        tone=tone.astype(np.float32),
        cavity=_cavity(height, n),
        crypt=crypt,
        furrow=furrow,
        mist=mist.astype(np.float32),
        deep=np.maximum(crypt, smoothstep(0.24, 0.10, blur(fibres, 0.02, n))).astype(np.float32),
        detail=height - blur(height, 0.025, n),
        streaks=streaks,
        patches=patches,
    )


def _cover(
    plane: Plane, fields: tuple[Field, Field], mist: Field, streaks: Field
) -> tuple[Field, Field]:
    """Lay the anterior border sheet over the fibres: smoothed relief with its own fine streaks."""
    height, tone = fields
    smooth = blur(height, 0.045, plane.size_px) + np.float32(0.03) * streaks
    soft_tone = blur(tone, 0.06, plane.size_px) + np.float32(0.05) * streaks
    covered = height + (np.maximum(smooth + 0.06, smooth) - height) * mist
    return covered, tone + (soft_tone - tone) * mist


def _surface_mm(height: Field, size_px: int) -> Field:
    """Return the surface's relief in mm: fibres are sunk in jelly, which fills most of each gap."""
    broad = blur(height, 0.07, size_px)
    surface = broad + np.float32(0.08) * (height - broad)
    return np.maximum(np.float32(RELIEF_MM) * surface, np.float32(0.0))


def _cavity(height: Field, size_px: int) -> Field:
    """Return ambient occlusion from how far a texel lies below its surroundings, three scales."""
    dark = np.zeros_like(height)
    for sigma_mm, weight in ((0.03, 0.9), (0.09, 0.8), (0.30, 0.6)):
        dark += np.float32(weight) * np.maximum(blur(height, sigma_mm, size_px) - height, 0.0)
    # 0.4 of relief below its surroundings at every scale is a hole that keeps a tenth of the sky.
    return np.asarray(np.exp(np.float32(-2.2) * dark))
