"""Predictors: how a stimulus's place on the latent scale follows from a model's parameters.

Each gives eta (n_stimuli,) and its Jacobian (n_stimuli, n_parameters); ``kinds`` name what each
parameter is, for the priors.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

Floats = NDArray[np.float64]
Integers = NDArray[np.intp]


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


@dataclass(frozen=True)
class Saturating:
    """eta = A_g Phi((x - m_g) / w): how much of a gap an eye of size x, a logarithm, shows.

    ``group`` (n_stimuli,) numbers the curves, -1 where eta is 0, as for a pair of equal LoDs. The
    parameters are log A and m of each of ``curves``, then log w, which all share.
    """

    x: Floats
    group: Integers
    curves: tuple[str, ...]

    @property
    def stimuli(self) -> int:
        """How many stimuli there are."""
        return len(self.x)

    @property
    def names(self) -> tuple[str, ...]:
        """log A of every curve, m of every curve, log w."""
        return (
            *(f"log_height:{curve}" for curve in self.curves),
            *(f"middle:{curve}" for curve in self.curves),
            "log_width",
        )

    @property
    def kinds(self) -> tuple[str, ...]:
        """What each parameter is."""
        count = len(self.curves)
        return (*("log_height",) * count, *("middle",) * count, "log_width")

    def eta(self, parameters: Floats) -> Floats:
        """Return A Phi(z), 0 outside the groups."""
        height, z, _ = self._parts(parameters)
        return np.where(self.group >= 0, height * ndtr(z), 0.0)

    def jacobian(self, parameters: Floats) -> Floats:
        """Return the derivatives by log A, m and log w."""
        height, z, width = self._parts(parameters)
        steep = height * np.exp(-0.5 * z * z) / np.sqrt(2 * np.pi)
        count = len(self.curves)
        member = (self.group[:, None] == np.arange(count)).astype(float)
        inside = (self.group >= 0).astype(float)
        return np.column_stack(
            [
                member * (height * ndtr(z))[:, None],
                member * (-steep / width)[:, None],
                -steep * z * inside,
            ]
        )

    def _parts(self, parameters: Floats) -> tuple[Floats, Floats, float]:
        count = len(self.curves)
        own = np.maximum(self.group, 0)
        width = float(np.exp(parameters[-1]))
        z = (self.x - parameters[count : 2 * count][own]) / width
        return np.exp(parameters[:count])[own], z, width


def _check(design: Floats, names: tuple[str, ...]) -> None:
    if design.ndim != 2 or design.shape[1] != len(names):
        raise ValueError(f"design: wanted a column for each of {names}; found {design.shape}")
