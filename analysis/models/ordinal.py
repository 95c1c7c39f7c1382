"""Cumulative-link mixed model of ratings: what it computes, and with what gradient.

    P(y <= k) = F((T_ik - eta_s - b_i) / exp(z_s'zeta + v_i)),   T_ik = c + exp(u_i) (tau_k - c)

with person i's leniency b, inconsistency v and end-avoidance u (threshold stretch about the middle
c; Luebbe and Schuster 2020), each normal about zero. The likelihood is that of the counts with the
person's effects integrated out on a fixed grid; one matrix product gives every person's
log-likelihood at every node. Knows no table; ``fitting`` finds the best parameters.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.models.counts import Counts
from analysis.models.links import PROBIT, Link
from analysis.models.quadrature import Grid

Floats = NDArray[np.float64]
LENIENCY, INCONSISTENCY, STYLE = "leniency", "inconsistency", "style"
PERSON_EFFECTS: Final = (LENIENCY, INCONSISTENCY, STYLE)
_FLOOR: Final = -1e6  # instead of log 0: zero counts times it stay zero
_BLOCK: Final = 2_000_000  # numbers per block of people x nodes


@dataclass(frozen=True)
class OrdinalModel:
    """Which stimuli there are and what may differ between them and between people.

    ``location`` (n_stimuli, n_terms) and ``terms`` name the fixed effects; ``partner``, of the same
    shape, are those of the eye beside it: it adds a contrast kappa (own - partner). ``scale``
    (n_stimuli, n_scale_terms) makes answers to some stimuli, or of some groups, more scattered.
    """

    location: Floats
    terms: tuple[str, ...]
    categories: int = 5
    effects: tuple[str, ...] = (LENIENCY,)
    link: Link = PROBIT
    partner: Floats | None = None
    scale: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    scale_terms: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.location.shape[1:] != (len(self.terms),):
            raise ValueError(f"location: {len(self.terms)} terms, found {self.location.shape[1:]}")
        if unknown := set(self.effects) - set(PERSON_EFFECTS):
            raise ValueError(f"effects: unknown {sorted(unknown)}; choose of {PERSON_EFFECTS}")
        if self.categories < 2:
            raise ValueError(f"categories: at least 2, found {self.categories}")

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The parameters' names in their order."""
        steps = [f"log_step_{k}" for k in range(2, self.categories)]
        contrast = ["contrast"] if self.partner is not None else []
        scales = [f"scale:{term}" for term in self.scale_terms]
        spreads = [f"log_sd:{effect}" for effect in self.effects]
        return ("threshold_1", *steps, *self.terms, *contrast, *scales, *spreads)

    def slices(self) -> dict[str, slice]:
        """Where each kind of parameter stands: thresholds, location, contrast, scale, spread."""
        sizes = {
            "thresholds": self.categories - 1,
            "location": len(self.terms),
            "contrast": int(self.partner is not None),
            "scale": len(self.scale_terms),
            "spread": len(self.effects),
        }
        ends = np.cumsum(list(sizes.values()))
        return {
            name: slice(int(end) - size, int(end))
            for (name, size), end in zip(sizes.items(), ends, strict=True)
        }

    def thresholds(self, parameters: Floats) -> Floats:
        """Return tau (n_categories - 1,)."""
        own = parameters[: self.categories - 1]
        return np.cumsum(np.concatenate([own[:1], np.exp(own[1:])]))

    def locations(self, parameters: Floats) -> Floats:
        """Return eta (n_stimuli,): the stimuli's realism on the latent scale."""
        at = self.slices()
        means = parameters[at["location"]]
        eta: Floats = self.location @ means
        if self.partner is not None:
            eta = eta + parameters[at["contrast"]] * (eta - self.partner @ means)
        return eta

    def log_scales(self, parameters: Floats) -> Floats:
        """Return the logarithm of the noise of each stimulus (n_stimuli,)."""
        if not self.scale_terms:
            return np.zeros(len(self.location))
        result: Floats = self.scale @ parameters[self.slices()["scale"]]
        return result

    def spreads(self, parameters: Floats) -> Floats:
        """Return people's standard deviations (3,): leniency, inconsistency, style; 0 if absent."""
        own = dict(zip(self.effects, np.exp(parameters[self.slices()["spread"]]), strict=True))
        return np.array([own.get(effect, 0.0) for effect in PERSON_EFFECTS])

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


@dataclass(frozen=True)
class Cells:
    """The model at one set of parameters, for every stimulus s, category k and node q.

    ``log_p`` (S, K, Q) are log probabilities, ``bounds`` (S, K-1, Q) the standardised thresholds.
    """

    log_p: Floats
    bounds: Floats
    shrink: Floats  # (S, 1, Q): 1 / noise
    stretch: Floats  # (Q,): exp(u)
    nodes: Floats  # (3, Q)


