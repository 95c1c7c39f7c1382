"""The numbers behind the crowd's motion: a stride's joint angles, slow drift. Pure numpy.

Angles in degrees, flexion and dorsiflexion positive.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline, PPoly

Floats = npt.NDArray[np.float64]

WALK_SPEED_MM_S: Final = 1300.0
_ROLL_MM: Final = 150.0  # from heel to ball: how far the ankle moves on over a standing foot
# Sagittal joint angles over one stride from heel contact, level walking at natural cadence, read
# off published means (after Winter 2009, "Biomechanics and Motor Control of Human Movement").
_HIP: Final = ((0.0, 22), (0.12, 19), (0.30, 4), (0.50, -11), (0.60, -6), (0.75, 17), (0.87, 25))
_KNEE: Final = ((0.0, 4), (0.13, 18), (0.28, 11), (0.42, 5), (0.60, 34), (0.72, 62), (0.87, 26))
_ANKLE: Final = ((0.0, 0), (0.07, -5), (0.25, 5), (0.45, 10), (0.60, -16), (0.72, -4), (0.87, 2))
DRIFTS: Final = 5  # slow motions of one figure that know nothing of each other


def _stride_curve(knots: tuple[tuple[float, float], ...]) -> CubicSpline:
    phase, angle = zip(*knots, strict=True)
    return CubicSpline([*phase, 1.0], [*angle, angle[0]], bc_type="periodic")


def _together(curves: Sequence[CubicSpline]) -> PPoly:
    """Return curves as one, of one value per curve: asking scipy takes longer than its answer."""
    knots = np.unique(np.concatenate([curve.x for curve in curves]))
    # A cubic is its own Taylor series.
    series = [
        [curve(knots[:-1], order) / math.factorial(order) for curve in curves]
        for order in (3, 2, 1, 0)
    ]
    return PPoly(np.moveaxis(np.array(series), 1, 2), knots, extrapolate="periodic")


HIP, KNEE, ANKLE = (_stride_curve(knots) for knots in (_HIP, _KNEE, _ANKLE))
_LEG: Final = _together((HIP, KNEE, ANKLE))
_LEGS_AT: Final = np.array([0.0, 0.5])  # of a stride: left, right


def stride_s(leg_mm: float) -> float:
    """Return the stride's duration at which the standing foot does not slide, for a leg's length.

    During stance (60 % of a stride) the ankle travels backwards as far as the body forwards.
    """
    phase = np.linspace(0.02, 0.58, 57)
    thigh, shank = np.radians(HIP(phase)), np.radians(HIP(phase) - KNEE(phase))
    ankle_z = leg_mm / 2 * (np.sin(thigh) + np.sin(shank))
    travel = float(ankle_z[0] - ankle_z[-1]) + _ROLL_MM
    return travel / float(phase[-1] - phase[0]) / WALK_SPEED_MM_S


def striding(time_s: float, strides_s: Floats) -> Floats:
    """Return ``actions.STRIDING`` (f, 8) of walkers whose strides last so long (f,)."""
    phase = time_s / strides_s
    beat = 2 * np.pi * phase
    legs = _LEG(phase[:, None] + _LEGS_AT).reshape(len(phase), -1)
    return np.column_stack([np.cos(beat), np.sin(beat), legs])


def idling(time_s: float, seeds: tuple[int, ...]) -> Floats:
    """Return ``actions.IDLING`` (f, 6), within -1 to 1, of people who stand about.

    Slow motions that know nothing of each other are the mean of three sines with periods of 3 to
    11 seconds; breath is one sine.
    """
    rates, starts, breath_starts = _sines(seeds)
    drift = np.sin(time_s * rates + starts).sum(axis=-1) / 2.2
    breath = np.sin(2 * np.pi * 0.26 * time_s + breath_starts)
    return np.column_stack([drift, breath])


def waving(time_s: float) -> float:
    """Return where a waving forearm is, -1 to 1: it swings 1.5 times a second."""
    slowly = math.sin(2 * math.pi * 0.31 * time_s)
    return math.sin(2 * math.pi * 1.5 * time_s) * (0.8 + 0.2 * slowly)


@functools.lru_cache(maxsize=64)
def _sines(seeds: tuple[int, ...]) -> tuple[Floats, Floats, Floats]:
    """Return rates per second and starts of the sines, (f, DRIFTS, 3), and breath's starts (f,)."""
    drawn = []
    for seed in seeds:
        for channel in range(DRIFTS):
            rng = np.random.Generator(np.random.PCG64([seed, channel]))
            drawn.append((1.0 / rng.uniform(3.0, 11.0, 3), rng.uniform(0.0, 1.0, 3)))
    table = 2 * np.pi * np.array(drawn).reshape(len(seeds), DRIFTS, 2, 3)
    return table[:, :, 0], table[:, :, 1], 2 * np.pi * 0.13 * np.array(seeds)
