"""Bias and inconsistency of every person: ITU-T P.910 Annex E by alternating projection.

    u_ij = psi_j + b_i + v_i e,   e ~ N(0, 1)

Li and Bampis 2017; Li et al. 2020 (HVEI). It takes ratings as metric and serves to look at people,
not to decide on LoDs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.screening.presented import Floats, Presented, sums

FLOOR: Final = 0.15  # points
PRIOR: Final = 4.0
"""How many answers of ordinary scatter stand beside each person's own.

Of 14 ratings some person's fit by chance; they would then take all weight and fit perfectly.
"""

_STEPS: Final = 1000
_CLOSE: Final = 1e-8


@dataclass(frozen=True)
class BiasModel:
    """The stimuli's ``quality`` (n_stimuli,), people's ``bias`` and ``inconsistency`` (n_people,).

    Biases sum to zero.
    """

    quality: Floats
    bias: Floats
    inconsistency: Floats


def bias_and_inconsistency(
    shown: Presented, *, floor: float = FLOOR, prior: float = PRIOR, corrected: bool = True
) -> BiasModel:
    """Estimate quality, bias and inconsistency.

    ``floor`` is the least inconsistency, in points; ``prior`` how many answers of the people's
    common scatter each person's own is drawn together with; ``corrected`` allows for the share that
    a person's own ratings have in the quality they are compared with. The Annex itself has none of
    the three (0, 0, False): with few people one of them then takes all weight and fits exactly.
    """
    n_people = len(shown.people)
    n_stimuli = int(shown.stimulus.max(initial=-1)) + 1
    per_person, u = shown.answers, shown.rating
    per_stimulus = sums(shown.stimulus, np.ones_like(u), n_stimuli)
    quality = sums(shown.stimulus, u, n_stimuli) / per_stimulus
    bias = sums(shown.person, u - quality[shown.stimulus], n_people) / per_person
    scatter = np.ones(n_people)
    for _ in range(_STEPS):
        before = quality
        free = _free(shown, scatter) if corrected else per_person
        scatter = np.maximum(_scatter(shown, quality, bias, free=free, prior=prior), floor)
        weight = (scatter**-2)[shown.person]
        quality = sums(shown.stimulus, weight * (u - bias[shown.person]), n_stimuli)
        quality /= sums(shown.stimulus, weight, n_stimuli)
        bias = sums(shown.person, u - quality[shown.stimulus], n_people) / per_person
        if np.linalg.norm(quality - before) < _CLOSE:
            break
    centre = bias.mean() if n_people else 0.0
    return BiasModel(quality + centre, bias - centre, scatter)


def _free(shown: Presented, scatter: Floats) -> Floats:
    """Return how many ratings of each person are free: all, less their weight in the qualities."""
    weight = (scatter**-2)[shown.person]
    n_stimuli = int(shown.stimulus.max(initial=-1)) + 1
    share = weight / sums(shown.stimulus, weight, n_stimuli)[shown.stimulus]
    return np.maximum(sums(shown.person, 1.0 - share, len(shown.people)), 1e-9)


def _scatter(
    shown: Presented, quality: Floats, bias: Floats, *, free: Floats, prior: float
) -> Floats:
    """Return the standard deviation of each person's residuals about their mean."""
    rest = shown.rating - quality[shown.stimulus] - bias[shown.person]
    n_people = len(shown.people)
    mean = sums(shown.person, rest, n_people) / shown.answers
    square = sums(shown.person, (rest - mean[shown.person]) ** 2, n_people)
    common = square.sum() / max(float(free.sum()), 1e-9)
    return np.asarray(np.sqrt((square + prior * common) / (free + prior)))
