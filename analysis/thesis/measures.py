"""The measures behind the thesis's claims: each takes tables and says what they hold, or nothing.

A measure is "not asked here" where the study showed or asked nothing of the kind.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd

from analysis.correlation import ALL_DISTANCES, rank_correlations
from analysis.descriptive.means import answered, person_means, t_interval
from analysis.descriptive.shares import paired, wilson
from analysis.tables.reading import Tables
from analysis.words.wording import interval, number, people, percent

POINTS, SHARE, TAU = "points", "share of people", "τ-b"
Pairs = Sequence[tuple[str, str]]


@dataclass(frozen=True)
class Found:
    """Our number in words and as figures; ``people`` counts whom it rests on."""

    text: str
    value: float = np.nan
    low: float = np.nan
    high: float = np.nan
    unit: str = ""
    people: int = 0


NOT_ASKED: Final = Found("not asked here")


def mean_at(tables: Tables, distance: str, lod: str) -> Found:
    """Return the mean rating of a LoD at a distance, over people."""
    own = _person_means(tables)
    if (distance, lod) not in own:
        return NOT_ASKED
    return _mean(own[distance, lod].dropna(), "mean {value}", POINTS)


def gap_of_lods(tables: Tables, distance: str, upper: str, lower: str) -> Found:
    """Return how much higher one LoD was rated than another at a distance, within people."""
    own = _person_means(tables)
    if (distance, upper) not in own or (distance, lower) not in own:
        return NOT_ASKED
    gap = (own[distance, upper] - own[distance, lower]).dropna()
    return _mean(gap, f"{upper} minus {lower} {{value}}", POINTS)


def gap_of_distances(tables: Tables, lod: str, distance: str, others: Sequence[str]) -> Found:
    """Return how much higher a LoD was rated at one distance than at the others, within people."""
    own = _person_means(tables)
    rest = [own[other, lod] for other in others if (other, lod) in own]
    if (distance, lod) not in own or not rest:
        return NOT_ASKED
    gap = (own[distance, lod] - pd.concat(rest, axis=1).mean(axis=1)).dropna()
    where = ", ".join(other for other in others if (other, lod) in own)
    return _mean(gap, f"{distance} minus {where} {{value}}", POINTS)


def ends_of_scale(tables: Tables, rating: int) -> Found:
    """Return how often people gave one rating: the mean of their shares."""
    rows = answered(tables.ratings)
    if rows.empty:
        return NOT_ASKED
    given = (rows["rating"] == rating).groupby(rows["participant"])
    shares, counts = given.mean(), given.sum()
    low, high = np.clip(t_interval(shares), 0, 1)
    text = (
        f"a {rating} in {int(counts.sum())} of {len(rows)} ratings, "
        f"at most {int(counts.max())} by one person; "
        f"{percent(shares.mean())} of a person's ratings ({_range(low, high)}, "
        f"{people(len(shares))})"
    )
    return Found(text, float(shares.mean()), low, high, "share of ratings", len(shares))


def follows(tables: Tables, distance: str = ALL_DISTANCES) -> Found:
    """Return Kendall's tau-b of ratings with LoDs within people, at one distance or over all."""
    table = rank_correlations(tables.ratings)
    rows = table[table["distance"] == distance]
    if rows.empty and distance == ALL_DISTANCES:
        rows = table  # one distance is all there are
    if rows.empty or pd.isna(rows["tau_b"].iloc[0]):
        return NOT_ASKED
    row = rows.iloc[0]
    tau, low, high = (row[name] for name in ("tau_b", "tau_low", "tau_high"))
    n = int(row["people"] - row["without_spread"])  # those who have a tau
    text = f"τ-b {number(tau)} ({_certainty(low, high, n)})"
    return Found(text, float(tau), float(low), float(high), TAU, n)


def apart(tables: Tables, effect: str, levels: Sequence[str]) -> Pairs:
    """Return the pairs of LoDs of which one alone has an effect at one of these levels.

    By the levels that the ratings tell; where they tell none, a LoD's name is its level.
    """
    rows = tables.ratings[["lod"]].assign(level=tables.ratings.get(effect))
    if rows["level"].isna().all():
        rows = rows.assign(level=rows["lod"])
    level = rows.dropna().drop_duplicates("lod").set_index("lod")["level"]
    has = level.isin(levels)
    return [(without, with_it) for without in level[~has].index for with_it in level[has].index]


def noticed(tables: Tables, pairs: Pairs, distance: str | None = None, *, where: str = "") -> Found:
    """Return how many people shown one of the pairs noticed a difference, ``where`` in words."""
    rows = tables.comparisons
    rows = rows[rows["noticed"].notna() & ~rows["is_practice"]]
    rows = _of_pairs(paired(rows, with_equal=False), pairs, distance)
    said = (rows["noticed"] == "yes").groupby(rows["participant"]).any()
    return _share(said, f"noticed a difference{where}")


def mentioned(
    table: pd.DataFrame, code: str, pairs: Pairs | None = None, distance: str | None = None
) -> Found:
    """Return how many people mention a thing; ``table`` is that of ``coding.mentions``.

    Of those who were shown one of the pairs, or any pair, at the distance, or at any.
    """
    rows = _of_pairs(table, pairs, distance)
    said = rows.groupby("participant")[code].any()
    return _share(said, "mention it")


def _person_means(tables: Tables) -> pd.DataFrame:
    """Return each person's mean rating: one row per person, one column per (distance, LoD)."""
    own = person_means(tables.ratings, ["distance", "lod"])
    return own.pivot(index="participant", columns=["distance", "lod"], values="rating")


def _of_pairs(rows: pd.DataFrame, pairs: Pairs | None, distance: str | None) -> pd.DataFrame:
    if distance is not None:
        rows = rows[rows["distance"] == distance]
    if pairs is None:
        return rows
    wanted = {frozenset(pair) for pair in pairs}
    shown = zip(rows["lesser"], rows["greater"], strict=True)
    return rows[np.array([frozenset(pair) in wanted for pair in shown], dtype=bool)]


def _share(said: pd.Series, what: str) -> Found:
    count, total = int(said.sum()), len(said)
    if not total:
        return NOT_ASKED
    low, high = wilson(count, total)
    text = f"{count} of {total} people {what} ({_range(low, high)})"
    return Found(text, count / total, low, high, SHARE, total)


def _mean(values: pd.Series, text: str, unit: str) -> Found:
    if values.empty:
        return NOT_ASKED
    mean = float(values.mean())
    low, high = t_interval(values)
    said = text.format(value=number(mean))
    count = len(values)
    return Found(f"{said} ({_certainty(low, high, count)})", mean, low, high, unit, count)


def _certainty(low: float, high: float, n: int) -> str:
    return f"{interval(low, high)}, {people(n)}"


def _range(low: float, high: float) -> str:
    if not np.isfinite(low):
        return "no interval"
    return f"{percent(low)} to {percent(high)}"
