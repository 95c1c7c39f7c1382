"""Pairs of one person's ratings: concordant with the LoDs' ranks, discordant or tied."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Concordance:
    """How ratings order with the LoDs' ranks within each person, counted over pairs of ratings.

    Every field is an array (n_people,).
    """

    concordant: Floats
    discordant: Floats
    tied_in_rating: Floats
    tied_in_rank: Floats

    @property
    def untied(self) -> Floats:
        """Pairs that differ in rank and in rating."""
        return self.concordant + self.discordant

    @property
    def of_different_rank(self) -> Floats:
        """Pairs that differ in rank."""
        return self.untied + self.tied_in_rating

    @property
    def tau_b(self) -> Floats:
        """Kendall's tau-b; nan without spread in ranks or in ratings."""
        norm = np.sqrt(self.of_different_rank * (self.untied + self.tied_in_rank))
        return _ratio(self.concordant - self.discordant, norm)

    @property
    def somers_d(self) -> Floats:
        """Somers' d of rating given rank: (higher - lower) / pairs of different rank."""
        return _ratio(self.concordant - self.discordant, self.of_different_rank)


def count_pairs(person: ArrayLike, rank: ArrayLike, rating: ArrayLike) -> Concordance:
    """Count concordant, discordant and tied pairs of ratings within each person, in their order.

    Persons are numbers from 0. Works on counts of each rank with each rating, so its cost grows
    with the number of ratings and not with that of pairs.
    """
    own = np.asarray(person, dtype=np.intp)
    _, a = np.unique(np.asarray(rank, dtype=float), return_inverse=True)
    _, s = np.unique(np.asarray(rating, dtype=float), return_inverse=True)
    shape = tuple(int(index.max(initial=-1)) + 1 for index in (own, a, s))
    place = np.ravel_multi_index((own, a, s), shape) if own.size else own
    counts = np.bincount(place, minlength=math.prod(shape)).reshape(shape).astype(float)
    above = _beyond(counts)  # ratings of higher rank and higher rating than each cell
    below = _beyond(counts[:, :, ::-1])[:, :, ::-1]  # of higher rank and lower rating
    per_rating, per_rank = counts.sum(axis=1), counts.sum(axis=2)
    same = (counts**2).sum(axis=(1, 2))
    return Concordance(
        concordant=(counts * above).sum(axis=(1, 2)),
        discordant=(counts * below).sum(axis=(1, 2)),
        tied_in_rating=((per_rating**2).sum(axis=1) - same) / 2,
        tied_in_rank=((per_rank**2).sum(axis=1) - same) / 2,
    )


def _beyond(counts: Floats) -> Floats:
    """Sum, for every cell of (person, rank, rating), the cells that lie higher in both."""
    total = counts[:, ::-1, ::-1].cumsum(axis=1).cumsum(axis=2)[:, ::-1, ::-1]
    beyond: Floats = np.zeros_like(counts)
    beyond[:, :-1, :-1] = total[:, 1:, 1:]
    return beyond


def _ratio(numerator: Floats, denominator: Floats) -> Floats:
    result: Floats = np.full(numerator.shape, np.nan)
    np.divide(numerator, denominator, out=result, where=denominator > 0)
    return result
