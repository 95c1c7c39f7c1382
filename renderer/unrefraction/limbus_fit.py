"""Measure the limbus of a photograph: where its edge lies, how soft it is, how dark its ring.

The half-way mark of the light alone would not do: it lies further out where the ring is darker or
the iris paler. The whole curve across the limbus tells edge, ring and both sides' light apart. It
is fitted to the sides first, which lids leave free, then edge and light to each direction.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage, optimize

from renderer.eye.anatomy import LIMBUS_WIDTH_MM
from renderer.iris.maps import PUPIL_RADIUS_MM
from renderer.unrefraction.limbus import EDGE_MM, IRIS_OF_WHITE, Limbus
from renderer.unrefraction.texels import Field, Texels

Array = npt.NDArray[np.float64]

SIDES_DEG: Final = 38.0  # lids never come nearer to the line between their corners
BINS_MM: Final = np.arange(4.6, 6.56, 0.05)
AT_MM: Final = 0.5 * (BINS_MM[1:] + BINS_MM[:-1])
INNER_MM, OUTER_MM = 4.8, 6.2  # where the fitted levels of iris and white are said
# Of the white's light: vessels, fibres, fine relief. Irises are most alike in red; in blue the thin
# sclera beside them has a colour of its own.
NOISE: Final = np.array([0.02, 0.04, 0.08])
RING_SPREAD: Final = 0.5  # of the ring's strength among eyes, as far as the curve leaves it open
LEAST_BINS: Final = 8
VEIL_PERCENTILE: Final = 40.0  # of the pupil: glints are brighter
SECTORS: Final = 72  # directions in which the edge is sought: 0.5 mm apart
LIGHT_SPREAD: Final = 0.4  # of a sector's iris and white about the sides' (a logarithm)
MISFIT: Final = 0.12  # of the white's light: more is a lid, a lash, a glint
# Linear Rec. 709 reflectance of healthy sclera within a millimetre of the iris: thinner there,
# hence bluer than the rest of the white (0.72, 0.66, 0.60; reference 1.6): renderer.eye.sclera.
SCLERA: Final = np.array([0.68, 0.627, 0.612], np.float32)

# Fitted: the limbus (edge, width, ring), then for each channel the iris's level and its fall per mm
# (a logarithm), the white's level and its growth per mm.
_LOW: Final = np.array([5.4, 0.04, 0.0, *[0.0, -3.0, 0.0, -0.05] * 3])
_HIGH: Final = np.array([6.05, 0.35, 1.5, *[2.0, 0.01, 4.0, 0.3] * 3])
_SCALE: Final = np.array([0.05, 0.02, 0.3, *[0.05, 0.5, 0.3, 0.1] * 3])


@dataclass(frozen=True)
class _Light:
    """Iris and white beside the limbus: levels and slopes, (3,) each."""

    iris: Array
    fall: Array
    white: Array
    growth: Array

    def across(self, limbus: Limbus, r: Array, bearing: Array) -> Array:
        """Return the light (n, 3) at points across the limbus."""
        clear = limbus.clear(r, bearing)[:, None]
        inside = self.iris * np.exp(self.fall * (r[:, None] - INNER_MM))
        outside = self.white * (1.0 + self.growth * (r[:, None] - OUTER_MM))
        drawn = clear * inside + (1.0 - clear) * outside
        return np.asarray(limbus.dimmed(r, bearing) * drawn)


def find_limbus(colour: Field, texels: Texels) -> tuple[Limbus, Field]:
    """Fit the veil to a map's colours (n, n, 3); return it and the white's colour (3,)."""
    near = (texels.surface_mm > BINS_MM[0]) & (texels.surface_mm < BINS_MM[-1] + 0.3)
    r, bearing, light = texels.surface_mm[near], texels.bearing[near], colour[near]
    sides = np.abs(np.sin(bearing)) < np.sin(np.radians(SIDES_DEG))
    tissue = light - mirrored(colour, texels)
    curve = _curve(r[sides], tissue[sides])
    known = np.isfinite(curve[:, 0])
    if known.sum() < LEAST_BINS:
        return Limbus(), SCLERA
    limbus, levels = _fitted(AT_MM[known], curve[known])
    limbus = replace(limbus, wander=_wander(limbus, levels, r, bearing=bearing, light=tissue))
    outside = sides & (r > limbus.middle_mm + 3.0 * limbus.width_mm)
    if outside.sum() <= 20:
        return limbus, np.asarray(curve[known][-1], np.float32)
    white = light[outside] / limbus.dimmed(r[outside], bearing[outside])
    return limbus, np.asarray(np.median(white, axis=0), np.float32)


def mirrored(colour: Field, texels: Texels) -> Field:
    """Return what the cornea mirrors (3,): the pupil is black but for that."""
    inner = colour[texels.radius_mm < 0.8 * PUPIL_RADIUS_MM]
    return np.asarray(np.percentile(inner, VEIL_PERCENTILE, axis=0), np.float32)


def _curve(r: Field, light: Field) -> Array:
    """Return the colour (bins, 3) at AT_MM; NaN where nothing was seen."""
    number = np.digitize(r, BINS_MM)
    bins = (light[number == k] for k in range(1, len(BINS_MM)))
    return np.array(
        [np.median(b, axis=0) if len(b) else np.full(3, np.nan) for b in bins], np.float64
    )


def _fitted(at: Array, curve: Array) -> tuple[Limbus, _Light]:
    noise = NOISE * max(float(curve.max()), 1e-6)  # per channel
    slanting = np.full_like(at, 0.6 * np.radians(SIDES_DEG))  # the sides' root mean square

    def parts(values: Array) -> tuple[Limbus, _Light]:
        edge, width, ring = (float(v) for v in values[:3])
        return Limbus(edge, width, ring), _Light(*values[3:].reshape(3, 4).T)

    def error(values: Array) -> Array:
        limbus, levels = parts(values)
        off = (levels.across(limbus, at, slanting) - curve) / noise
        return np.append(off, (limbus.ring - 1.0) / RING_SPREAD)

    first = [EDGE_MM, LIMBUS_WIDTH_MM, 1.0]
    for level in np.clip(curve[-1], 1e-4, 3.9):
        first += [min(IRIS_OF_WHITE * level, 1.9), -0.5, level, 0.0]
    fit = optimize.least_squares(error, first, bounds=(_LOW, _HIGH), x_scale=_SCALE)
    return parts(fit.x)


def _wander(
    limbus: Limbus, levels: _Light, r: Field, *, bearing: Field, light: Field
) -> tuple[float, ...]:
    """Return how many deviations further in the edge lies in each direction; 0 where unseen."""
    sector = np.rint(bearing / (2 * np.pi) * SECTORS).astype(int) % SECTORS
    found, weight = np.zeros(SECTORS), np.zeros(SECTORS)
    noise = NOISE * float(levels.white.max())
    for k in range(SECTORS):
        here = sector == k
        curve = _curve(r[here], light[here])
        known = np.isfinite(curve[:, 0])
        if known.sum() < LEAST_BINS:
            continue
        toward = np.full(known.sum(), k / SECTORS * 2 * np.pi)
        found[k], misfit = _one_way(
            limbus, levels, AT_MM[known], toward=toward, curve=curve[known], noise=noise
        )
        weight[k] = float(misfit < MISFIT)
    # Where nothing was seen, the edge comes back to its mean: it wanders over 2 mm.
    smooth = [ndimage.gaussian_filter1d(v, 0.5, mode="wrap") for v in (found * weight, weight)]
    share = smooth[0] / np.maximum(smooth[1], 0.5)
    return tuple(float(v) for v in share)


def _one_way(
    limbus: Limbus, levels: _Light, at: Array, *, toward: Array, curve: Array, noise: Array
) -> tuple[float, float]:
    """Return one direction's wandering and the misfit that is left, in shares of the white."""

    def drawn(values: Array) -> Array:
        lit = replace(
            levels, iris=levels.iris * np.exp(values[1]), white=levels.white * np.exp(values[2])
        )
        return lit.across(replace(limbus, wander=(float(values[0]),)), at, toward)

    def error(values: Array) -> Array:
        off = (drawn(values) - curve) / noise
        return np.concatenate([off.ravel(), values / [1.0, LIGHT_SPREAD, LIGHT_SPREAD]])

    fit = optimize.least_squares(error, np.zeros(3), bounds=([-3, -2, -2], [3, 2, 2]))
    misfit = np.sqrt(np.mean(np.square(drawn(fit.x) - curve))) / levels.white.max()
    return float(fit.x[0]), float(misfit)
