"""How well a model foretells a person it has not seen: each person's ratings by the others' fit.

Few people are each left out and the model fitted anew; of many, what one person moves is so little
that the fit's curvature tells it. Priors are in these fits: without, a cell that only the person
left out rated would be foretold with no probability at all.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.models.counts import Counts
from analysis.models.fitting import OrdinalFit, Problem
from analysis.models.likelihood import person_log_likelihoods
from analysis.models.optimum import climb
from analysis.models.scores import person_scores

Floats = NDArray[np.float64]
FEWEST: Final = 3  # people of whom one can be foretold from the others
MOST_REFITS: Final = 40
_MOST_WORK: Final = 80_000  # stimuli x categories x nodes up to which each fit is quick
_NEAR: Final = 0.03  # standard errors from each optimum: far less than leaving out moves it
_MOST_SCORED: Final = 200  # people whose gradients are taken; the first ones, as they come


def is_refitted(fit: OrdinalFit) -> bool:
    """Say whether each person is left out by a fit of its own."""
    work = fit.counts.stimuli * fit.counts.categories * fit.grid.log_weights.size
    return fit.counts.people <= MOST_REFITS and work <= _MOST_WORK


def left_out(fit: OrdinalFit) -> Floats:
    """Return the log probability of each person's ratings by a fit to the others (n_people,).

    ``fit`` has priors. Of more than 200 people the first 200 tell what leaving out takes away.
    """
    return _refitted(fit) if is_refitted(fit) else _expanded(fit)


def _refitted(fit: OrdinalFit) -> Floats:
    often = np.ones(fit.counts.people) if fit.weights is None else fit.weights
    found = []
    for person in range(fit.counts.people):
        others = often.copy()
        others[person] = 0.0
        target = Problem(fit.model, fit.counts, fit.priors, others).target(fit.grid)
        best = climb(target, fit.parameters, inverse=fit.covariance, near=_NEAR)[0]
        own = Counts(fit.counts.table[person : person + 1])
        found.append(float(person_log_likelihoods(fit.model, best, own, fit.grid)[0]))
    return np.array(found)


def _expanded(fit: OrdinalFit) -> Floats:
    """Take one Newton step away from each person, whose own curvature is a share of the whole."""
    own = Counts(fit.counts.table[:_MOST_SCORED])
    scores, logs = person_scores(fit.model, fit.parameters, own, fit.grid)
    often = np.ones(fit.counts.people) if fit.weights is None else fit.weights
    weight, share = often[: len(logs)], (often / often.sum())[: len(logs)]
    pull = np.einsum("ia,ab,ib->i", scores, fit.covariance, scores)
    step = weight / (1.0 - np.minimum(share, 0.5))
    # Of the second-order term the person's own curvature is ``share`` of all, per unit of weight.
    lost = step * pull * (1.0 + 0.5 * step * share / np.maximum(weight, 1e-9))
    rest = Counts(fit.counts.table[len(logs) :])
    if not rest.people:
        return np.asarray(logs - lost)
    others = person_log_likelihoods(fit.model, fit.parameters, rest, fit.grid)
    return np.concatenate([logs - lost, others - lost.mean()])
