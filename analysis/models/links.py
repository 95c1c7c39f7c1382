"""Link functions: probabilities of intervals on the latent scale, accurate far out in the tails."""

from __future__ import annotations

from collections.abc import Callable, Mapping
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

    def log_interval(self, low: Floats, high: Floats) -> Floats:
        """Return log(F(high) - F(low)) for low < high; either may be infinite.

        Both ends are mirrored into the lower tail, where F keeps its relative accuracy.
        """
        is_upper = low > 0
        a = np.where(is_upper, -high, low)
        b = np.where(is_upper, -low, high)
        share = self.cdf(b) - self.cdf(a)
        with np.errstate(divide="ignore"):
            logs = np.log(share)
        far = share < _TINY
        if far.any():
            log_b, log_a = self.log_cdf(b[far]), self.log_cdf(a[far])
            with np.errstate(divide="ignore"):
                logs[far] = log_b + np.log(-np.expm1(np.minimum(log_a - log_b, -1e-16)))
        return logs


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
LINKS: Final[Mapping[str, Link]] = {link.name: link for link in (PROBIT, LOGIT)}
