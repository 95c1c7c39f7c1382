"""Ratings taken as metres are: a Gaussian model with a random intercept for each person.

    y_ij = x_j'b + u_i + e_ij,   u_i ~ N(0, t^2),   e_ij ~ N(0, s^2)

What many studies report (R's lmer, statsmodels' MixedLM), here only to be compared with. Maximum
likelihood in closed form for a known ratio t^2 / s^2, which is found in one dimension. Its density
of a rating is no probability: for a comparison with ordinal models a rating k stands for everything
that is rounded to it, k - 1/2 to k + 1/2, with open ends.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from analysis.models.counts import Counts
from analysis.models.ordinal import OrdinalModel

Floats = NDArray[np.float64]
_RATIOS: Final = (-8.0, 4.0)  # log of t / s: below, people are alike; above, ratings are constant
_LEAST_SPREAD: Final = 1e-9
_LEAST_VARIANCE: Final = 1e-6  # constant ratings: a density without a bound is none


@dataclass(frozen=True)
class Sums:
    """All that the likelihood needs, one entry a person: sums over the person's ratings.

    ``size`` (n,), ``x`` (n, p), ``y`` (n,), ``xx`` (n, p, p), ``xy`` (n, p), ``yy`` (n,);
    ``often`` (n,) is how often a person counts.
    """

    size: Floats
    x: Floats
    y: Floats
    xx: Floats
    xy: Floats
    yy: Floats
    often: Floats

    def without(self, people: NDArray[np.intp]) -> Sums:
        """Return the same sums with some people counting for nothing."""
        often = self.often.copy()
        often[people] = 0.0
        return replace(self, often=often)


@dataclass(frozen=True)
class MetricFit:
    """The estimates: ``means`` (p,) of the design's columns, ``sd`` within and ``sd_people``."""

    means: Floats
    sd: float
    sd_people: float
    log_likelihood: float

    @property
    def parameters(self) -> int:
        """How many were estimated."""
        return len(self.means) + 2


def sums_of(counts: Counts, design: Floats, *, weights: Floats | None = None) -> Sums:
    """Sum up counts; ``design`` (n_stimuli, p) has the intercept as its first column.

    Ratings are the categories' numbers from 1. ``weights`` (n_people,) let a person count for less
    than one.
    """
    rating = np.arange(1.0, counts.categories + 1)
    size, total = counts.table.sum(axis=2), counts.table @ rating
    pairs = (design[:, :, None] * design[:, None, :]).reshape(len(design), -1)
    return Sums(
        size=size.sum(axis=1),
        x=size @ design,
        y=total.sum(axis=1),
        xx=(size @ pairs).reshape(-1, design.shape[1], design.shape[1]),
        xy=total @ design,
        yy=(counts.table @ rating**2).sum(axis=1),
        often=np.ones(counts.people) if weights is None else weights,
    )


def fit_metric(sums: Sums) -> MetricFit:
    """Fit by maximum likelihood (not restricted); the people's spread may be 0."""

    def lost(log_ratio: float) -> float:
        return -_at(sums, float(np.exp(2 * log_ratio))).log_likelihood

    best = minimize_scalar(lost, bounds=_RATIOS, method="bounded", options={"xatol": 1e-6})
    found, plain = _at(sums, float(np.exp(2 * best.x))), _at(sums, 0.0)
    return found if found.log_likelihood > plain.log_likelihood else plain


def as_ordinal(found: MetricFit, model: OrdinalModel, *, contrast: float | None = None) -> Floats:
    """Return the parameters that give a rating k the mass of k - 1/2 to k + 1/2.

    ``model`` has people's leniency, and the design without its intercept as its locations, with a
    ``contrast`` after them where its predictor has one. Its latent unit is the scatter within
    people.
    """
    count = model.categories - 2
    return np.concatenate(
        [
            [(1.5 - found.means[0]) / found.sd],
            np.full(count, -np.log(found.sd)),
            found.means[1:] / found.sd,
            [] if contrast is None else [contrast],
            [np.log(max(found.sd_people / found.sd, _LEAST_SPREAD))],
        ]
    )


def _at(sums: Sums, ratio: float) -> MetricFit:
    """Fit with t^2 / s^2 known: generalised least squares, and s^2 from what is left over."""
    shrink = sums.often * ratio / (1.0 + ratio * sums.size)
    total = float(sums.often @ sums.size)
    xx = np.tensordot(sums.often, sums.xx, axes=1) - (sums.x * shrink[:, None]).T @ sums.x
    xy = sums.often @ sums.xy - sums.x.T @ (shrink * sums.y)
    yy = float(sums.often @ sums.yy - shrink @ sums.y**2)
    means: Floats = np.asarray(np.linalg.lstsq(xx, xy, rcond=None)[0], dtype=float)
    variance = max((yy - float(xy @ means)) / total, _LEAST_VARIANCE)
    spread = float(sums.often @ np.log1p(ratio * sums.size))
    height = -0.5 * (total * (np.log(2 * np.pi * variance) + 1.0) + spread)
    return MetricFit(means, float(np.sqrt(variance)), float(np.sqrt(ratio * variance)), height)
