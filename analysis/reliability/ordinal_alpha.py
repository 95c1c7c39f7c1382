"""Krippendorff's alpha for ordered ratings, missing ones allowed, written from its formula.

Krippendorff 2011, "Computing Krippendorff's alpha-reliability".
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray
from scipy.special import stdtrit

from analysis.reliability.intraclass import Coefficient

Floats = NDArray[np.float64]
Places = NDArray[np.intp]
_TAIL: Final = 0.975
_RESAMPLES: Final = 2000


@dataclass(frozen=True)
class _Units:
    """Per unit its number of ratings, the sum of their ranks and of the ranks' squares."""

    count: Floats
    total: Floats
    square: Floats

    def disagreement(self) -> Floats:
        """Return 2 (m Q - S^2) / (m - 1), what a unit adds to the observed disagreement."""
        spread = 2 * (self.count * self.square - self.total**2)
        return np.divide(spread, self.count - 1, out=np.zeros_like(spread), where=self.count > 1)


def _alpha(
    disagreement: ArrayLike, count: ArrayLike, total: ArrayLike, square: ArrayLike
) -> Floats:
    """Return 1 - Do / De from sums over units; nan where all ratings are alike."""
    d, n, s, q = (np.asarray(part, dtype=float) for part in (disagreement, count, total, square))
    expected = 2 * (n * q - s**2) / np.maximum(n - 1, 1)
    alpha: Floats = np.full(d.shape, np.nan)
    np.divide(d, expected, out=alpha, where=expected > 1e-9 * np.maximum(q, 1))
    return 1 - alpha


def krippendorff(
    unit: ArrayLike, rater: ArrayLike, rating: ArrayLike, rng: np.random.Generator
) -> tuple[Coefficient, Coefficient]:
    """Return ordinal alpha twice: with an interval over raters, and with one over units.

    One entry per rating given; missing ones are left out. The ordinal distance of two values is
    that of their mid-ranks among all pairable values, sum_{g=c..k} n_g - (n_c + n_k) / 2, so alpha
    needs sums only. Over raters: jackknife and Student's t; over units: percentile bootstrap.
    Ranks are kept as they are meanwhile.
    """
    units, raters = (np.unique(np.asarray(x), return_inverse=True)[1] for x in (unit, rater))
    values = np.asarray(rating, dtype=float)
    pairable = np.bincount(units)[units] > 1 if units.size else np.zeros(0, dtype=bool)
    units, raters = (np.unique(x[pairable], return_inverse=True)[1] for x in (units, raters))
    if not units.size:
        return Coefficient(), Coefficient()
    rank = pd.Series(values[pairable]).rank().to_numpy()
    rank = (rank - rank.mean()) / rank.size
    own = _Units(*(np.bincount(units, rank**power).astype(float) for power in (0, 1, 2)))
    sums = (own.disagreement().sum(), own.count.sum(), own.total.sum(), own.square.sum())
    value = float(_alpha(*sums))
    over_raters = _jackknife(own, (units, raters, rank), sums, value)
    return Coefficient(value, *over_raters), Coefficient(value, *_resampled(own, rng))


def _jackknife(
    own: _Units,
    ratings: tuple[Places, Places, Floats],
    sums: tuple[float, float, float, float],
    value: float,
) -> tuple[float, float]:
    """Leave out one rater at a time; return Student's t interval of the pseudo-values' mean."""
    units, raters, rank = ratings
    n = int(raters.max()) + 1
    if n < 3 or not np.isfinite(value):
        return np.nan, np.nan
    _, pair = np.unique(raters * len(own.count) + units, return_inverse=True)
    first = np.unique(pair, return_index=True)[1]
    who, at = raters[first], units[first]
    gone = _Units(*(np.bincount(pair, rank**power).astype(float) for power in (0, 1, 2)))
    rest = _Units(
        own.count[at] - gone.count, own.total[at] - gone.total, own.square[at] - gone.square
    )
    stays = rest.count > 1
    before = own.disagreement()[at]
    parts = [np.bincount(who, before - rest.disagreement(), minlength=n)]
    for name in ("count", "total", "square"):
        left = np.where(stays, getattr(rest, name), 0.0)
        parts.append(np.bincount(who, getattr(own, name)[at] - left, minlength=n))
    without = _alpha(*(whole - part for whole, part in zip(sums, parts, strict=True)))
    pseudo = n * value - (n - 1) * without[np.isfinite(without)]
    if pseudo.size < 3 or np.ptp(pseudo) == 0:
        return np.nan, np.nan
    half = stdtrit(pseudo.size - 1, _TAIL) * pseudo.std(ddof=1) / np.sqrt(pseudo.size)
    return float(value - half), float(min(value + half, 1.0))


def _resampled(own: _Units, rng: np.random.Generator) -> tuple[float, float]:
    n = len(own.count)
    if n < 3:
        return np.nan, np.nan
    parts = np.stack([own.disagreement(), own.count, own.total, own.square])
    often = rng.multinomial(n, np.full(n, 1 / n), size=_RESAMPLES)
    found = _alpha(*(parts @ often.T))
    if np.isfinite(found).sum() < _RESAMPLES / 2:
        return np.nan, np.nan
    low, high = np.nanquantile(found, (1 - _TAIL, _TAIL))
    return float(low), float(high)
