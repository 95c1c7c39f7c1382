"""One figure from many people's: their mean tau-b, and the slope that all of them share."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import ndtri, stdtr, stdtrit

from analysis.descriptive.means import CONFIDENCE

Floats = NDArray[np.float64]
_NEAR_ONE: Final = 1 - 1e-15  # Fisher's z of 1 is infinite


def mean_tau(tau: ArrayLike, untied: ArrayLike) -> tuple[float, float, float]:
    """Average people's tau-b on Fisher's z scale, weighted by untied pairs; mean, low, high.

    A perfect tau of m untied pairs counts as m / (m + 1), which keeps z finite. The interval is
    Student's t with people as units; nan where there are fewer than two.
    """
    t, m = np.asarray(tau, dtype=float), np.asarray(untied, dtype=float)
    t, m = t[np.isfinite(t)], m[np.isfinite(t)]
    if t.size == 0:
        return (np.nan, np.nan, np.nan)
    limit = m / (m + 1)
    z = np.arctanh(np.clip(t, -limit, limit))
    mean = float(np.average(z, weights=m))
    residual = m * (z - mean)
    if t.size < 2 or not np.any(residual):
        return (float(np.tanh(mean)), np.nan, np.nan)
    n = t.size
    error = np.sqrt((residual**2).sum() * n / (n - 1)) / m.sum()
    half = stdtrit(n - 1, 0.5 + CONFIDENCE / 2) * error
    low, high = np.tanh([mean - half, mean + half])
    return (float(np.tanh(mean)), float(low), float(high))


def tau_p(mean: tuple[float, float, float], people: int) -> float:
    """Return the two-sided p value of "no correlation" from ``mean_tau`` of so many people.

    Its interval is Student's t on Fisher's z scale, hence so is the test; nan without an interval.
    """
    z, low, high = np.arctanh(np.clip(mean, -_NEAR_ONE, _NEAR_ONE))
    if people < 2 or not high > low:
        return np.nan
    error = (high - low) / (2 * stdtrit(people - 1, 0.5 + CONFIDENCE / 2))
    return float(2 * stdtr(people - 1, -abs(z) / error))


def repeated_measures_correlation(
    person: ArrayLike, x: ArrayLike, y: ArrayLike
) -> tuple[float, float, float, int]:
    """Return r, its 95 % interval and its degrees of freedom from y ~ person + x.

    Bland and Altman 1995; Bakdash and Marusich 2017: r = sign(b) sqrt(SSx / (SSx + SSe)) with
    N - n - 1 degrees of freedom, the interval by Fisher's z. nan where x or y never varies within
    a person.
    """
    labels = np.asarray(person)
    dx = _within(labels, np.asarray(x, dtype=float))
    dy = _within(labels, np.asarray(y, dtype=float))
    dof = dx.size - np.unique(labels).size - 1
    norm = np.sqrt((dx**2).sum() * (dy**2).sum())
    if dof < 1 or norm < 1e-12:
        return (np.nan, np.nan, np.nan, max(dof, 0))
    r = float(np.clip((dx * dy).sum() / norm, -1, 1))
    if dof < 2 or abs(r) == 1:
        return (r, np.nan, np.nan, dof)
    half = float(ndtri(0.5 + CONFIDENCE / 2)) / np.sqrt(dof - 1)
    low, high = np.tanh([np.arctanh(r) - half, np.arctanh(r) + half])
    return (r, float(low), float(high), dof)


def _within(labels: np.ndarray, values: Floats) -> Floats:
    _, index = np.unique(labels, return_inverse=True)
    means = np.bincount(index, values) / np.bincount(index)
    centred: Floats = values - means[index]
    return centred
