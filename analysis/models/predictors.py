"""Predictors: how a stimulus's place on the latent scale follows from a model's parameters.

Each gives eta (n_stimuli,) and its Jacobian (n_stimuli, n_parameters); ``kinds`` name what each
parameter is, for the priors.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Predictor(Protocol):
    """What an ordinal model asks of a predictor."""

    @property
    def stimuli(self) -> int:
        """How many stimuli there are."""

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters' names in their order."""

    @property
    def kinds(self) -> tuple[str, ...]:
        """What each parameter is: a key of the priors."""

    def eta(self, parameters: Floats) -> Floats:
        """Return the stimuli's places (n_stimuli,)."""

    def jacobian(self, parameters: Floats) -> Floats:
        """Return d eta / d parameters (n_stimuli, n_parameters)."""


@dataclass(frozen=True)
class Linear:
    """eta = X m: one column of ``design`` (n_stimuli, n_terms) for each of ``names``."""

    design: Floats
    names: tuple[str, ...]

    def __post_init__(self) -> None:
        _check(self.design, self.names)

    @property
    def stimuli(self) -> int:
        """How many stimuli there are."""
        return len(self.design)

    @property
    def kinds(self) -> tuple[str, ...]:
        """Every term is a difference from the reference."""
        return ("location",) * len(self.names)

    def eta(self, parameters: Floats) -> Floats:
        """Return X m."""
        return np.asarray(self.design @ parameters)

    def jacobian(self, parameters: Floats) -> Floats:
        """Return X."""
        del parameters  # the same everywhere
        return self.design


@dataclass(frozen=True)
class Contrasted:
    """eta = X m + kappa (X m - Z m): an eye gains by contrast with a lesser eye beside it.

    ``design`` are the own eye's terms and ``beside``, of the same shape, those of its partner. The
    last parameter is kappa. Only partners that differ from the eye itself say anything of it.
    """

    design: Floats
    beside: Floats
    terms: tuple[str, ...]

    def __post_init__(self) -> None:
        _check(self.design, self.terms)
        _check(self.beside, self.terms)

    @property
    def stimuli(self) -> int:
        """How many stimuli there are."""
        return len(self.design)

    @property
    def names(self) -> tuple[str, ...]:
        """The terms, then the contrast."""
        return (*self.terms, "contrast")

    @property
    def kinds(self) -> tuple[str, ...]:
        """Differences from the reference, then the contrast."""
        return (*("location",) * len(self.terms), "contrast")

    def eta(self, parameters: Floats) -> Floats:
        """Return X m + kappa (X - Z) m."""
        means, kappa = parameters[:-1], parameters[-1]
        return np.asarray(self.design @ means + kappa * ((self.design - self.beside) @ means))

    def jacobian(self, parameters: Floats) -> Floats:
        """Return (X + kappa (X - Z), (X - Z) m)."""
        away = self.design - self.beside
        return np.column_stack([self.design + parameters[-1] * away, away @ parameters[:-1]])


def _check(design: Floats, names: tuple[str, ...]) -> None:
    if design.ndim != 2 or design.shape[1] != len(names):
        raise ValueError(f"design: wanted a column for each of {names}; found {design.shape}")
