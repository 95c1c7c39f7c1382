"""Crypts of Fuchs and contraction furrows as masks over the texels."""

from __future__ import annotations

from typing import Final

import numpy as np

from renderer.iris.angles import angle_between
from renderer.iris.layout import Crypts, IrisLayout
from renderer.iris.plane import HALF_SIZE_MM, Plane
from renderer.textures.noise import Field, noise_grid
from renderer.textures.sizes import smoothstep

BEND_MM: Final = 0.05  # standard deviation by which a crypt's outline strays from a lens


def crypt_mask(plane: Plane, crypts: Crypts, seed: int) -> Field:
    """Return the depth of crypts at every texel, 0 outside, with soft sides."""
    mask = np.zeros_like(plane.radius_mm)
    bend_x = BEND_MM * noise_grid(plane.size_px, plane.size_px, cells=(44.0, 44.0), seed=seed + 1)
    bend_y = BEND_MM * noise_grid(plane.size_px, plane.size_px, cells=(44.0, 44.0), seed=seed + 2)
    for i in range(crypts.angle.size):
        reach = reach_mm(crypts.half_width_mm[i], crypts.half_length_mm[i])
        x = crypts.radius_mm[i] * np.cos(crypts.angle[i])
        y = crypts.radius_mm[i] * np.sin(crypts.angle[i])
        texels = [
            slice(
                max(0, int((c - reach + HALF_SIZE_MM) / HALF_SIZE_MM * plane.size_px / 2)),
                max(0, int((c + reach + HALF_SIZE_MM) / HALF_SIZE_MM * plane.size_px / 2) + 1),
            )
            for c in (y, x)
        ]
        window = (texels[0], texels[1])
        radius = plane.radius_mm[window] + bend_y[window]
        t = (radius - crypts.radius_mm[i]) / crypts.half_length_mm[i]
        offset = angle_between(plane.angle[window], crypts.angle[i]) * radius
        offset = offset + bend_x[window]
        lens = crypts.half_width_mm[i] * np.maximum(1.0 - (t / np.float32(1.25)) ** 2, 0.0)
        depth = smoothstep(0.0, 0.8, (lens - np.abs(offset)) / crypts.half_width_mm[i])
        mask[window] = np.maximum(mask[window], crypts.depth[i] * depth)
    return mask


def reach_mm(half_width_mm: float, half_length_mm: float) -> float:
    """Return how far from its centre a crypt may be seen: its lens, and what bends it."""
    return max(1.25 * half_length_mm, half_width_mm) + 3.0 * BEND_MM


def furrow_mask(plane: Plane, layout: IrisLayout) -> Field:
    """Return the depth of contraction furrows at every texel in [0, 1]."""
    mask = np.zeros_like(plane.radius_mm)
    furrows = layout.furrows
    for i in range(furrows.half_width_mm.size):
        centre = plane.around(furrows.radius_mm[i])
        strength = plane.around(furrows.strength[i])
        across = (plane.radius_mm - centre) / furrows.half_width_mm[i]
        # Steeper towards the pupil: the outer lip hangs over.
        across = across * np.where(across < 0.0, np.float32(1.3), np.float32(0.7))
        mask = np.maximum(mask, strength * np.exp(-across * across))
    return np.minimum(mask, np.float32(1.0))
