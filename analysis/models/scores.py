"""Each person's own gradient: what it takes to leave a person out without fitting again."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from analysis.models.counts import Counts
from analysis.models.likelihood import Cells, cells, posteriors
from analysis.models.ordinal import INCONSISTENCY, LENIENCY, STYLE, OrdinalModel
from analysis.models.quadrature import Grid

Floats = NDArray[np.float64]


def person_scores(
    model: OrdinalModel, parameters: Floats, counts: Counts, grid: Grid
) -> tuple[Floats, Floats]:
    """Return people's gradients (n_people, n_parameters) and log-likelihoods (n_people,).

    All people stand in memory at once; nominal terms are not for it (ValueError).
    """
    if model.nominal_terms:
        raise ValueError("scores: nominal terms are accepted by log_likelihood alone")
    at = cells(model, parameters, grid)
    own = counts.table.reshape(counts.people, -1)
    share, logs = posteriors(own, at.log_p.reshape(own.shape[1], -1), grid)
    by_bound = _ByBound(model, at, counts, share)
    spread, tau = model.spreads(parameters), model.thresholds(parameters)
    middle = model.middle()
    away = (tau - middle @ tau)[:, None]
    bent = by_bound(at.shrink * at.stretch)  # (n_people, S, K-1)
    straight = by_bound(at.shrink * (1.0 - at.stretch)) if STYLE in model.effects else 0.0 * bent
    by_tau = bent.sum(axis=1) + straight.sum(axis=(1, 2))[:, None] * middle
    steps = np.exp(parameters[1 : model.categories - 1])
    beyond = np.cumsum(by_tau[:, ::-1], axis=1)[:, ::-1]
    beyond[:, 1:] *= steps
    by_eta = -(bent + straight).sum(axis=2)
    parts = [beyond, by_eta @ model.predictor.jacobian(parameters[model.slices["location"]])]
    if model.scale_terms:
        parts.append(-by_bound(at.bounds).sum(axis=2) @ model.scale)
    factors = {
        LENIENCY: lambda: -spread[0] * at.shrink * at.nodes[0],
        INCONSISTENCY: lambda: -spread[1] * at.bounds * at.nodes[1],
        STYLE: lambda: spread[2] * at.shrink * at.stretch * at.nodes[2] * away,
    }
    parts += [by_bound(factors[effect]()).sum(axis=(1, 2))[:, None] for effect in model.effects]
    return np.concatenate(parts, axis=1), logs


class _ByBound:
    """Sums over a person's answers and nodes of d log P / d bound, times a factor."""

    def __init__(self, model: OrdinalModel, at: Cells, counts: Counts, share: Floats) -> None:
        log_pdf = model.link.log_pdf(at.bounds)
        self._below = np.exp(log_pdf - at.log_p[:, :-1])  # of the category that ends at the bound
        self._above = -np.exp(log_pdf - at.log_p[:, 1:])
        self._counts, self._share = counts.table, share

    def __call__(self, factor: Floats) -> Floats:
        """Return (n_people, S, K-1); ``factor`` broadcasts against (S, K-1, Q)."""
        return self._sum(self._below * factor, self._counts[:, :, :-1]) + self._sum(
            self._above * factor, self._counts[:, :, 1:]
        )

    def _sum(self, slope: Floats, given: Floats) -> Floats:
        found = self._share @ slope.reshape(-1, slope.shape[2]).T
        result: Floats = given * found.reshape(given.shape)
        return result
