"""How each person's and everybody's ratings order with the LoDs, per distance and over all."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.correlation.averages import mean_tau, repeated_measures_correlation, tau_p
from analysis.correlation.concordance import Concordance, count_pairs
from analysis.descriptive.means import answered, t_interval
from analysis.tables.ordering import distance_order

Floats = NDArray[np.float64]
ALL_DISTANCES: Final = "all"


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
