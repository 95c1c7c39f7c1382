"""Where things lie in an iris: collarette, crypts, furrows, freckles, and the regions between.

Millimetres on the iris plane around the pupil's centre, for a pupil of 2.0 mm radius. Knows no
texels and no colour. Proportions: Duane's Ophthalmology as summarised in
reference/eye-rendering.md, 1.4.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.iris.angles import ANGLES, closed_noise, over_angle

PUPIL_RADIUS_MM: Final = 2.0
IRIS_RADIUS_MM: Final = 5.85

Array = npt.NDArray[np.float32]


@dataclass(frozen=True)
class Crypts:
    """Lens-shaped openings: centres, half widths across and half lengths along the radius."""

    angle: Array
    radius_mm: Array
    half_width_mm: Array
    half_length_mm: Array
    depth: Array


@dataclass(frozen=True)
class Furrows:
    """Contraction furrows: partial arcs, each with its radius over the angle and its strength."""

    radius_mm: Array
    strength: Array
    half_width_mm: Array


@dataclass(frozen=True)
class Spots:
    """Round patches: freckles and nevi."""

    x_mm: Array
    y_mm: Array
    radius_mm: Array


@dataclass(frozen=True)
class IrisLayout:
    """The plan of one iris. Curves over the angle have ANGLES samples from angle 0."""

    collarette_mm: Array
    pupil_mm: Array
    cusp_angle: Array
    crypts: Crypts
    furrows: Furrows
    freckles: Spots


def plan_iris(seed: int, *, freckle_rate: float, crypt_rate: float) -> IrisLayout:
    """Lay out one iris; equal seeds give equal plans whatever the colour's rates draw."""
    rng = np.random.Generator(np.random.PCG64([seed, 0x1715]))
    cusps = _cusp_angles(rng)
    collarette = _collarette(rng, cusps, seed)
    crypts = _crypts(rng, cusps, collarette, crypt_rate)
    furrows = _furrows(rng, seed)
    freckles = _freckles(rng, freckle_rate)
    return IrisLayout(collarette, _pupil_edge(seed), cusps, crypts, furrows, freckles)


def _pupil_edge(seed: int) -> Array:
    """The ruff's inner edge: nearly round, with 60 to 80 small uneven crenations."""
    scallops = np.abs(closed_noise(140, seed, 11)) * 0.014 + closed_noise(7, seed, 12) * 0.008
    return np.asarray(PUPIL_RADIUS_MM + scallops - 0.012, np.float32)


def _cusp_angles(rng: np.random.Generator) -> Array:
    count = int(rng.integers(24, 38))
    gaps = rng.gamma(4.0, 1.0, count)
    return (np.cumsum(gaps / gaps.sum()) * 2.0 * np.pi + rng.uniform(0, 6)).astype(np.float32) % (
        np.float32(2.0 * np.pi)
    )


def _collarette(rng: np.random.Generator, cusps: Array, seed: int) -> Array:
    """Zigzag: outward cusps joined by arcs that sag towards the pupil, on a wandering circle."""
    order = np.argsort(cusps)
    cusps = cusps[order]
    reach = rng.normal(0.0, 0.115, cusps.size)
    sag = rng.gamma(2.5, 0.072, cusps.size)
    angle = np.arange(ANGLES) / ANGLES * 2.0 * np.pi
    left = (np.searchsorted(cusps, angle, side="right") - 1) % cusps.size
    right = (left + 1) % cusps.size
    width = np.mod(cusps[right] - cusps[left], 2.0 * np.pi) + 1e-6
    t = np.clip(np.mod(angle - cusps[left], 2.0 * np.pi) / width, 0.0, 1.0)
    skew = t ** np.exp(rng.normal(0.0, 0.35, cusps.size))[left]
    arc = np.sin(np.pi * skew) ** 0.8 * np.minimum(sag[left], 0.75 * width * 3.4)
    mean = PUPIL_RADIUS_MM + (IRIS_RADIUS_MM - PUPIL_RADIUS_MM) * rng.uniform(0.33, 0.42)
    radius = mean + reach[left] * (1 - t) + reach[right] * t - arc
    radius = radius + 0.10 * closed_noise(5, seed, 1) + 0.035 * closed_noise(60, seed, 2)
    return np.asarray(radius, np.float32)


