"""Profile-likelihood intervals: how far one parameter may move while all others follow.

Twice the fall of the log-likelihood (with the priors, where there are any) is held against a
chi-squared of one degree of freedom. Unlike estimate +- 1.96 standard errors this follows a
likelihood that is steeper on one side, as of a spread near zero or of a cell at the scale's end.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import chdtri

from analysis.models.fitting import OrdinalFit, Problem
from analysis.models.optimum import Objective, climb

Floats = NDArray[np.float64]
_FARTHEST: Final = 12.0  # standard errors; beyond, the data set no bound
_CLOSE: Final = 1e-3  # of a standard error


def profile_interval(
    found: OrdinalFit, name: str, *, confidence: float = 0.95
) -> tuple[float, float]:
    """Return the interval of one parameter, infinite where the data set no bound.

    Raises KeyError for a name of no parameter.
    """
    found.value(name)
    place = found.model.names.index(name)
    problem = Problem(found.model, found.counts, found.priors, found.weights)
    target = problem.target(found.grid)
    lowest = target(found.parameters)[0]
    allowed = float(chdtri(1, 1.0 - confidence)) / 2
    low, high = (_end(found, target, place, lowest + allowed, side) for side in (-1.0, 1.0))
    return low, high


def _end(found: OrdinalFit, target: Objective, place: int, limit: float, side: float) -> float:
    """Return where the profile crosses the limit on one side."""
    error = float(np.sqrt(found.covariance[place, place]))
    centre = float(found.parameters[place])
    known: dict[float, tuple[float, Floats]] = {}

    def excess(steps: float) -> float:
        if steps not in known:
            # From the nearest place on the fit's side: from beyond, the way back may end elsewhere.
            inner = max((own for own in known if own < steps), default=None)
            start = found.parameters if inner is None else known[inner][1]
            known[steps] = _profiled(found, target, place, centre + side * steps * error, start)
        return known[steps][0] - limit

    near, far = 0.0, 2.0
    while excess(far) < 0:
        near, far = far, far * 1.5
        if far > _FARTHEST:
            return side * np.inf
    steps = brentq(excess, near, far, xtol=_CLOSE)
    return centre + side * float(steps) * error


def _profiled(
    found: OrdinalFit, target: Objective, place: int, value: float, start: Floats
) -> tuple[float, Floats]:
    """Minimise over all other parameters; return the least value and where it lies."""
    others = np.arange(len(start)) != place
    known = found.covariance
    # What the others' covariance becomes once this parameter is known.
    own = (
        known[others][:, others]
        - np.outer(known[others, place], known[place, others]) / (known[place, place])
    )
    whole = start.copy()
    whole[place] = value

    def held(rest: Floats) -> tuple[float, Floats]:
        whole[others] = rest
        height, gradient = target(whole)
        return height, gradient[others]

    # Along the ridge the others move with this one: a first guess that saves most steps.
    ahead = start[others] + known[others, place] / known[place, place] * (value - start[place])
    rest = climb(held, ahead, inverse=own)[0] if others.any() else ahead
    height = held(rest)[0]
    return height, whole.copy()
