"""Does perceived realism follow the actual LoD? Rank correlation that respects repeated measures.

Pooling all ratings would treat one person's answers as independent people. So: Kendall's tau-b
within each person, averaged on Fisher's z scale over people; beside it Somers' d, which counts a
tie as no preference, and the repeated-measures correlation (parallel lines, one per person).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray
from scipy.special import ndtri, stdtr, stdtrit

from analysis.descriptive import CONFIDENCE, answered, t_interval
from analysis.tables.ordering import distance_order

Floats = NDArray[np.float64]
ALL_DISTANCES: Final = "all"
_NEAR_ONE: Final = 1 - 1e-15  # Fisher's z of 1 is infinite


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


def person_concordance(ratings: pd.DataFrame) -> pd.DataFrame:
    """Return tau-b and Somers' d of every person, per distance and over all distances.

    Over all, only ratings given at one distance are compared with each other: a low LoD far away
    may look better than a high one close by. Columns: distance, participant, ratings, untied
    (pairs), tau_b, somers_d. Someone whose ratings are all alike has an empty tau_b.
    """
    rows = answered(ratings[ratings["lod_rank"].notna()])
    people, labels = pd.factorize(rows["participant"])
    n_people = len(labels)
    total = Concordance(*(np.zeros(n_people) for _ in range(4)))
    asked = np.zeros(n_people)
    parts = []
    for distance in distance_order(rows):
        is_here = (rows["distance"] == distance).to_numpy(dtype=bool)
        own, index = np.unique(people[is_here], return_inverse=True)
        here = rows[is_here]
        pairs = count_pairs(index, here["lod_rank"].astype(float), here["rating"])
        has_ranks = pairs.of_different_rank > 0  # with one LoD nothing was asked of this person
        number = np.bincount(index, minlength=own.size).astype(float)
        parts.append(_as_table(distance, labels[own], number, pairs)[has_ranks])
        for name in (field.name for field in fields(Concordance)):
            getattr(total, name)[own] += getattr(pairs, name)
        asked[own] += np.where(has_ranks, number, 0)
    everything = _as_table(ALL_DISTANCES, labels, asked, total)
    return pd.concat([*parts, everything[asked > 0]], ignore_index=True)


def _as_table(
    distance: str, people: Iterable[object], number: Floats, pairs: Concordance
) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "distance": distance,
            "participant": pd.Series(list(people), dtype="string"),
            "ratings": number.astype(int),
            "untied": pairs.untied.astype(int),
            "tau_b": pairs.tau_b,
            "somers_d": pairs.somers_d,
        }
    )


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


def rank_correlations(ratings: pd.DataFrame) -> pd.DataFrame:
    """Return, per distance and over all, how ratings order with the actual LoD.

    Columns: distance, people, without_spread (people whose ratings are all alike), ratings, tau_b
    with tau_low, tau_high and tau_p (of no correlation), somers_d with d_low, d_high, rmcorr with
    rm_low, rm_high, rm_dof.
    """
    people = person_concordance(ratings)
    rows = answered(ratings[ratings["lod_rank"].notna()])
    table = []
    for distance, own in people.groupby("distance", sort=False):
        part = rows if distance == ALL_DISTANCES else rows[rows["distance"] == distance]
        part = part[part["participant"].isin(own["participant"])]
        tau, tau_low, tau_high = mean_tau(own["tau_b"], own["untied"])
        d_low, d_high = np.clip(t_interval(own["somers_d"]), -1, 1)
        unit = part["participant"].astype(str) + "|" + part["distance"].astype(str)
        r, r_low, r_high, dof = repeated_measures_correlation(
            unit, part["lod_rank"].astype(float), part["rating"]
        )
        row = {"distance": distance, "people": len(own)}
        row |= {"without_spread": int(own["tau_b"].isna().sum())}
        row |= {"ratings": int(own["ratings"].sum())}
        row |= {"tau_b": tau, "tau_low": tau_low, "tau_high": tau_high}
        row |= {"tau_p": tau_p((tau, tau_low, tau_high), int(own["tau_b"].notna().sum()))}
        row |= {"somers_d": own["somers_d"].mean(), "d_low": d_low, "d_high": d_high}
        row |= {"rmcorr": r, "rm_low": r_low, "rm_high": r_high, "rm_dof": dof}
        table.append(row)
    columns = ["distance", "people", "without_spread", "ratings", "tau_b", "tau_low", "tau_high"]
    columns += ["tau_p", "somers_d", "d_low", "d_high", "rmcorr", "rm_low", "rm_high", "rm_dof"]
    result = pd.DataFrame(table, columns=columns)
    is_only_one = len(result) == 2
    return result[result["distance"] != ALL_DISTANCES] if is_only_one else result
