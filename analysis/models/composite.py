"""Two ordinal models of the same people that share where the stimuli stand.

    l(mu, a, ...) = l_1(mu, ...) + l_2(a mu, ...)

Answers to one clip share a percept, so the two are not independent given the person: the sum is a
composite likelihood. Its maximum is consistent, its curvature promises too much; the covariance is
therefore the sandwich H^-1 J H^-1 with J from people's scores (Varin, Reid and Firth 2011).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from analysis.models.counts import Counts
from analysis.models.likelihood import cells, log_likelihood, posteriors
from analysis.models.optimum import Objective, hessian, inverse_of
from analysis.models.ordinal import OrdinalModel
from analysis.models.priors import Priors
from analysis.models.quadrature import Grid

Floats = NDArray[np.float64]
Integers = NDArray[np.intp]
LOG_SCALE: Final = "log_scale"
_SCALE_PRIOR: Final = (0.0, 1.0)
_SCORE_STEP: Final = 1e-4  # of the log-likelihood's central differences
_MOST_SHARED: Final = 50.0


@dataclass(frozen=True)
class Part:
    """One model with its counts; ``people`` (n,) number its persons among those of both parts."""

    model: OrdinalModel
    counts: Counts
    grid: Grid
    people: Integers
    weights: Floats

    def value(self, parameters: Floats) -> tuple[float, Floats]:
        """Return the weighted log-likelihood and its gradient."""
        return log_likelihood(self.model, parameters, self.counts, self.grid, weights=self.weights)

    def by_person(self, parameters: Floats) -> Floats:
        """Return every person's weighted log-likelihood (n,)."""
        log_p = cells(self.model, parameters, self.grid).log_p
        own = self.counts.table.reshape(self.counts.people, -1)
        logs = posteriors(own, log_p.reshape(-1, log_p.shape[2]), self.grid)[1]
        return np.asarray(self.weights * logs)


@dataclass(frozen=True)
class Composite:
    """Two parts; the first ``shared`` location parameters of the first are those of the second.

    The second's location parameters, all of them, are ``exp(log_scale)`` times the shared ones. Its
    other parameters follow those of the first and the scale.
    """

    first: Part
    second: Part
    shared: int
    people: int

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The first's parameters, the scale, then the second's without its locations."""
        own = [f"second:{name}" for name in self.without_locations(self.second.model.names)]
        return (*self.first.model.names, LOG_SCALE, *own)

    def split(self, parameters: Floats) -> tuple[Floats, Floats]:
        """Return the parameters of the first and of the second model (..., n)."""
        count = len(self.first.model.names)
        first, rest = parameters[..., :count], parameters[..., count + 1 :]
        scale = np.exp(parameters[..., count : count + 1])
        at = self.second.model.slices["location"]
        shared = first[..., self._shared] * scale
        return first, np.concatenate([rest[..., : at.start], shared, rest[..., at.start :]], -1)

    def join(self, first: Floats, second: Floats, *, log_scale: float) -> Floats:
        """Return the parameters from those of both models; the second's locations are dropped."""
        return np.concatenate([first, [log_scale], self.without_locations(second)])

    @property
    def _shared(self) -> slice:
        start = self.first.model.slices["location"].start
        return slice(start, start + self.shared)

    def without_locations(self, values: Any) -> Any:
        """Return the second model's names, kinds or parameters but those of its locations."""
        at = self.second.model.slices["location"]
        parts = values[: at.start], values[at.stop :]
        return np.concatenate(parts) if isinstance(values, np.ndarray) else (*parts[0], *parts[1])

    def value(self, parameters: Floats) -> tuple[float, Floats]:
        """Return the composite log-likelihood and its gradient."""
        first, second = self.split(parameters)
        value, gradient = self.first.value(first)
        more, steep = self.second.value(second)
        at = self.second.model.slices["location"]
        scale = float(np.exp(parameters[len(first)]))
        gradient = gradient.copy()
        gradient[self._shared] += scale * steep[at]
        by_scale = float(steep[at] @ second[at])
        return value + more, np.concatenate([gradient, [by_scale], self.without_locations(steep)])

    def by_person(self, parameters: Floats) -> Floats:
        """Return every person's composite log-likelihood (n_people,)."""
        total = np.zeros(self.people)
        for part, own in zip((self.first, self.second), self.split(parameters), strict=True):
            np.add.at(total, part.people, part.by_person(own))
        return total


@dataclass(frozen=True)
class CompositeFit:
    """A fitted composite: the sandwich ``covariance``, and the curvature's own, ``naive``."""

    model: Composite
    parameters: Floats
    covariance: Floats
    naive: Floats


def fit_composite(model: Composite, start: Floats, *, priors: Priors) -> CompositeFit:
    """Maximise the composite posterior from a start near the optimum."""
    known = {**priors, LOG_SCALE: _SCALE_PRIOR}
    kinds = (
        *model.first.model.kinds,
        LOG_SCALE,
        *model.without_locations(model.second.model.kinds),
    )
    means, sds = np.array([known[kind] for kind in kinds]).T

    def target(parameters: Floats) -> tuple[float, Floats]:
        value, gradient = model.value(np.clip(parameters, -_MOST_SHARED, _MOST_SHARED))
        away = (parameters - means) / sds
        return 0.5 * float(away @ away) - value, away / sds - gradient

    found = _climb(target, start)
    naive = inverse_of(hessian(target, found))[0]
    return CompositeFit(model, found, sandwich(model.by_person, found, naive), naive)


def sandwich(by_person: Callable[[Floats], Floats], parameters: Floats, naive: Floats) -> Floats:
    """Return H^-1 J H^-1, J from people's scores: ``by_person`` gives their log-likelihoods."""
    scores = _scores(by_person, parameters)
    people = len(scores)
    spread = people / max(people - 1, 1) * scores.T @ scores
    return np.asarray(naive @ spread @ naive)


def _climb(target: Objective, start: Floats) -> Floats:
    """Minimise by BFGS from a start near enough for its curvature to be of use."""
    size = max(1.0, float(np.abs(target(start)[1]).max()))

    def scaled(parameters: Floats) -> tuple[float, Floats]:
        value, gradient = target(parameters)
        return value / size, gradient / size

    options: Any = {"gtol": 1e-5, "maxiter": 200}
    options["hess_inv0"] = inverse_of(hessian(target, start))[0] * size
    found = minimize(scaled, start, jac=True, method="BFGS", options=options)
    return np.asarray(found.x, dtype=float)


def _scores(by_person: Callable[[Floats], Floats], parameters: Floats) -> Floats:
    """Return people's gradients (n_people, n_parameters) by central differences."""
    columns = [
        (by_person(parameters + step) - by_person(parameters - step)) / (2 * _SCORE_STEP)
        for step in np.eye(len(parameters)) * _SCORE_STEP
    ]
    return np.column_stack(columns)
