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
from renderer.textures.tubes import Tubes, draw_tubes

RELIEF_MM: Final = 0.50
# Deep to high: how far light from below wanders in a deck in mm, the deck's opacity, and the
# heights between which a fibre's side turns from clear to opaque.
DEPTHS: Final = (
    (0.010, 0.80, 0.04, 0.28),
    (0.016, 0.85, 0.06, 0.46),
    (0.014, 0.92, 0.10, 0.64),
    (0.010, 0.95, 0.16, 0.80),
)


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
    decks = iris_tubes(layout, seed, step_mm=1.2 * HALF_SIZE_MM / n)
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
    nap = _nap(plane, key) + np.float32(0.35) * grain
    crypt = crypt_mask(plane, layout.crypts, key + 10)
    # Bundles bridge a furrow here and there.
    furrow = furrow_mask(plane, layout) * np.clip(0.75 + 0.30 * streaks, 0.0, 1.3)
    floor = 0.045 + 0.030 * streaks + 0.012 * grain
    fibres, tone = _weave(decks, np.float32(0.10) + np.float32(0.07) * streaks, n)
    height = np.maximum(fibres, floor)
    mist = np.clip(veil + 0.10 + 0.20 * patches - 0.7 * crypt, 0.0, 0.9)
    height, tone = _cover(plane, (height, tone), mist, nap)
    # A thick sheet folds deeper when the pupil widens than bare fibres do.
    height = height * (1.0 - 0.35 * crypt) + _macro_height(plane) - (0.10 + 0.14 * veil) * furrow
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


def _weave(decks: list[Tubes], floor: Field, size_px: int) -> tuple[Field, Field]:
    """Lay decks of fibres over each other; return the highest one's height and the tone seen.

    Fibres are translucent: round ones show what lies below at their sides, and light from a lower
    deck has wandered through those above, so that the deepest is the softest.
    """
    height, seen = np.zeros_like(floor), floor
    for (wander_mm, opacity, low, high), tubes in zip(DEPTHS, decks, strict=True):
        crest, tone = draw_tubes(tubes, size_px, half_size_mm=HALF_SIZE_MM)
        seen = blur(seen, wander_mm, size_px)
        seen += (tone - seen) * (np.float32(opacity) * smoothstep(low, high, crest))
        height = np.maximum(height, crest)
    return height, blur(seen, 0.004, size_px)


def _cover(
    plane: Plane, fields: tuple[Field, Field], mist: Field, nap: Field
) -> tuple[Field, Field]:
    """Lay the anterior border sheet over the fibres: their smoothed relief with its own nap."""
    height, tone = fields
    smooth = blur(height, 0.045, plane.size_px) + np.float32(0.06) + np.float32(0.035) * nap
    soft_tone = blur(tone, 0.06, plane.size_px) + np.float32(0.075) * nap
    return height + (smooth - height) * mist, tone + (soft_tone - tone) * mist


def _nap(plane: Plane, key: int) -> Field:
    """Return the sheet's velvet: radial folds as wide as strands, and some of twice that width."""
    polar = polar_noise(256, 4096, cells=(22.0, 330), seed=key + 20)
    polar += np.float32(0.6) * polar_noise(256, 4096, cells=(14.0, 140), seed=key + 21)
    return sample_polar(polar, plane.radius01, plane.turns)


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
