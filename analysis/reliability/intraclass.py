"""Intraclass correlation: how well one rater, and the raters' mean, repeat across raters.

Two-way random effects, absolute agreement: Shrout and Fleiss 1979; intervals by McGraw and Wong
1996, table 7.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import fdtri

_TAIL: Final = 0.975


@dataclass(frozen=True)
class Coefficient:
    """An estimate with its 95 % interval; nan where the data leave it open."""

    value: float = np.nan
    low: float = np.nan
    high: float = np.nan


def intraclass(table: ArrayLike) -> tuple[Coefficient, Coefficient]:
    """Return ICC(2,1) of one rater and ICC(2,k) of the raters' mean.

    ``table`` (n_targets, n_raters) is complete. nan for fewer than two of either, or where nothing
    varies.
    """
    x = np.asarray(table, dtype=float)
    n, k = x.shape
    if n < 2 or k < 2 or np.ptp(x) == 0:
        return Coefficient(), Coefficient()
    rows, columns, whole = x.mean(axis=1), x.mean(axis=0), x.mean()
    msr = k * float(((rows - whole) ** 2).sum()) / (n - 1)
    msc = n * float(((columns - whole) ** 2).sum()) / (k - 1)
    rest = x - rows[:, None] - columns + whole
    mse = float((rest**2).sum()) / ((n - 1) * (k - 1))
    one = (msr - mse) / (msr + (k - 1) * mse + k * (msc - mse) / n)
    mean = (msr - mse) / (msr + (msc - mse) / n)
    low, high = _icc_bounds(one, (msr, msc, mse), n, k)
    return Coefficient(one, low, high), Coefficient(mean, *(_stepped_up(b, k) for b in (low, high)))


def _icc_bounds(
    icc: float, squares: tuple[float, float, float], n: int, k: int
) -> tuple[float, float]:
    msr, msc, mse = squares
    if icc >= 1 or mse <= 0:
        return np.nan, np.nan
    a = k * icc / (n * (1 - icc))
    b = 1 + k * icc * (n - 1) / (n * (1 - icc))
    parts = (a * msc) ** 2 / (k - 1) + (b * mse) ** 2 / ((n - 1) * (k - 1))
    freedom = (a * msc + b * mse) ** 2 / parts
    below, above = fdtri(n - 1, freedom, _TAIL), fdtri(freedom, n - 1, _TAIL)
    noise = k * msc + (k * n - k - n) * mse
    low = n * (msr - below * mse) / (below * noise + n * msr)
    high = n * (above * msr - mse) / (noise + n * above * msr)
    return float(low), float(high)


def _stepped_up(icc: float, k: int) -> float:
    """Return the reliability of k raters' mean from that of one (Spearman and Brown)."""
    return k * icc / (1 + (k - 1) * icc)
