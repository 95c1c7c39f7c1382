"""Fits of ordinal models: the best parameters, their covariance, and a grid that is fine enough.

With priors the fit is the maximum of the posterior: small studies leave a person's spread at zero
and a separated cell at infinity otherwise. Without, it is the maximum likelihood.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from analysis.models.counts import Counts
from analysis.models.grids import first_grid, refined_grid
from analysis.models.likelihood import log_likelihood
from analysis.models.ordinal import INCONSISTENCY, LENIENCY, STYLE, OrdinalModel
from analysis.models.priors import PRIORS, Priors
from analysis.models.quadrature import Grid

Floats = NDArray[np.float64]
_START_SD: Final[Mapping[str, float]] = {LENIENCY: 0.5, INCONSISTENCY: 0.2, STYLE: 0.2}
_STEP: Final = 1e-5  # of the gradient's differences: its own error is about 1e-10
_MOST_NODES, _MOST_CELLS = 1281, 60_000  # in one direction, and in all


@dataclass(frozen=True)
class OrdinalFit:
    """A fitted model. ``log_likelihood`` is without the priors; ``covariance`` is their sum's.

    ``warnings`` say in plain words what a reader must know: a grid at its limit, a direction in
    which the data say nothing.
    """

    model: OrdinalModel
    parameters: Floats
    covariance: Floats
    log_likelihood: float
    grid: Grid
    counts: Counts
    priors: Priors | None
    warnings: tuple[str, ...] = ()

    def value(self, name: str) -> float:
        """Return one parameter; raises KeyError."""
        return float(self.parameters[self._at(name)])

    def standard_error(self, name: str) -> float:
        """Return one parameter's standard error; raises KeyError."""
        place = self._at(name)
        return float(np.sqrt(self.covariance[place, place]))

    def sd(self, effect: str) -> float:
        """Return people's standard deviation of an effect."""
        return float(np.exp(self.value(f"log_sd:{effect}")))

    def _at(self, name: str) -> int:
        if name not in self.model.names:
            raise KeyError(f"no parameter {name}; there are {', '.join(self.model.names)}")
        return self.model.names.index(name)


def fit(
    model: OrdinalModel,
    counts: Counts,
    *,
    priors: Priors | None = None,
    weights: Floats | None = None,
    start: Floats | None = None,
    grid: Grid | None = None,
) -> OrdinalFit:
    """Fit a model to counts; without ``priors`` by maximum likelihood.

    ``weights`` (n_people,) are those of a bootstrap; ``start`` and ``grid`` those of an earlier
    fit: then the grid is taken as it is. Raises ValueError for counts of another shape, or with a
    category that nobody used when there are no priors.
    """
    _check(model, counts, priors)
    finer = grid is None
    grid = grid or first_grid(model, counts)
    parameters = _start(model, counts) if start is None else start
    warnings: list[str] = []
    while True:
        target = _objective(model, counts, grid, priors, weights)
        parameters = _climb(target, parameters)
        value = log_likelihood(model, parameters, counts, grid, weights=weights)[0]
        better = (
            refined_grid(model, parameters, counts, grid, weights=weights, value=value)
            if finer
            else None
        )
        if better is None:
            break
        if max(better.counts) > _MOST_NODES or better.log_weights.size > _MOST_CELLS:
            warnings.append(
                f"the integration grid stops at {max(grid.counts)} nodes in a direction; "
                "people gave so many answers that it should be finer"
            )
            break
        grid = better
    covariance, flat = _covariance(target, parameters)
    if flat:
        warnings.append("the data leave some parameters without an upper or lower bound")
    return OrdinalFit(model, parameters, covariance, value, grid, counts, priors, tuple(warnings))


Objective = Callable[[Floats], tuple[float, Floats]]


def _objective(
    model: OrdinalModel,
    counts: Counts,
    grid: Grid,
    priors: Priors | None,
    weights: Floats | None,
) -> Objective:
    """Return the negative log posterior (or likelihood) and its gradient as a function."""
    means, sds = np.array([priors[kind] for kind in model.kinds]).T if priors else np.zeros((2, 0))

    def target(parameters: Floats) -> tuple[float, Floats]:
        value, gradient = log_likelihood(model, parameters, counts, grid, weights=weights)
        if not priors:
            return -value, -gradient
        away = (parameters - means) / sds
        return 0.5 * float(away @ away) - value, away / sds - gradient

    return target


def _climb(target: Objective, start: Floats) -> Floats:
    """Minimise by BFGS, then by a Newton step, which BFGS's own stop leaves out."""
    scale = max(1.0, float(np.abs(target(start)[1]).max()))

    def scaled(parameters: Floats) -> tuple[float, Floats]:
        value, gradient = target(np.clip(parameters, -30.0, 30.0))
        return value / scale, gradient / scale

    found = minimize(scaled, start, jac=True, method="BFGS", options={"gtol": 1e-6, "maxiter": 500})
    best = np.asarray(found.x, dtype=float)
    hessian = _hessian(target, best)
    value, gradient = target(best)
    try:
        step = np.linalg.solve(hessian, gradient)
    except np.linalg.LinAlgError:
        return best
    trial = best - np.clip(step, -0.5, 0.5)
    return trial if target(trial)[0] <= value else best


def _hessian(target: Objective, parameters: Floats) -> Floats:
    centre = target(parameters)[1]
    rows = []
    for step in np.eye(len(parameters)) * _STEP:
        rows.append((target(parameters + step)[1] - centre) / _STEP)
    hessian = np.array(rows)
    result: Floats = (hessian + hessian.T) / 2
    return result


def _covariance(target: Objective, parameters: Floats) -> tuple[Floats, bool]:
    """Invert the Hessian; directions without curvature get a huge variance and are told."""
    values, vectors = np.linalg.eigh(_hessian(target, parameters))
    floor = max(1e-6, 1e-10 * float(values.max()))
    flat = bool((values < floor).any())
    return (vectors / np.maximum(values, floor)) @ vectors.T, flat


def _check(model: OrdinalModel, counts: Counts, priors: Priors | None) -> None:
    wanted = (model.predictor.stimuli, model.categories)
    if (counts.stimuli, counts.categories) != wanted:
        raise ValueError(
            f"counts: the model has {wanted[0]} stimuli and {wanted[1]} categories; "
            f"found {counts.stimuli} and {counts.categories}"
        )
    if counts.total == 0:
        raise ValueError("counts: no answer was given")
    unused = np.flatnonzero(counts.table.sum(axis=(0, 1)) == 0)
    if priors is None and len(unused):
        raise ValueError(
            f"counts: nobody used category {unused[0] + 1}; merge it with another or give priors"
        )


def _start(model: OrdinalModel, counts: Counts) -> Floats:
    """Start at thresholds that fit all answers taken together, and no differences."""
    share = counts.table.sum(axis=(0, 1)) + 0.5
    cut = model.link.quantile(np.cumsum(share)[:-1] / share.sum())
    parameters = np.zeros(len(model.names))
    parameters[0] = cut[0]
    parameters[1 : model.categories - 1] = np.log(np.maximum(np.diff(cut), 1e-3))
    spreads = [np.log(_START_SD[effect]) for effect in model.effects]
    parameters[model.slices["spread"]] = spreads
    for place, kind in enumerate(model.kinds):
        if kind in ("log_height", "middle", "log_width"):
            parameters[place] = PRIORS[kind][0]
    return parameters
