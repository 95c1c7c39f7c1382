"""The likelihood of counts under an ordinal model, people integrated out, and its gradient.

One matrix product gives every person's log-likelihood at every node of the grid; a second gives
the expected counts that the gradient is made of. The cost does not grow with a person's answers.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.models.counts import Counts
from analysis.models.ordinal import INCONSISTENCY, LENIENCY, STYLE, OrdinalModel
from analysis.models.quadrature import Grid

Floats = NDArray[np.float64]
_FLOOR: Final = -1e6  # instead of log 0: zero counts times it stay zero
_FARTHEST: Final = 60.0  # a logarithm of scatter or stretch: without priors a climb may try any
_BLOCK: Final = 2_000_000  # numbers per block of people x nodes


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
    tau = _thresholds(parameters, model.steps(parameters))
    middle = (tau @ model.middle())[:, None]
    stretch = np.exp(np.clip(spread[2] * nodes[2], -_FARTHEST, _FARTHEST))
    cut = middle[..., None] + stretch * (tau - middle)[..., None]
    noise = model.log_scales(parameters)[:, None, None] + spread[1] * nodes[1]
    shrink = np.exp(-np.clip(noise, -_FARTHEST, _FARTHEST))
    eta = model.locations(parameters)
    bounds = (cut - eta[:, None, None] - spread[0] * nodes[0]) * shrink
    log_p = np.maximum(model.link.log_intervals(bounds), _FLOOR)
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
        if weights is not None:
            posterior *= often[:, None]
        expected += own[rows].T @ posterior
    return total, _gradient(model, parameters, at, expected.reshape(at.log_p.shape))


def person_log_likelihoods(
    model: OrdinalModel, parameters: Floats, counts: Counts, grid: Grid
) -> Floats:
    """Return each person's log-likelihood (n_people,)."""
    flat = cells(model, parameters, grid).log_p.reshape(-1, grid.log_weights.size)
    own = counts.table.reshape(counts.people, -1)
    found = [posteriors(own[rows], flat, grid)[1] for rows in _blocks(len(own), flat.shape[1])]
    return np.concatenate(found)


def posteriors(table: Floats, flat_log_p: Floats, grid: Grid) -> tuple[Floats, Floats]:
    """Return each person's probabilities of the nodes (n_people, Q) and log-likelihood."""
    joint = table @ flat_log_p
    joint += grid.log_weights
    top = joint.max(axis=1, keepdims=True)
    joint -= top
    share = np.exp(joint, out=joint)
    norm = share.sum(axis=1, keepdims=True)
    share /= norm
    return share, (top + np.log(norm))[:, 0]


def visited(model: OrdinalModel, parameters: Floats, counts: Counts, grid: Grid) -> Floats:
    """Return for each node (Q,) the greatest probability that any person has of being there."""
    flat = cells(model, parameters, grid).log_p.reshape(-1, grid.log_weights.size)
    own = counts.table.reshape(counts.people, -1)
    most = np.zeros(grid.log_weights.size)
    for rows in _blocks(counts.people, flat.shape[1]):
        np.maximum(most, posteriors(own[rows], flat, grid)[0].max(axis=0), out=most)
    return most


def _blocks(people: int, nodes: int) -> Iterator[slice]:
    step = max(1, _BLOCK // nodes)
    return (slice(start, start + step) for start in range(0, people, step))


def _gradient(model: OrdinalModel, parameters: Floats, at: Cells, expected: Floats) -> Floats:
    """Chain the expected counts back to the parameters."""
    log_pdf = model.link.log_pdf(at.bounds)
    by_bound = expected[:, :-1] * np.exp(log_pdf - at.log_p[:, :-1])
    by_bound -= expected[:, 1:] * np.exp(log_pdf - at.log_p[:, 1:])  # d ll / d bounds (S, K-1, Q)
    by_cut = by_bound * at.shrink
    by_eta = -by_cut.sum(axis=(1, 2))
    by_noise = -(by_bound * at.bounds).sum(axis=1)  # (S, Q)
    spread = model.spreads(parameters)
    steps, middle = model.steps(parameters), model.middle()
    tau = _thresholds(parameters, steps)
    away = tau - (tau @ middle)[:, None]
    if not model.nominal_terms:
        by_cut = by_cut.sum(axis=0, keepdims=True)  # thresholds are the same for all stimuli
    by_tau = by_cut @ at.stretch + middle * (by_cut.sum(axis=1) @ (1.0 - at.stretch))[:, None]
    by_spread = {
        LENIENCY: -spread[0] * float(by_cut.sum(axis=(0, 1)) @ at.nodes[0]),
        INCONSISTENCY: spread[1] * float(by_noise.sum(axis=0) @ at.nodes[1]),
        STYLE: spread[2] * float(np.einsum("sk,skq->q", away, by_cut) @ (at.stretch * at.nodes[2])),
    }
    by_steps = np.cumsum(by_tau[:, :0:-1], axis=1)[:, ::-1] * steps  # (S or 1, K-2)
    return np.concatenate(
        [
            [by_tau.sum()],
            by_steps.sum(axis=0),
            by_eta @ model.predictor.jacobian(parameters[model.slices["location"]]),
            by_noise.sum(axis=1) @ model.scale if model.scale_terms else np.zeros(0),
            (model.nominal.T @ by_steps).ravel() if model.nominal_terms else np.zeros(0),
            np.array([by_spread[effect] for effect in model.effects]),
        ]
    )


def _thresholds(parameters: Floats, steps: Floats) -> Floats:
    """Return tau (n_stimuli, n_categories - 1), or one row where they are the same for all."""
    first = np.full((len(steps), 1), parameters[0])
    return np.cumsum(np.concatenate([first, steps], axis=1), axis=1)
