"""Fits of ordinal models: the best parameters, their covariance, and a grid that is fine enough.

With priors the fit is the maximum of the posterior: small studies leave a person's spread at zero
and a separated cell at infinity otherwise. Without, it is the maximum likelihood.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.models.counts import Counts
from analysis.models.grids import (
    coarse_grid,
    first_grid,
    is_too_large,
    refined_grid,
    thinned,
)
from analysis.models.likelihood import log_likelihood
from analysis.models.optimum import Objective, climb, hessian, inverse_of
from analysis.models.ordinal import INCONSISTENCY, LENIENCY, STYLE, OrdinalModel
from analysis.models.priors import PRIORS, Priors
from analysis.models.quadrature import Grid

Floats = NDArray[np.float64]
_START_SD: Final[Mapping[str, float]] = {LENIENCY: 0.5, INCONSISTENCY: 0.2, STYLE: 0.2}
_FLAT: Final = "the data leave some parameters without an upper or lower bound"


@dataclass(frozen=True)
class OrdinalFit:
    """A fitted model. ``log_likelihood`` is without the priors; ``covariance`` is their sum's.

    ``warnings`` say in plain words what a reader must know: a grid at its limit, a direction in
    which the data say nothing; ``weights`` are those that people had.
    """

    model: OrdinalModel
    parameters: Floats
    covariance: Floats
    log_likelihood: float
    grid: Grid
    counts: Counts
    priors: Priors | None
    warnings: tuple[str, ...] = ()
    weights: Floats | None = None

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
    near: OrdinalFit | None = None,
) -> OrdinalFit:
    """Fit a model to counts; without ``priors`` by maximum likelihood.

    ``weights`` (n_people,) are those of a bootstrap. ``near`` is a fit of the same model to nearly
    the same answers, from where a few steps lead to this one's; one of other parameters is no help.
    ``start`` are parameters, and a ``grid`` is taken as it is. Raises ValueError for counts of
    another shape, or with a category that nobody used when there are no priors.
    """
    _check(model, counts, priors)
    problem = Problem(model, counts, priors, weights)
    if near is not None and near.model.names == model.names:
        return _refit(problem, near)
    parameters = _start(model, counts) if start is None else start
    inverse = None
    if grid is not None:
        return problem.finish(grid, climb(problem.target(grid), parameters)[0], [])
    if len(model.effects) > 1 and start is None:
        coarse = thinned(model, parameters, counts, coarse_grid(model))
        parameters, inverse = climb(problem.target(coarse), parameters)
    return _on_fine_grid(problem, parameters, inverse)


def _on_fine_grid(problem: Problem, parameters: Floats, inverse: Floats | None) -> OrdinalFit:
    """Climb to the optimum, and refine the grid until it no longer matters there."""
    model, counts = problem.model, problem.counts
    whole = first_grid(model, counts, parameters)
    warnings: list[str] = []
    while True:
        grid = thinned(model, parameters, counts, whole)
        parameters, inverse = climb(problem.target(grid), parameters, inverse=inverse)
        better = refined_grid(model, parameters, counts, grid, weights=problem.weights)
        if better is None:
            break
        if is_too_large(better):
            warnings.append(
                f"the integration grid stops at {max(whole.counts)} nodes in a direction; "
                "people gave so many answers that it should be finer"
            )
            break
        whole = better
    return problem.finish(grid, parameters, warnings)


def _refit(problem: Problem, near: OrdinalFit) -> OrdinalFit:
    """Step from an earlier fit to this one's optimum, on the earlier one's grid."""
    target = problem.target(near.grid)
    parameters = climb(target, near.parameters, inverse=near.covariance)[0]
    return problem.finish(near.grid, parameters, list(near.warnings))


@dataclass(frozen=True)
class Problem:
    """What is fitted to what."""

    model: OrdinalModel
    counts: Counts
    priors: Priors | None
    weights: Floats | None

    def value(self, parameters: Floats, grid: Grid) -> tuple[float, Floats]:
        return log_likelihood(self.model, parameters, self.counts, grid, weights=self.weights)

    def target(self, grid: Grid) -> Objective:
        """Return the negative log posterior (or likelihood) with its gradient as a function."""
        priors, kinds = self.priors, self.model.kinds
        means, sds = np.array([priors[kind] for kind in kinds]).T if priors else np.zeros((2, 0))

        def target(parameters: Floats) -> tuple[float, Floats]:
            value, gradient = self.value(parameters, grid)
            if not priors:
                return -value, -gradient
            away = (parameters - means) / sds
            return 0.5 * float(away @ away) - value, away / sds - gradient

        return target

    def finish(self, grid: Grid, parameters: Floats, warnings: list[str]) -> OrdinalFit:
        """Take the Newton step that BFGS's own stop leaves out, and invert the Hessian."""
        target = self.target(grid)
        covariance, is_flat = inverse_of(hessian(target, parameters))
        value, gradient = target(parameters)
        nearer = parameters - np.clip(covariance @ gradient, -0.5, 0.5)
        warnings = [warning for warning in warnings if warning != _FLAT]
        if is_flat:
            warnings = [*warnings, _FLAT]
        elif target(nearer)[0] <= value:
            parameters = nearer
        return OrdinalFit(
            self.model,
            parameters,
            covariance,
            self.value(parameters, grid)[0],
            grid,
            self.counts,
            self.priors,
            tuple(warnings),
            self.weights,
        )


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
    """Start at thresholds that fit all answers taken together, and differences of mean answers.

    Without those differences a climb may end where contrast and differences both have the wrong
    sign: a LoD that looks worse, or whose partner looks better, rates almost alike.
    """
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
    is_difference = np.array([kind == "location" for kind in model.kinds])
    if is_difference.any():
        own, middle = _differences(model, counts, parameters, is_difference)
        parameters[is_difference] = own
        parameters[0] += middle
    return parameters


def _differences(
    model: OrdinalModel, counts: Counts, parameters: Floats, which: NDArray[np.bool_]
) -> tuple[Floats, float]:
    """Regress stimuli's mean answers, in scatters of all answers; and where that puts the mean."""
    given = counts.table.sum(axis=0)
    total, grades = given.sum(axis=1), np.arange(model.categories)
    shown = total > 0
    mean = given[shown] @ grades / total[shown]
    everything = given.sum(axis=0)
    centre = everything @ grades / everything.sum()
    scatter = np.sqrt(everything @ (grades - centre) ** 2 / everything.sum())
    if not scatter > 0:
        return np.zeros(int(which.sum())), 0.0
    place = model.slices["location"]
    design = model.predictor.jacobian(parameters[place])[shown][:, which[place]]
    often = total[shown]
    with_level = np.column_stack([np.ones(len(often)), design])
    square = with_level.T @ (often[:, None] * with_level) + np.eye(with_level.shape[1])
    found = np.linalg.solve(square, with_level.T @ (often * (mean - centre) / scatter))
    return found[1:], float(often @ design @ found[1:] / often.sum())
