"""Does perceived realism follow the actual LoD? Rank correlation that respects repeated measures.

Pooling all ratings would treat one person's answers as independent people. So: Kendall's tau-b
within each person, averaged on Fisher's z scale over people; beside it Somers' d, which counts a
tie as no preference, and the repeated-measures correlation (parallel lines, one per person).
"""

from __future__ import annotations

from dataclasses import astuple, dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray
from scipy.special import ndtri, stdtrit

from analysis.descriptive import CONFIDENCE, answered, t_interval
from analysis.ordering import distance_order

Floats = NDArray[np.float64]
ALL_DISTANCES: Final = "all"


@dataclass(frozen=True)
class Concordance:
    """How one person's ratings order with the LoDs' ranks, counted over pairs of ratings."""

    concordant: int = 0
    discordant: int = 0
    tied_in_rating: int = 0
    tied_in_rank: int = 0

    def __add__(self, other: Concordance) -> Concordance:
        return Concordance(*(a + b for a, b in zip(astuple(self), astuple(other), strict=True)))

    @property
    def has_ranks(self) -> bool:
        """Whether any two of the ratings were of different rank."""
        return self.untied + self.tied_in_rating > 0

    @property
    def untied(self) -> int:
        """Pairs that differ in rank and in rating."""
        return self.concordant + self.discordant

    @property
    def tau_b(self) -> float:
        """Kendall's tau-b; nan without spread in ranks or in ratings."""
        x = self.untied + self.tied_in_rating
        y = self.untied + self.tied_in_rank
        gap = self.concordant - self.discordant
        return gap / float(np.sqrt(x * y)) if x and y else float("nan")

    @property
    def somers_d(self) -> float:
        """Somers' d of rating given rank: (higher - lower) / pairs of different rank."""
        x = self.untied + self.tied_in_rating
        return (self.concordant - self.discordant) / x if x else float("nan")


def count_pairs(rank: ArrayLike, rating: ArrayLike) -> Concordance:
    """Count concordant, discordant and tied pairs of one person's ratings."""
    x, y = np.asarray(rank, dtype=float), np.asarray(rating, dtype=float)
    upper = np.triu_indices(x.size, 1)
    dx = np.sign(x[:, None] - x[None, :])[upper]
    dy = np.sign(y[:, None] - y[None, :])[upper]
    return Concordance(
        concordant=int((dx * dy > 0).sum()),
        discordant=int((dx * dy < 0).sum()),
        tied_in_rating=int(((dx != 0) & (dy == 0)).sum()),
        tied_in_rank=int(((dx == 0) & (dy != 0)).sum()),
    )


def person_concordance(ratings: pd.DataFrame) -> pd.DataFrame:
    """Return tau-b and Somers' d of every person, per distance and over all distances.

    Over all, only ratings given at one distance are compared with each other: a low LoD far away
    may look better than a high one close by. Columns: distance, participant, ratings, untied
    (pairs), tau_b, somers_d. Someone whose ratings are all alike has an empty tau_b.
    """
    rows = answered(ratings[ratings["lod_rank"].notna()])
    counted: dict[tuple[str, str], tuple[Concordance, int]] = {}
    for distance in distance_order(rows):
        for person, own in rows[rows["distance"] == distance].groupby("participant", sort=False):
            pairs = count_pairs(own["lod_rank"].astype(float), own["rating"])
            if pairs.has_ranks:  # else only one LoD: nothing was asked of this person here
                counted[distance, str(person)] = (pairs, len(own))
                before, number = counted.get((ALL_DISTANCES, str(person)), (Concordance(), 0))
                counted[ALL_DISTANCES, str(person)] = (before + pairs, number + len(own))
    order = [*distance_order(rows), ALL_DISTANCES]
    table = [
        {
            "distance": distance,
            "participant": person,
            "ratings": number,
            "untied": pairs.untied,
            "tau_b": pairs.tau_b,
            "somers_d": pairs.somers_d,
        }
        for (distance, person), (pairs, number) in counted.items()
    ]
    table.sort(key=lambda row: order.index(str(row["distance"])))
    columns = ["distance", "participant", "ratings", "untied", "tau_b", "somers_d"]
    return pd.DataFrame(table, columns=columns)


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
    with tau_low, tau_high, somers_d with d_low, d_high, rmcorr with rm_low, rm_high, rm_dof.
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
        row |= {"somers_d": own["somers_d"].mean(), "d_low": d_low, "d_high": d_high}
        row |= {"rmcorr": r, "rm_low": r_low, "rm_high": r_high, "rm_dof": dof}
        table.append(row)
    columns = ["distance", "people", "without_spread", "ratings", "tau_b", "tau_low", "tau_high"]
    columns += ["somers_d", "d_low", "d_high", "rmcorr", "rm_low", "rm_high", "rm_dof"]
    result = pd.DataFrame(table, columns=columns)
    is_only_one = len(result) == 2
    return result[result["distance"] != ALL_DISTANCES] if is_only_one else result
