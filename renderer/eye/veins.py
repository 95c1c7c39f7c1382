"""Grow the vessels of the white of the eye as trees of tubes.

Flat coordinates in millimetres of arc from the gaze axis (azimuthal equidistant), nose towards +x.
Knows no colour: a tube's crest is its optical density.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from renderer.textures.noise import noise_1d
from renderer.textures.tubes import Tubes, join_tubes

Array = npt.NDArray[np.float32]

STEP_MM: Final = 0.016


@dataclass(frozen=True)
class Growth:
    """How one kind of vessel grows.

    ``meander`` in radians at the lengths ``wander_mm`` (broad, fine); ``children`` per mm of
    parent; ``generations`` of branches; ``thinning`` of width per generation; ``home`` is how
    strongly the heading turns to the cornea; ``stop_mm`` the nearest distance to the gaze axis.
    """

    meander: tuple[float, float]
    wander_mm: tuple[float, float]
    children: float
    generations: int
    thinning: float
    home: float
    stop_mm: float


# Tortuous trees and hairs in the conjunctiva; straighter, wider ones in the episclera underneath.
# Trees fade out 1 mm before the limbus (at 6.12 mm of arc), where the arcades stand alone.
CONJUNCTIVAL: Final = Growth((0.75, 0.50), (0.85, 0.26), 0.50, 4, 0.70, 0.8, 7.2)
EPISCLERAL: Final = Growth((0.35, 0.15), (1.80, 0.50), 0.30, 3, 0.75, 1.0, 6.9)
ARCADE: Final = Growth((0.50, 0.50), (0.40, 0.15), 0.90, 2, 0.90, 0.0, 4.5)
CAPILLARY: Final = Growth((0.90, 0.70), (0.50, 0.16), 0.60, 2, 0.85, 0.3, 6.9)


@dataclass(frozen=True)
class Shoots:
    """Branches before they grow: where, in which direction, how long, wide and dense."""

    x_mm: Array
    y_mm: Array
    heading: Array
    length_mm: Array
    half_width_mm: Array
    density: Array


def grow(shoots: Shoots, growth: Growth, seed: int) -> Tubes:
    """Grow shoots and their branches' branches into tubes."""
    rng = np.random.Generator(np.random.PCG64([seed, 0x7EE5]))
    parts = []
    for generation in range(growth.generations):
        if shoots.x_mm.size == 0:
            break
        tubes, heading = _extend(shoots, growth, seed * 8 + generation, emerges=generation == 0)
        parts.append(tubes)
        shoots = _branch(tubes, heading, growth, rng)
    return join_tubes(parts)


def _extend(shoots: Shoots, growth: Growth, key: int, *, emerges: bool) -> tuple[Tubes, Array]:
    """Walk all shoots at once; return their tubes and each point's heading.

    Shoots that emerge come up from the depth: they begin faint, without a blunt end. All fade
    before the distance where they stop.
    """
    count = shoots.x_mm.size
    steps = np.maximum((shoots.length_mm / STEP_MM).astype(np.int64), 8)
    longest = int(steps.max())
    line = np.arange(count)
    position = np.arange(longest, dtype=np.float32)[:, None] * np.float32(STEP_MM)
    lines = np.broadcast_to(line, (longest, count))
    turn = np.zeros((longest, count), np.float32)
    for amplitude, cell_mm, salt in zip(growth.meander, growth.wander_mm, (1, 2), strict=True):
        places = np.broadcast_to(position / np.float32(cell_mm), (longest, count))
        turn += np.float32(amplitude) * noise_1d(lines, places, key * 4 + salt)
    x, y = np.empty((longest, count), np.float32), np.empty((longest, count), np.float32)
    headings = np.empty((longest, count), np.float32)
    x[0], y[0], course = shoots.x_mm, shoots.y_mm, shoots.heading.copy()
    for step in range(longest):
        if step:
            x[step] = x[step - 1] + np.float32(STEP_MM) * np.cos(headings[step - 1])
            y[step] = y[step - 1] + np.float32(STEP_MM) * np.sin(headings[step - 1])
        # The course turns slowly to the cornea; the meander goes on top and leaves no trace.
        aim = np.arctan2(-y[step], -x[step])
        off = np.mod(aim - course + np.pi, 2.0 * np.pi) - np.pi
        course = course + (growth.home * STEP_MM / 2.0 * off).astype(np.float32)
        headings[step] = course + turn[step]
    radius = np.hypot(x, y)
    alive = np.arange(longest)[:, None] < steps
    alive &= np.minimum.accumulate(radius, axis=0) > growth.stop_mm
    along = np.arange(longest)[:, None] / steps
    swell = 1.0 + 0.15 * noise_1d(lines, np.broadcast_to(position / 0.5, turn.shape), key * 4 + 3)
    surfacing = np.clip((radius - growth.stop_mm) / 1.2, 0.0, 1.0)
    if emerges:
        surfacing = surfacing * np.clip(position / np.minimum(1.6, 0.3 * shoots.length_mm), 0, 1)
    shrink = (1.0 - 0.45 * along) * swell
    keep = alive.T
    tubes = Tubes(
        x_mm=x.T[keep],
        y_mm=y.T[keep],
        half_width_mm=(shoots.half_width_mm * shrink).T[keep].astype(np.float32),
        crest=(shoots.density * surfacing * (1.0 - 0.6 * along**2)).T[keep].astype(np.float32),
        drop=np.full(int(keep.sum()), 0.9, np.float32),
        tone=np.zeros(int(keep.sum()), np.float32),
        tube=np.repeat(line, keep.sum(axis=1)),
    )
    return tubes, headings.T[keep]


