"""Predictors made of others: scaled by stimulus, added up, seen beside a partner."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.models.predictors import Predictor

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Scaled:
    """eta_s = f_s eta'_s: a predictor times a known ``factor`` (n_stimuli,), as a sign is."""

    predictor: Predictor
    factor: Floats

    @property
    def stimuli(self) -> int:
        """How many stimuli there are."""
        return self.predictor.stimuli

    @property
    def names(self) -> tuple[str, ...]:
        """The predictor's own."""
        return self.predictor.names

    @property
    def kinds(self) -> tuple[str, ...]:
        """The predictor's own."""
        return self.predictor.kinds

    def eta(self, parameters: Floats) -> Floats:
        """Return f eta'."""
        return np.asarray(self.factor * self.predictor.eta(parameters))

    def jacobian(self, parameters: Floats) -> Floats:
        """Return f d eta'."""
        return np.asarray(self.factor[:, None] * self.predictor.jacobian(parameters))


@dataclass(frozen=True)
class Together:
    """eta = eta_1 + eta_2: two predictors, each with parameters of its own."""

    first: Predictor
    second: Predictor

    @property
    def stimuli(self) -> int:
        """How many stimuli there are."""
        return self.first.stimuli

    @property
    def names(self) -> tuple[str, ...]:
        """The first one's, then the second one's."""
        return (*self.first.names, *self.second.names)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The first one's, then the second one's."""
        return (*self.first.kinds, *self.second.kinds)

    def eta(self, parameters: Floats) -> Floats:
        """Return the sum."""
        at = len(self.first.names)
        return self.first.eta(parameters[:at]) + self.second.eta(parameters[at:])

    def jacobian(self, parameters: Floats) -> Floats:
        """Return both Jacobians side by side."""
        at = len(self.first.names)
        parts = self.first.jacobian(parameters[:at]), self.second.jacobian(parameters[at:])
        return np.column_stack(parts)


@dataclass(frozen=True)
class Beside:
    """eta = eta_own + kappa (eta_own - eta_beside): contrast with the eye beside it.

    Both predictors share all parameters; the last parameter is kappa.
    """

    own: Predictor
    beside: Predictor

    @property
    def stimuli(self) -> int:
        """How many stimuli there are."""
        return self.own.stimuli

    @property
    def names(self) -> tuple[str, ...]:
        """The eye's own, then the contrast."""
        return (*self.own.names, "contrast")

    @property
    def kinds(self) -> tuple[str, ...]:
        """The eye's own, then the contrast."""
        return (*self.own.kinds, "contrast")

    def eta(self, parameters: Floats) -> Floats:
        """Return eta_own + kappa (eta_own - eta_beside)."""
        own, beside = self.own.eta(parameters[:-1]), self.beside.eta(parameters[:-1])
        return np.asarray(own + parameters[-1] * (own - beside))

    def jacobian(self, parameters: Floats) -> Floats:
        """Return the derivatives by the shared parameters, then by kappa."""
        shared, kappa = parameters[:-1], parameters[-1]
        own, beside = self.own.jacobian(shared), self.beside.jacobian(shared)
        away = self.own.eta(shared) - self.beside.eta(shared)
        return np.column_stack([own + kappa * (own - beside), away])
