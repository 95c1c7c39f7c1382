"""The way to the top of a smooth objective, its curvature there, and a curvature's inverse.

Knows nothing of models: an objective gives its value, to be minimised, and its gradient.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

Floats = NDArray[np.float64]
Objective = Callable[[Floats], tuple[float, Floats]]
_CLOSE: Final = 1e-6  # of the steepest gradient at the start
_NEAR: Final = 1e-3  # standard errors from the optimum: the last step is Newton's, by the caller
_FARTHEST: Final = 30.0  # on the latent scale; beyond, every probability is 0 or 1
_SILENT: Final = 0.01  # curvature of a direction with a standard error of 10: no answer at all
_STEP: Final = 1e-5  # of the gradient's differences: its own error is about 1e-10


def climb(
    target: Objective, start: Floats, *, inverse: Floats | None = None, near: float = _NEAR
) -> tuple[Floats, Floats]:
    """Minimise by BFGS; return the place and the inverse Hessian that BFGS believes in there.

    ``inverse`` is such a matrix near the optimum, where one is known: it saves most of the steps;
    ``near`` is then how many standard errors from the optimum are near enough.
    """
    scale = max(1.0, float(np.abs(target(start)[1]).max()))

    def scaled(parameters: Floats) -> tuple[float, Floats]:
        value, gradient = target(np.clip(parameters, -_FARTHEST, _FARTHEST))
        return value / scale, gradient / scale

    options: Any = {"gtol": _CLOSE, "maxiter": 500}
    if inverse is not None:
        errors = np.sqrt(np.maximum(np.diag(inverse), 0.0))
        steep = near / max(float(errors.max(initial=0.0)), _NEAR) / scale
        options = options | {"gtol": max(steep, _CLOSE), "hess_inv0": _positive(inverse * scale)}
    found = minimize(scaled, start, jac=True, method="BFGS", options=options)
    return np.asarray(found.x, dtype=float), _positive(np.asarray(found.hess_inv)) / scale


def _positive(matrix: Floats) -> Floats:
    """Return a symmetric matrix's nearest that is clearly positive definite."""
    values, vectors = np.linalg.eigh((matrix + matrix.T) / 2)
    found = (vectors * np.maximum(values, 1e-8 * max(float(values[-1]), 1e-8))) @ vectors.T
    return np.asarray((found + found.T) / 2)


def hessian(target: Objective, parameters: Floats) -> Floats:
    """Return the second derivatives (n, n) by differences of the gradient."""
    centre = target(parameters)[1]
    rows = []
    for step in np.eye(len(parameters)) * _STEP:
        rows.append((target(parameters + step)[1] - centre) / _STEP)
    found = np.array(rows)
    result: Floats = (found + found.T) / 2
    return result


def inverse_of(curvature: Floats) -> tuple[Floats, bool]:
    """Invert a Hessian; say whether the data are silent in some direction."""
    values, vectors = np.linalg.eigh(curvature)
    inverse = (vectors / np.maximum(values, 1e-6)) @ vectors.T
    return (inverse + inverse.T) / 2, bool((values < _SILENT).any())
