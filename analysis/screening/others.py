"""What others answer at each place, told for every person without their own answers.

Answers are cuts through a normal law whose middle differs from place to place:

    P(at most k) = Phi((tau_k - m - b) / sqrt(s^2 + e^2)),   m ~ N(0, w^2),   w^2 + s^2 = 1

with tau from the shares of all answers, e the error of m, and b how lenient somebody is. That takes
one number for each place, so a handful of people's answers are enough.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.special import ndtr, ndtri

from analysis.screening.presented import Floats

LAPSE: Final = 0.03  # of answers that anybody gives without a thought
_ROUNDS: Final = 20
_ROUNDS_WITHOUT: Final = 4  # from the fit to everybody
_LEAST: Final = 0.3  # answers added to every category: none is impossible
_SCATTER: Final = (0.15, 0.98)  # least and greatest s^2


@dataclass(frozen=True)
class Others:
    """For each person, what the others answer.

    ``middle`` and ``scatter`` (n_people, n_places), ``cuts`` (n_people, n_categories - 1) and
    ``shares`` (n_people, n_categories) of all answers.
    """

    middle: Floats
    scatter: Floats
    cuts: Floats
    shares: Floats

    def log_shares(self, person: int, lenience: Floats) -> Floats:
        """Return log P(category) at every place for somebody so lenient.

        ``lenience`` (n,) gives (n, n_places, n_categories).
        """
        moved = self.middle[person] + lenience[:, None]
        inside = _inside(moved, self.cuts[person], self.scatter[person][None])
        return np.asarray(np.log((1 - LAPSE) * inside + LAPSE * self.shares[person]))


def others_of(counts: Floats) -> Others:
    """Fit what others answer to counts (n_people, n_places, n_categories)."""
    if not counts.shape[1]:  # not asked
        shares, cuts = _pooled(counts)
        return Others(counts[:, :, 0], counts[:, :, 0], cuts, shares)
    total = counts.sum(axis=0, keepdims=True)
    middle, _, spread = _fit(total, np.zeros(total.shape[:2]), np.full(1, 0.5), _ROUNDS)
    rest = total - counts
    start = np.repeat(middle, len(counts), axis=0)
    middle, error, spread = _fit(rest, start, np.repeat(spread, len(counts)), _ROUNDS_WITHOUT)
    shares, cuts = _pooled(rest)
    return Others(middle, np.sqrt(_rest(spread)[:, None] + error), cuts, shares)


def _fit(counts: Floats, middle: Floats, spread: Floats, rounds: int) -> tuple[Floats, ...]:
    """Return places' middles, the square of their errors, and w^2, by scoring steps from a start.

    ``counts`` are (n, n_places, n_categories), all else (n, n_places) and (n,).
    """
    _, cuts = _pooled(counts)
    given = counts.sum(axis=2)
    error: Floats = np.zeros(middle.shape)
    for _ in range(rounds):
        rest, width = _rest(spread)[:, None], np.maximum(spread, 1e-3)[:, None]
        inside, slope = _with_slope(middle, cuts, np.sqrt(rest))
        inside = np.maximum(inside, 1e-9)
        error = 1.0 / (given * (slope**2 / inside).sum(axis=2) + 1.0 / width)
        step = error * ((counts * slope / inside).sum(axis=2) - middle / width)
        middle = np.clip(middle + np.clip(step, -1.0, 1.0), -3.0, 3.0)
        spread = np.minimum((middle**2 + error).mean(axis=1), 1.0)
    return middle, error, spread


def _rest(spread: Floats) -> Floats:
    return np.clip(1.0 - spread, *_SCATTER)


def _pooled(counts: Floats) -> tuple[Floats, Floats]:
    """Return the shares of all answers and the cuts that they make."""
    added = counts.sum(axis=1) + _LEAST
    shares = added / added.sum(axis=1, keepdims=True)
    return shares, ndtri(shares.cumsum(axis=1)[:, :-1])


def _inside(middle: Floats, cuts: Floats, scatter: Floats) -> Floats:
    z = (cuts - middle[..., None]) / scatter[..., None]
    below = ndtr(z)
    ends = np.zeros((*below.shape[:-1], 1))
    return np.diff(np.concatenate([ends, below, ends + 1.0], axis=-1), axis=-1)


def _with_slope(middle: Floats, cuts: Floats, scatter: Floats) -> tuple[Floats, Floats]:
    """Return P(category) and its derivative by the middle."""
    z = (cuts[:, None, :] - middle[..., None]) / scatter[..., None]
    below, steep = ndtr(z), np.exp(-0.5 * z * z) / np.sqrt(2 * np.pi) / scatter[..., None]
    ends = np.zeros((*below.shape[:-1], 1))
    inside = np.diff(np.concatenate([ends, below, ends + 1.0], axis=-1), axis=-1)
    return inside, -np.diff(np.concatenate([ends, steep, ends], axis=-1), axis=-1)
