"""The sun in a photographed sky: found, measured and taken out. Pure numpy.

A cube map cannot cast shadows nor draw a catch-light sharply, so what is small and very bright
becomes a light of its own; what stays is ambient. Debevec 2005, "A median cut algorithm for light
probe sampling", does the same with many lights; a clear sky has one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.light import Vector
from renderer.park.lat_long import lat_long_directions, solid_angles
from renderer.park.sky import LUMINANCE

Radiance = npt.NDArray[np.float32]

BRIGHT: Final = 10.0  # times the mean: what lies above may belong to a sun; it is cut to this
PEAK: Final = 30.0  # times the mean: a sun's brightest texel is at least so bright
REACH_DEG: Final = 8.0  # around the peak: a sun with its aureole; larger lights are lamps, windows
SPILL: Final = 0.3  # beyond it, to twice as far, at most this share of the energy above BRIGHT
FAINTEST: Final = 0.05  # of the rest's irradiance: less than that casts no shadow worth drawing


@dataclass(frozen=True)
class SunAndRest:
    """A picture without its sun, the unit direction towards it and its irradiance (3,).

    The irradiance is that on a surface that faces the sun; it is zero where there is no sun, and
    the direction is then where most light comes from.
    """

    rest: Radiance
    direction: Vector
    irradiance: Vector


def separate_sun(radiance: Radiance) -> SunAndRest:
    """Take the sun out of a latitude-longitude picture (height, width, 3)."""
    height, width = radiance.shape[:2]
    luminance = radiance @ LUMINANCE.astype(np.float32)
    directions, weight = lat_long_directions(height, width), solid_angles(height, width)
    mean = _mean(luminance, weight)
    limit = BRIGHT * mean
    row, column = np.unravel_index(int(luminance.argmax()), luminance.shape)
    from_peak = directions @ directions[row, column]
    excess = np.maximum(luminance - limit, 0.0) * weight
    region = (from_peak > math.cos(math.radians(REACH_DEG))) & (excess > 0)
    around = from_peak > math.cos(math.radians(2 * REACH_DEG))
    inside, nearby = float(excess[region].sum()), float(excess[around].sum())
    is_small = nearby - inside <= SPILL * inside
    if luminance[row, column] <= PEAK * mean or not is_small or inside < FAINTEST * math.pi * mean:
        return SunAndRest(radiance, _unit((luminance * weight), directions), np.zeros(3))
    share = np.where(region, limit / np.maximum(luminance, 1e-12), 1.0).astype(np.float32)
    rest = radiance * share[..., None]
    direction = _unit(np.where(region, excess, 0.0), directions)
    facing = np.maximum(directions @ direction, 0.0) * weight
    removed = ((radiance - rest) * facing[..., None]).sum(axis=(0, 1), dtype=np.float64)
    return SunAndRest(rest, direction, np.asarray(removed))


def _mean(luminance: npt.NDArray[np.floating], weight: Vector) -> float:
    """Return the mean over the sphere without a sun: cut where one begins, until it settles."""
    mean = float((luminance * weight).sum() / (4 * math.pi))
    for _ in range(8):
        mean = float((np.minimum(luminance, BRIGHT * mean) * weight).sum() / (4 * math.pi))
    return mean


def _unit(weight: npt.NDArray[np.floating], directions: Vector) -> Vector:
    """Return the direction of the weighted mean, upwards where it has none."""
    total = np.einsum("ij,ijk->k", weight, directions)
    length = float(np.linalg.norm(total))
    return total / length if length > 1e-6 * weight.sum() else np.array([0.0, 1.0, 0.0])