def _crypts(rng: np.random.Generator, cusps: Array, collarette: Array, crypt_rate: float) -> Crypts:
    """Lenses of 0.015 to 0.3 mm2, most hugging the collarette, then small ones at the root.

    10 to 25 is the mean iris's count; some have nearly none, so the count itself is drawn widely.
    """
    hugging = round(int(rng.integers(4, 16)) * crypt_rate)
    free = round(int(rng.integers(1, 8)) * crypt_rate)
    marginal = round(int(rng.integers(8, 22)) * crypt_rate)
    area = np.exp(rng.uniform(np.log(0.03), np.log(0.30), hugging + free))
    slender = rng.uniform(1.1, 3.4, hugging + free)
    # A lens of half axes a and b has the area 8 a b / 3 (parabolic sides).
    half_width = np.sqrt(area * 3.0 / 8.0 / slender)
    half_length = half_width * slender
    # Sorting cusps first makes the arcs between neighbours; a crypt sits in an arc's middle.
    ordered = np.sort(cusps)
    widths = np.mod(np.roll(ordered, -1) - ordered, 2.0 * np.pi)
    arc = rng.permutation(cusps.size)[np.arange(hugging) % cusps.size]
    angle = ordered[arc] + widths[arc] * rng.uniform(0.2, 0.8, hugging)
    inner = over_angle(collarette, angle.astype(np.float32))
    radius = inner + half_length[:hugging] * 0.85 + rng.exponential(0.12, hugging)
    free_radius = rng.uniform(3.9, 5.0, free)
    stretch = rng.uniform(1.2, 2.6, marginal)
    small = np.sqrt(np.exp(rng.uniform(np.log(0.015), np.log(0.05), marginal)) * 3 / 8 / stretch)
    return Crypts(
        angle=np.concatenate([angle, rng.uniform(0, 2 * np.pi, free + marginal)]).astype(
            np.float32
        ),
        radius_mm=np.concatenate([radius, free_radius, rng.normal(5.42, 0.10, marginal)]).astype(
            np.float32
        ),
        half_width_mm=np.concatenate([half_width, small]).astype(np.float32),
        half_length_mm=np.concatenate([half_length, small * stretch]).astype(np.float32),
        depth=np.concatenate(
            [rng.uniform(0.55, 1.0, hugging + free), rng.uniform(0.3, 0.8, marginal)]
        ).astype(np.float32),
    )


def _furrows(rng: np.random.Generator, seed: int) -> Furrows:
    """Two to five broken arcs, most in the ciliary zone's outer half."""
    count = int(rng.integers(2, 6))
    base = np.sort(rng.uniform(4.4, 5.4, count))
    radius = np.stack(
        [
            base[i] + 0.13 * closed_noise(7, seed, 40 + i) + 0.035 * closed_noise(44, seed, 60 + i)
            for i in range(count)
        ]
    )
    strength = np.stack(
        [
            np.clip(
                0.55 * closed_noise(6, seed, 80 + i)
                + 0.30 * closed_noise(31, seed, 90 + i)
                + rng.normal(0.12, 0.15),
                0.0,
                1.0,
            )
            for i in range(count)
        ]
    )
    return Furrows(
        radius_mm=radius.astype(np.float32),
        strength=strength.astype(np.float32),
        half_width_mm=rng.uniform(0.05, 0.11, count).astype(np.float32),
    )


def _freckles(rng: np.random.Generator, rate: float) -> Spots:
    count = int(rng.poisson(rate))
    angle = rng.uniform(0, 2 * np.pi, count)
    radius = rng.uniform(2.6, 5.5, count)
    return Spots(
        x_mm=(radius * np.cos(angle)).astype(np.float32),
        y_mm=(radius * np.sin(angle)).astype(np.float32),
        radius_mm=np.exp(rng.uniform(np.log(0.06), np.log(0.26), count)).astype(np.float32),
    )
