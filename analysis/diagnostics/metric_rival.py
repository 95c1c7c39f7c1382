"""The metric model as a rival of the ordinal ones: on the same stimuli, people and weights.

A density's log-likelihood is not comparable with an ordinal model's probabilities; here each rating
has the probability of all that is rounded to it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from analysis.diagnostics.left_out import MOST_REFITS
from analysis.diagnostics.metric import MetricFit, Sums, as_ordinal, fit_metric, sums_of
from analysis.models.counts import Counts
from analysis.models.likelihood import person_log_likelihoods
from analysis.models.ordinal import LENIENCY, OrdinalModel
from analysis.models.predictors import Predictor
from analysis.models.quadrature import normal_grid

Floats = NDArray[np.float64]
_GRID: Final = normal_grid([161])
_GROUPS: Final = 20  # in which people are left out where they are many
_CONTRASTS: Final = (-0.8, 0.8)


@dataclass(frozen=True)
class MetricRival:
    """The metric model of a study; ``often`` (n_people,) is what people count for.

    Where the predictor has a contrast from the eye beside it, its best value is looked for too.
    """

    predictor: Predictor
    counts: Counts
    often: Floats

    @property
    def parameters(self) -> int:
        """How many were estimated."""
        return self.fit.parameters + (self.contrast is not None)

    @cached_property
    def contrast(self) -> float | None:
        """The contrast, where the predictor has one."""
        if "contrast" not in self.predictor.names:
            return None

        def lost(contrast: float) -> float:
            return -fit_metric(self._sums(contrast)).log_likelihood

        best = minimize_scalar(lost, bounds=_CONTRASTS, method="bounded", options={"xatol": 1e-3})
        return float(best.x)

    @cached_property
    def fit(self) -> MetricFit:
        """The estimates."""
        return fit_metric(self._own_sums)

    @cached_property
    def log_likelihood(self) -> float:
        """Of the categories, not of a density."""
        return float(self.often @ self._logs(self.fit, self.counts))

    def left_out(self) -> Floats:
        """Return the log probability of people's ratings by a fit to others (n,).

        Few people are left out one by one, more in 20 groups.
        """
        logs = np.empty(self.counts.people)
        for out in self._groups():
            own = Counts(self.counts.table[out])
            logs[out] = self._logs(fit_metric(self._own_sums.without(out)), own)
        return logs

    def _groups(self) -> Iterator[NDArray[np.intp]]:
        number = np.arange(self.counts.people)
        groups = number if self.counts.people <= MOST_REFITS else number % _GROUPS
        return (np.flatnonzero(groups == group) for group in range(groups.max(initial=-1) + 1))

    def _logs(self, found: MetricFit, counts: Counts) -> Floats:
        model = OrdinalModel(self.predictor, counts.categories, (LENIENCY,))
        at = as_ordinal(found, model, contrast=self.contrast)
        return person_log_likelihoods(model, at, counts, _GRID)

    @cached_property
    def _own_sums(self) -> Sums:
        return self._sums(self.contrast)

    def _sums(self, contrast: float | None) -> Sums:
        names = self.predictor.names
        at = np.zeros(len(names))
        at[-1:] = 0.0 if contrast is None else contrast
        design = self.predictor.jacobian(at)[:, : len(names) - (contrast is not None)]
        whole = np.column_stack([np.ones(len(design)), design])
        return sums_of(self.counts, whole, weights=self.often)