def _branch(tubes: Tubes, heading: Array, growth: Growth, rng: np.random.Generator) -> Shoots:
    """Pick points along tubes where a thinner branch leaves at 20 to 60 degrees."""
    chance = growth.children * STEP_MM
    chosen = np.flatnonzero(rng.random(tubes.tube.size) < chance)
    side = np.where(rng.random(chosen.size) < 0.5, -1.0, 1.0)
    angle = heading[chosen] + side * np.radians(rng.uniform(20.0, 60.0, chosen.size))
    length = rng.gamma(2.0, 1.3, chosen.size)
    return Shoots(
        x_mm=tubes.x_mm[chosen],
        y_mm=tubes.y_mm[chosen],
        heading=angle.astype(np.float32),
        length_mm=np.clip(length, 0.4, 7.0).astype(np.float32),
        half_width_mm=(tubes.half_width_mm[chosen] * growth.thinning).astype(np.float32),
        density=(tubes.crest[chosen] * rng.uniform(0.55, 0.95, chosen.size)).astype(np.float32),
    )


def trunks(
    rng: np.random.Generator,
    count: int,
    *,
    start_mm: tuple[float, float],
    half_width_mm: tuple[float, float],
    density: tuple[float, float],
    length_mm: tuple[float, float],
) -> Shoots:
    """Place shoots that head for the cornea, most of them from the two canthi."""
    share = rng.random(count)
    from_nose = rng.normal(0.0, 0.55, count)
    from_temple = rng.normal(np.pi, 0.55, count)
    anywhere = rng.uniform(0.0, 2.0 * np.pi, count)
    where = np.where(share < 0.42, from_nose, np.where(share < 0.78, from_temple, anywhere))
    distance = rng.uniform(*start_mm, count)
    return Shoots(
        x_mm=(distance * np.cos(where)).astype(np.float32),
        y_mm=(distance * np.sin(where)).astype(np.float32),
        heading=(where + np.pi + rng.normal(0.0, 0.5, count)).astype(np.float32),
        length_mm=rng.uniform(*length_mm, count).astype(np.float32),
        half_width_mm=rng.uniform(*half_width_mm, count).astype(np.float32),
        density=rng.uniform(*density, count).astype(np.float32),
    )


def arcades(rng: np.random.Generator, count: int, *, limbus_mm: float) -> Shoots:
    """Place the fine loops that stand around the limbus and point away from the cornea."""
    where = rng.uniform(0.0, 2.0 * np.pi, count)
    distance = limbus_mm + rng.uniform(0.15, 0.45, count)
    return Shoots(
        x_mm=(distance * np.cos(where)).astype(np.float32),
        y_mm=(distance * np.sin(where)).astype(np.float32),
        heading=(where + rng.normal(0.0, 0.5, count)).astype(np.float32),
        length_mm=rng.gamma(3.0, 0.22, count).astype(np.float32),
        half_width_mm=rng.uniform(0.006, 0.012, count).astype(np.float32),
        density=rng.uniform(0.06, 0.26, count).astype(np.float32),
    )
