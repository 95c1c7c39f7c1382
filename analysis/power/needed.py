"""How many people a stated power takes, read between the numbers that were simulated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, inf, sqrt
from typing import Final

import numpy as np
from scipy.special import ndtri

POWER: Final = 0.8


@dataclass(frozen=True)
class Needed:
    """People for ``power``: a number and the range that the simulation's own error leaves.

    ``people`` is None where no simulated number reaches it, not even ``most``; ``is_at_most`` says
    that the smallest one does already. ``low`` and ``high`` are None beyond the simulated numbers.
    """

    power: float
    people: int | None
    low: int | None
    high: int | None
    most: int
    is_at_most: bool = False


def needed_people(
    people: Sequence[int],
    power: Sequence[float],
    *,
    low: Sequence[float],
    high: Sequence[float],
    wanted: float = POWER,
) -> Needed:
    """Return how many people reach ``wanted``; ``low`` and ``high`` bound each ``power``.

    The power of a test of normal law is Phi(a sqrt(n) - z): between two numbers of people its
    quantile is taken as straight in sqrt(n). Nothing is said beyond the numbers simulated.
    """
    middle = _crossing(people, power, wanted)
    least, most = _crossing(people, high, wanted), _crossing(people, low, wanted)
    return Needed(
        power=wanted,
        people=None if middle == inf else ceil(max(middle, people[0]) - 1e-9),
        low=None if least in (inf, -inf) else ceil(least - 1e-9),
        high=None if most in (inf, -inf) else ceil(most - 1e-9),
        most=max(people),
        is_at_most=middle == -inf,
    )


def _crossing(people: Sequence[int], power: Sequence[float], wanted: float) -> float:
    """Return where the power comes to ``wanted`` and stays: -inf at once, inf never."""
    z = [float(ndtri(np.clip(p, 1e-6, 1 - 1e-6))) for p in power]
    aim = float(ndtri(wanted))
    if not np.isfinite(z).all() or z[-1] < aim:
        return inf
    below = [i for i, value in enumerate(z) if value < aim]
    if not below:
        return -inf
    i = below[-1]
    part = (aim - z[i]) / (z[i + 1] - z[i])
    root = sqrt(people[i]) + part * (sqrt(people[i + 1]) - sqrt(people[i]))
    return root * root
