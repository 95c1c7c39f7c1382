"""From a fit to the best log-likelihood of a wider model that holds it: what a ratio test needs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from analysis.models.fitting import OrdinalFit, Problem
from analysis.models.optimum import climb
from analysis.models.ordinal import OrdinalModel
from analysis.models.priors import LOOSE

Floats = NDArray[np.float64]
_UNKNOWN = 0.1  # variance that a parameter starts with of which the narrower model knows nothing


def best_log_likelihood(wider: OrdinalModel, narrow: OrdinalFit) -> float:
    """Return the greatest log-likelihood of a model in which the fitted one is a special case.

    The parameters that the fitted one lacks are 0 there. Its optimum is the start, its covariance
    the first guess of the curvature, its grid that of the integral; LOOSE priors alone.
    """
    known = np.array([name in narrow.model.names for name in wider.names])
    place = np.flatnonzero(known)
    start = np.zeros(len(wider.names))
    start[place] = [narrow.value(wider.names[i]) for i in place]
    inverse = np.diag(np.full(len(start), _UNKNOWN))
    order = [narrow.model.names.index(wider.names[i]) for i in place]
    inverse[np.ix_(place, place)] = narrow.covariance[np.ix_(order, order)]
    problem = Problem(wider, narrow.counts, LOOSE, narrow.weights)
    best = climb(problem.target(narrow.grid), start, inverse=inverse)[0]
    return problem.value(best, narrow.grid)[0]
