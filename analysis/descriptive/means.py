"""Mean realism with intervals, differences within people, and counts of every rating.

Each takes the ratings table and gives a table. A person counts once: repeated ratings of one
thing by one person are averaged first, and intervals are Student's t over the people's means. With
ten people they keep their 95 % far better than the normal or the percentile bootstrap.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from scipy.special import stdtrit

from analysis.tables.ordering import in_order

CONFIDENCE: Final = 0.95


def t_interval(values: ArrayLike, *, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Return the t interval of a mean: m ± t(n-1) s / sqrt(n); nan, nan where there is none.

    There is none for fewer than two values, nor for values that are all alike: a spread of zero
    in a handful of whole numbers is no sign of certainty.
    """
    x = np.asarray(values, dtype=float)
    n = x.size
    if n < 2 or np.ptp(x) == 0:
        return (np.nan, np.nan)
    half = stdtrit(n - 1, 0.5 + confidence / 2) * x.std(ddof=1) / np.sqrt(n)
    return (float(x.mean() - half), float(x.mean() + half))


def answered(ratings: pd.DataFrame) -> pd.DataFrame:
    """Return the rated rows that count: no practice, no missing rating; the rating as a float."""
    rows = ratings[ratings["rating"].notna() & ~ratings["is_practice"]]
    return rows.assign(rating=rows["rating"].astype(float)).reset_index(drop=True)


def person_means(ratings: pd.DataFrame, by: Sequence[str]) -> pd.DataFrame:
    """Return each person's mean rating per group: ``by``, participant, rating, count."""
    keys = [*by, "participant"]
    grouped = answered(ratings).groupby(keys, dropna=False, sort=False, observed=True)["rating"]
    return grouped.agg(rating="mean", count="count").reset_index()


def mean_ratings(ratings: pd.DataFrame, by: Sequence[str]) -> pd.DataFrame:
    """Return the mean rating per group with its t interval over people.

    Columns: ``by``, people, ratings, mean, sd (between people), low, high (95 %).
    """
    people = person_means(ratings, by)
    rows = []
    for key, group in people.groupby(list(by), dropna=False, sort=False, observed=True):
        x = group["rating"].to_numpy(dtype=float)
        low, high = t_interval(x)
        row = dict(zip(by, key, strict=True))
        row |= {"people": x.size, "ratings": int(group["count"].sum()), "mean": x.mean()}
        row |= {"sd": x.std(ddof=1) if x.size > 1 else np.nan, "low": low, "high": high}
        rows.append(row)
    columns = [*by, "people", "ratings", "mean", "sd", "low", "high"]
    return in_order(pd.DataFrame(rows, columns=columns), ratings)


def rating_counts(
    ratings: pd.DataFrame, by: Sequence[str], *, scale: tuple[int, int]
) -> pd.DataFrame:
    """Return how often each rating was given per group: ``by``, one column per rating, total."""
    rows = answered(ratings)
    steps = list(range(scale[0], scale[1] + 1))
    counts = (
        rows.assign(rating=rows["rating"].astype(int))
        .groupby([*by, "rating"], dropna=False, sort=False, observed=True)
        .size()
        .unstack("rating", fill_value=0)
        .reindex(columns=steps, fill_value=0)
    )
    counts.columns = [str(step) for step in steps]
    counts["total"] = counts.sum(axis=1)
    return in_order(counts.reset_index(), ratings)


def differences_from_best(ratings: pd.DataFrame) -> pd.DataFrame:
    """Compare, within people and per distance, the highest LoD shown there with each other one.

    Columns: distance, best, lod, is_ranked, people (who rated both), difference (best minus lod),
    low, high. A LoD without a rank is compared too but is never the best; a distance without any
    ranked LoD is left out.
    """
    people = person_means(ratings, ["distance", "lod", "lod_rank"])
    rows = []
    for distance, group in people.groupby("distance", sort=False):
        wide = group.pivot(index="participant", columns="lod", values="rating")
        ranks = group.drop_duplicates("lod").set_index("lod")["lod_rank"].sort_values()
        if ranks.isna().all():
            continue
        best = ranks.dropna().index[-1]
        for lod in ranks.index.drop(best):
            gap = (wide[best] - wide[lod]).dropna().to_numpy(dtype=float)
            low, high = t_interval(gap)
            row = {"distance": distance, "best": best, "lod": lod}
            row |= {"is_ranked": bool(pd.notna(ranks[lod])), "people": gap.size}
            row |= {"difference": gap.mean() if gap.size else np.nan, "low": low, "high": high}
            rows.append(row)
    columns = ["distance", "best", "lod", "is_ranked", "people", "difference", "low", "high"]
    return in_order(pd.DataFrame(rows, columns=columns), ratings)