def cells(model: OrdinalModel, parameters: Floats, grid: Grid) -> Cells:
    """Evaluate the model's probabilities at every node of the grid."""
    nodes = model.place(grid)
    spread = model.spreads(parameters)
    tau = model.thresholds(parameters)
    middle = model.middle() @ tau
    stretch = np.exp(spread[2] * nodes[2])
    cut = middle + stretch * (tau[:, None] - middle)
    noise = model.log_scales(parameters)[:, None, None] + spread[1] * nodes[1]
    shrink = np.exp(-noise)
    eta = model.locations(parameters)
    bounds = (cut[None] - eta[:, None, None] - spread[0] * nodes[0]) * shrink
    ends = np.full((bounds.shape[0], 1, bounds.shape[2]), np.inf)
    edges = np.concatenate([-ends, bounds, ends], axis=1)
    log_p = np.maximum(model.link.log_interval(edges[:, :-1], edges[:, 1:]), _FLOOR)
    return Cells(
        log_p, bounds, np.broadcast_to(shrink, (*eta.shape, 1, len(stretch))), stretch, nodes
    )


def log_likelihood(
    model: OrdinalModel,
    parameters: Floats,
    counts: Counts,
    grid: Grid,
    *,
    weights: Floats | None = None,
) -> tuple[float, Floats]:
    """Return the counts' log-likelihood and its gradient (n_parameters,).

    ``weights`` (n_people,) let a person count more than once, as a bootstrap over people does.
    """
    at = cells(model, parameters, grid)
    flat = at.log_p.reshape(-1, at.log_p.shape[2])
    own = counts.table.reshape(counts.people, -1)
    total, expected = 0.0, np.zeros_like(flat)
    for rows in _blocks(counts.people, flat.shape[1]):
        often = np.ones(len(own[rows])) if weights is None else weights[rows]
        posterior, logs = posteriors(own[rows], flat, grid)
        total += float(often @ logs)
        expected += own[rows].T @ (posterior * often[:, None])
    return total, _gradient(model, parameters, at, expected.reshape(at.log_p.shape))


def posteriors(table: Floats, flat_log_p: Floats, grid: Grid) -> tuple[Floats, Floats]:
    """Return each person's probabilities of the nodes (n_people, Q) and log-likelihood."""
    joint = table @ flat_log_p + grid.log_weights
    top = joint.max(axis=1, keepdims=True)
    share = np.exp(joint - top)
    norm = share.sum(axis=1, keepdims=True)
    return share / norm, (top + np.log(norm))[:, 0]


def _blocks(people: int, nodes: int) -> Iterator[slice]:
    step = max(1, _BLOCK // nodes)
    return (slice(start, start + step) for start in range(0, people, step))


def _gradient(model: OrdinalModel, parameters: Floats, at: Cells, expected: Floats) -> Floats:
    """Chain the expected counts back to the parameters."""
    log_pdf = model.link.log_pdf(at.bounds)
    lower = expected[:, :-1] * np.exp(log_pdf - at.log_p[:, :-1])
    upper = expected[:, 1:] * np.exp(log_pdf - at.log_p[:, 1:])
    by_bound = lower - upper  # d ll / d bounds (S, K-1, Q)
    by_cut = by_bound * at.shrink
    by_eta = -by_cut.sum(axis=(1, 2))
    by_noise = -(by_bound * at.bounds).sum(axis=1)  # (S, Q)
    spread = model.spreads(parameters)
    tau, middle = model.thresholds(parameters), model.middle()
    away = tau - middle @ tau
    per_node = by_cut.sum(axis=0)  # (K-1, Q)
    by_tau = per_node @ at.stretch + middle * float(per_node.sum(axis=0) @ (1.0 - at.stretch))
    by_spread = {
        LENIENCY: -spread[0] * float(by_cut.sum(axis=(0, 1)) @ at.nodes[0]),
        INCONSISTENCY: spread[1] * float(by_noise.sum(axis=0) @ at.nodes[1]),
        STYLE: spread[2] * float((away @ per_node) @ (at.stretch * at.nodes[2])),
    }
    return np.concatenate(
        [
            _by_steps(model, parameters, by_tau),
            _by_location(model, parameters, by_eta),
            by_noise.sum(axis=1) @ model.scale if model.scale_terms else np.zeros(0),
            _in_order(by_spread, model.effects),
        ]
    )


def _by_steps(model: OrdinalModel, parameters: Floats, by_tau: Floats) -> Floats:
    """Turn d/d tau into d/d (first threshold, log steps)."""
    beyond = np.cumsum(by_tau[::-1])[::-1]
    beyond[1:] *= np.exp(parameters[1 : model.categories - 1])
    return beyond


def _by_location(model: OrdinalModel, parameters: Floats, by_eta: Floats) -> Floats:
    if model.partner is None:
        return np.asarray(by_eta @ model.location)
    at = model.slices()
    means, contrast = parameters[at["location"]], parameters[at["contrast"]]
    beside = model.location - model.partner
    return np.concatenate(
        [by_eta @ (model.location + contrast * beside), [by_eta @ beside @ means]]
    )


def _in_order(values: dict[str, float], names: Sequence[str]) -> Floats:
    return np.array([values[name] for name in names])
