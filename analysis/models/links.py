"""Link functions: probabilities of intervals on the latent scale, accurate far out in the tails."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit, log_expit, log_ndtr, ndtr, ndtri

Floats = NDArray[np.float64]
_TINY: Final = 1e-290  # below it a probability is computed from its logarithm
_LOG_SQRT_2PI: Final = 0.9189385332046727


@dataclass(frozen=True)
class Link:
    """The distribution of the latent noise, symmetric about zero.

    ``sd`` is its standard deviation: what one unit of the latent scale is in sd's differs by link.
    """

    name: str
    sd: float
    cdf: Callable[[Floats], Floats]
    log_cdf: Callable[[Floats], Floats]
    log_pdf: Callable[[Floats], Floats]
    quantile: Callable[[Floats], Floats]

    def log_intervals(self, bounds: Floats) -> Floats:
        """Return log P of the K intervals that K - 1 rising bounds cut the line into.

        ``bounds`` (n, K - 1, q) gives (n, K, q). Where an interval lies above zero it is mirrored
        into the lower tail: there F keeps its relative accuracy.
        """
        is_upper = bounds > 0
        tail = self.cdf(-np.abs(bounds))  # the costly part, hence once
        below, above = np.where(is_upper, 1.0 - tail, tail), np.where(is_upper, tail, 1.0 - tail)
        count = bounds.shape[1] + 1
        share = np.empty((len(bounds), count, bounds.shape[2]))
        share[:, 0], share[:, -1] = below[:, 0], above[:, -1]
        share[:, 1:-1] = np.where(
            is_upper[:, :-1], above[:, :-1] - above[:, 1:], below[:, 1:] - below[:, :-1]
        )
        far = np.nonzero(share < _TINY)
        share[far] = 1.0
        logs = np.log(share)
        if len(far[0]):
            logs[far] = self._far(bounds, far)
        return np.asarray(logs)

    def _far(self, bounds: Floats, far: tuple[NDArray[np.intp], ...]) -> Floats:
        """Return log P of intervals too unlikely to be subtracted."""
        ends = np.full_like(bounds[:, :1], np.inf)
        edges = np.concatenate([-ends, bounds, ends], axis=1)
        low, high = edges[far], edges[far[0], far[1] + 1, far[2]]
        is_upper = low > 0
        a, b = np.where(is_upper, -high, low), np.where(is_upper, -low, high)
        log_b, log_a = self.log_cdf(b), self.log_cdf(a)
        return np.asarray(log_b + np.log(-np.expm1(np.minimum(log_a - log_b, -1e-16))))


def _normal_log_pdf(x: Floats) -> Floats:
    return -0.5 * x * x - _LOG_SQRT_2PI


def _logistic_log_pdf(x: Floats) -> Floats:
    away = np.abs(x)  # symmetric: this way infinity gives -inf and not nan
    return -away - 2.0 * np.log1p(np.exp(-away))


def _logistic_quantile(p: Floats) -> Floats:
    return np.log(p) - np.log1p(-p)


PROBIT: Final = Link("probit", 1.0, ndtr, log_ndtr, _normal_log_pdf, ndtri)
LOGIT: Final = Link(
    "logit", np.pi / np.sqrt(3.0), expit, log_expit, _logistic_log_pdf, _logistic_quantile
)
