"""The numbers behind the crowd's motion: a stride's joint angles, slow drift. Pure numpy.

Angles in degrees, flexion and dorsiflexion positive.
"""

from __future__ import annotations

import functools
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

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


HIP, KNEE, ANKLE = (_stride_curve(knots) for knots in (_HIP, _KNEE, _ANKLE))


def stride_s(leg_mm: float) -> float:
    """Return the stride's duration at which the standing foot does not slide, for a leg's length.

    During stance (60 % of a stride) the ankle travels backwards as far as the body forwards.
    """
    phase = np.linspace(0.02, 0.58, 57)
    thigh, shank = np.radians(HIP(phase)), np.radians(HIP(phase) - KNEE(phase))
    ankle_z = leg_mm / 2 * (np.sin(thigh) + np.sin(shank))
    travel = float(ankle_z[0] - ankle_z[-1]) + _ROLL_MM
    return travel / float(phase[-1] - phase[0]) / WALK_SPEED_MM_S


def drift(time_s: float, seeds: tuple[int, ...]) -> Floats:
    """Return DRIFTS slow motions within -1 to 1 of each seed (f, DRIFTS).

    Each is the mean of three sines with periods of 3 to 11 seconds.
    """
    periods, starts = _sines(seeds)
    return np.asarray(np.sin(2 * np.pi * (time_s / periods + starts)).sum(axis=-1) / 2.2)


@functools.lru_cache(maxsize=64)
def _sines(seeds: tuple[int, ...]) -> tuple[Floats, Floats]:
    """Return periods in s and starts of the sines, (f, DRIFTS, 3) each."""
    drawn = []
    for seed in seeds:
        for channel in range(DRIFTS):
            rng = np.random.Generator(np.random.PCG64([seed, channel]))
            drawn.append((rng.uniform(3.0, 11.0, 3), rng.uniform(0.0, 1.0, 3)))
    table = np.array(drawn).reshape(len(seeds), DRIFTS, 2, 3)
    return table[:, :, 0], table[:, :, 1]
