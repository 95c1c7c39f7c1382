"""The people whom the simulated observers come from: constants and the latent realism they share.

Every number here is assumed, except low at far (2.5) and the words that the thesis says about the
rest: simulated answers demonstrate the instrument, they say nothing about eyes.
Model and numbers: the project's reference on analysis, sections 5.1 and 5.2.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, roots_genlaguerre, roots_hermitenorm

from analysis.tables.columns import LEVELS, STANDARD_LODS

Floats = NDArray[np.float64]

# Population means of the ratings; columns are low, medium, high, ultra.
_MEAN_RATINGS: Mapping[str, tuple[float, ...]] = {
    "macroscopic": (1.60, 2.95, 3.05, 3.45),
    "near": (1.70, 2.60, 2.90, 3.00),
    "medium": (2.05, 2.70, 2.85, 2.90),
    "far": (2.50, 2.70, 2.75, 2.75),
}
_IRIS_PX: Mapping[str, float] = {"macroscopic": 350.0, "near": 160.0, "medium": 40.0, "far": 12.0}

# Greatest sensitivity (d') to the difference of a pair of LoDs: rows and columns low to ultra.
# Low against high is not in the reference; 3.6 lies between its neighbours.
_SENSITIVITY = (
    (0.0, 2.8, 3.6, 3.8),
    (2.8, 0.0, 3.0, 3.2),
    (3.6, 3.0, 0.0, 0.45),
    (3.8, 3.2, 0.45, 0.0),
)


@dataclass(frozen=True)
class Population:
    """The constants that simulated observers are drawn with.

    Latent quantities are in units of an average observer's noise. A pair (mean, sd) describes a
    normal distribution, of the logarithm where the name starts with ``log``.
    """

    mean_ratings: Mapping[str, tuple[float, ...]] = field(default_factory=lambda: _MEAN_RATINGS)
    iris_px: Mapping[str, float] = field(default_factory=lambda: _IRIS_PX)
    thresholds: tuple[float, ...] = (-1.35, -0.25, 0.85, 1.85)
    share_of_experts: float = 0.6  # the thesis had six colleagues among ten
    leniency_gap: float = 0.30  # experts are this much stricter than people who do not play
    leniency_sd: float = 0.45
    log_noise: tuple[float, float] = (-0.03, 0.25)
    expert_noise: float = 0.9
    other_noise: float = 1.1
    end_avoidance_shape: float = 2.0
    end_avoidance_scale: float = 0.15
    side: tuple[float, float] = (0.05, 0.15)
    log_tie_band: tuple[float, float] = (float(np.log(0.6)), 0.35)
    comparison_noise: float = 0.5
    lapse: float = 0.02
    contrast: float = 0.12
    drift_sd: float = 0.1  # per 10 trials
    criteria: tuple[tuple[float, float], tuple[float, float]] = ((0.8, 0.4), (1.3, 0.4))
    sensitivity: tuple[tuple[float, ...], ...] = _SENSITIVITY
    half_sensitivity_log2_px: float = 6.5  # iris of 90 px
    sensitivity_width_log2_px: float = 0.9
    expert_sensitivity: float = 1.15
    missing: tuple[float, float] = (0.01, 0.03)  # lowest and highest share of skipped questions

    @cached_property
    def latent(self) -> Mapping[str, tuple[float, ...]]:
        """Latent realism mu per distance, low to ultra, that gives ``mean_ratings``."""
        wanted = np.array(list(self.mean_ratings.values()))
        mu = self._solve(wanted)
        return {d: tuple(map(float, row)) for d, row in zip(self.mean_ratings, mu, strict=True)}

    def mean_rating(self, mu: Floats) -> Floats:
        """Return the population's mean rating of stimuli with latent realism ``mu``, any shape.

        Integrates over leniency in closed form, over noise and end-avoidance by Gauss quadrature.
        """
        hermite, hermite_weight = roots_hermitenorm(15)
        laguerre, laguerre_weight = roots_genlaguerre(15, self.end_avoidance_shape - 1)
        avoidance = self.end_avoidance_scale * laguerre
        noise = np.exp(self.log_noise[0] + self.log_noise[1] * hermite)
        weight = np.outer(hermite_weight, laguerre_weight)
        weight /= weight.sum()
        mean: Floats = np.zeros(np.shape(mu))
        groups = (
            (self.share_of_experts, 0.5, self.expert_noise),
            (1 - self.share_of_experts, -0.5, self.other_noise),
        )
        for share, group, factor in groups:
            sd = np.hypot(self.leniency_sd, factor * noise)[:, None]
            centre = np.asarray(mu)[..., None, None] - self.leniency_gap * group
            for k, shift in enumerate((-1.0, 0.0, 0.0, 1.0)):
                above = ndtr((centre - self.thresholds[k] - shift * avoidance) / sd)
                mean = mean + share * (above * weight).sum(axis=(-2, -1))
        rating: Floats = np.array((1 - self.lapse) * (1 + mean) + self.lapse * 3.0)
        return rating

    def _solve(self, wanted: Floats) -> Floats:
        low: Floats = np.full(wanted.shape, -8.0)
        high: Floats = np.full(wanted.shape, 8.0)
        for _ in range(50):
            middle: Floats = (low + high) / 2
            is_below = self.mean_rating(middle) < wanted
            low[is_below] = middle[is_below]
            high[~is_below] = middle[~is_below]
        return low

    def realism(self, distance: str, iris_px: float, rank: float) -> float:
        """Return mu of one eye; ``rank`` is 1 for low to 4 for ultra and may lie between.

        A distance without a name here is interpolated along log2 of the iris's diameter. Below
        low (an effect switched off) the step from medium to low is continued.
        """
        if distance in self.latent:
            row = np.array(self.latent[distance])
        else:
            places = np.log2(list(self.iris_px.values()))[::-1]
            rows = np.array([self.latent[d] for d in self.iris_px])[::-1]
            row = np.array([np.interp(np.log2(iris_px), places, rows[:, j]) for j in range(4)])
        steps = np.concatenate([[2 * row[0] - row[1]], row])
        return float(np.interp(rank, np.arange(5), steps))

    def visibility(self, iris_px: float) -> float:
        """Return which share of the greatest sensitivity is left at this size, 0 to 1."""
        x = np.log2(max(iris_px, 1e-3))
        return float(ndtr((x - self.half_sensitivity_log2_px) / self.sensitivity_width_log2_px))

    def pair_sensitivity(self, left_rank: float, right_rank: float) -> float:
        """Return d' at full size between two LoDs, bilinear between the standard ones."""
        matrix = np.array(self.sensitivity)
        ranks = np.arange(1, 5)
        along = [np.interp(left_rank, ranks, matrix[:, j]) for j in range(4)]
        return float(np.interp(right_rank, ranks, along))


def rank_of(lod: str, levels: Mapping[str, str] | None = None) -> float:
    """Return 1 to 4 for a standard LoD, else the mean rank of its effects' levels (off is 0).

    Raises ValueError for a LoD that is neither standard nor described by its levels.
    """
    if lod in STANDARD_LODS:
        return float(STANDARD_LODS.index(lod) + 1)
    if not levels:
        raise ValueError(
            f'LoD "{lod}" has no rank and no levels were given; accepted without levels: '
            + ", ".join(STANDARD_LODS)
        )
    return sum(LEVELS.index(level) for level in levels.values()) / len(levels)


POPULATION = Population()
