"""Cumulative-link mixed model of ordered answers: its parts, its parameters and their names.

    P(y <= k) = F((T_ik - eta_s - b_i) / exp(z_s'zeta + v_i)),   T_ik = c + exp(u_i) (tau_k - c)

with person i's leniency b, inconsistency v and end-avoidance u (a stretch of the thresholds about
the middle c; Luebbe and Schuster 2020), each normal about zero. Three categories and a difference
of two eyes as eta give Thurstone's comparison with a band of "no difference"; a pair's visibility
as eta gives detection with a "not sure". ``likelihood`` evaluates it, ``fitting`` fits it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.models.links import PROBIT, Link
from analysis.models.predictors import Predictor
from analysis.models.quadrature import Grid

Floats = NDArray[np.float64]
LENIENCY, INCONSISTENCY, STYLE = "leniency", "inconsistency", "style"
PERSON_EFFECTS: Final = (LENIENCY, INCONSISTENCY, STYLE)


@dataclass(frozen=True)
class OrdinalModel:
    """Where the stimuli stand and what may differ between people.

    ``scale`` (n_stimuli, n_scale_terms) makes answers to some stimuli, or of some groups, more
    scattered. ``nominal`` (n_stimuli, n_nominal_terms) lets the distances between thresholds differ
    by stimulus: each term has a parameter for each of them, on the logarithm, so that thresholds
    keep their order. For a factor whose levels all have a location it says what category-specific
    effects of that factor say.
    """

    predictor: Predictor
    categories: int = 5
    effects: tuple[str, ...] = (LENIENCY,)
    link: Link = PROBIT
    scale: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    scale_terms: tuple[str, ...] = ()
    nominal: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    nominal_terms: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if unknown := set(self.effects) - set(PERSON_EFFECTS):
            raise ValueError(f"effects: unknown {sorted(unknown)}; choose of {PERSON_EFFECTS}")
        if self.categories < 2:
            raise ValueError(f"categories: at least 2, found {self.categories}")

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The parameters' names in their order."""
        steps = [f"log_step_{k}" for k in range(2, self.categories)]
        scales = [f"scale:{term}" for term in self.scale_terms]
        own = [f"{step}:{term}" for term in self.nominal_terms for step in steps]
        spreads = [f"log_sd:{effect}" for effect in self.effects]
        return ("threshold_1", *steps, *self.predictor.names, *scales, *own, *spreads)

    @cached_property
    def kinds(self) -> tuple[str, ...]:
        """What each parameter is: a key of the priors."""
        steps = ["log_step"] * (self.categories - 2)
        scales = ["scale"] * len(self.scale_terms)
        own = ["nominal"] * (self.categories - 2) * len(self.nominal_terms)
        spreads = [f"log_sd:{effect}" for effect in self.effects]
        return ("threshold", *steps, *self.predictor.kinds, *scales, *own, *spreads)

    @cached_property
    def slices(self) -> dict[str, slice]:
        """Where each part stands: thresholds, location, scale, nominal, spread."""
        sizes = {
            "thresholds": self.categories - 1,
            "location": len(self.predictor.names),
            "scale": len(self.scale_terms),
            "nominal": len(self.nominal_terms) * (self.categories - 2),
            "spread": len(self.effects),
        }
        ends = np.cumsum(list(sizes.values()))
        return {
            name: slice(int(end) - size, int(end))
            for (name, size), end in zip(sizes.items(), ends, strict=True)
        }

    def thresholds(self, parameters: Floats) -> Floats:
        """Return tau (..., n_categories - 1) of parameters (..., n_parameters).

        With nominal terms these are the thresholds where all terms are 0.
        """
        own = parameters[..., : self.categories - 1]
        steps = np.concatenate([own[..., :1], np.exp(own[..., 1:])], axis=-1)
        return np.asarray(np.cumsum(steps, axis=-1))

    def steps(self, parameters: Floats) -> Floats:
        """Return what lies between thresholds (n_stimuli, n_categories - 2), or one row for all."""
        logs = parameters[None, 1 : self.categories - 1]
        if self.nominal_terms:
            own = parameters[self.slices["nominal"]].reshape(len(self.nominal_terms), -1)
            logs = logs + self.nominal @ own
        return np.asarray(np.exp(logs))

    def locations(self, parameters: Floats) -> Floats:
        """Return eta (n_stimuli,): the stimuli's places on the latent scale."""
        return self.predictor.eta(parameters[self.slices["location"]])

    def log_scales(self, parameters: Floats) -> Floats:
        """Return the logarithm of the noise of each stimulus (n_stimuli,)."""
        if not self.scale_terms:
            return np.zeros(self.predictor.stimuli)
        result: Floats = self.scale @ parameters[self.slices["scale"]]
        return result

    def spreads(self, parameters: Floats) -> Floats:
        """Return people's standard deviations (..., 3): leniency, inconsistency, style.

        They are 0 where the model lacks the effect.
        """
        own = np.zeros((*parameters.shape[:-1], len(PERSON_EFFECTS)))
        places = [PERSON_EFFECTS.index(effect) for effect in self.effects]
        own[..., places] = np.exp(parameters[..., self.slices["spread"]])
        return own

    def place(self, grid: Grid) -> Floats:
        """Return the grid's nodes as rows of all three person effects (3, Q)."""
        nodes = np.zeros((3, grid.nodes.shape[1]))
        for row, effect in zip(grid.nodes, self.effects, strict=True):
            nodes[PERSON_EFFECTS.index(effect)] = row
        return nodes

    def middle(self) -> Floats:
        """Return the weights (n_categories - 1,) of the thresholds in the scale's middle c."""
        count = self.categories - 1
        weights = np.zeros(count)
        weights[[(count - 1) // 2, count // 2]] = 0.5
        weights[(count - 1) // 2] += 0.5 * (count % 2)
        return weights
