"""The order in which things are shown: distances closest first, LoDs by rank, clips by number."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any, Final

import pandas as pd

from analysis.tables.columns import DISTANCES, EYES, STANDARD_LODS

_SHOWN_BY: Final = ("distance", "clip", "eye", "lesser", "greater", "lod")


def distance_order(rows: pd.DataFrame) -> list[str]:
    """Return the distances present, closest first; names of one's own follow by iris size."""
    present = rows.drop_duplicates("distance")["distance"].tolist()
    size = rows.groupby("distance")["iris_px"].median().fillna(0.0)
    own = sorted((d for d in present if d not in DISTANCES), key=lambda d: -float(size[d]))
    return [d for d in DISTANCES if d in present] + own


def lod_order(ratings: pd.DataFrame) -> list[str]:
    """Return the LoDs present by rank; LoDs without a rank follow by name."""
    ranks = ratings.drop_duplicates("lod").set_index("lod")["lod_rank"]
    known = ranks.dropna().sort_values(kind="stable").index.tolist()
    return [*known, *sorted(ranks.index[ranks.isna()])]


def lod_ranks(ratings: pd.DataFrame) -> dict[str, float]:
    """Return each LoD's rank; -1, below all others, for those without one.

    The standard LoDs have theirs even where nobody rated them.
    """
    standard = {name: float(rank) for rank, name in enumerate(STANDARD_LODS)}
    rows = ratings.drop_duplicates("lod")
    own = zip(rows["lod"], rows["lod_rank"].fillna(-1), strict=True)
    return standard | {str(lod): float(rank) for lod, rank in own}


def natural(name: object) -> tuple[tuple[int, int | str], ...]:
    """Return a key that sorts clip-2 before clip-10."""
    parts = re.findall(r"\d+|\D+", str(name))
    return tuple((0, int(part)) if part.isdigit() else (1, part) for part in parts)


def in_order(table: pd.DataFrame, rows: pd.DataFrame) -> pd.DataFrame:
    """Sort a result that was made from ``rows``: by distance, clip, pair, LoD, eye."""
    keys = [name for name in _SHOWN_BY if name in table]
    if table.empty or not keys:
        return table.reset_index(drop=True)
    orders = {name: _order(table[name], name, rows) for name in keys}

    def position(column: pd.Series) -> pd.Series:
        return column.map(orders[str(column.name)])

    return table.sort_values(keys, key=position, kind="stable").reset_index(drop=True)


def _order(values: pd.Series, name: str, rows: pd.DataFrame) -> Mapping[Any, int]:
    given: dict[str, Callable[[], list[str]]] = {
        "distance": lambda: distance_order(rows),
        "lod": lambda: lod_order(rows),
        "lesser": lambda: list(STANDARD_LODS),
        "greater": lambda: list(STANDARD_LODS),
        "eye": lambda: list(EYES),
    }
    order = given[name]() if name in given else []
    rest = sorted(set(values.dropna()) - set(order), key=natural)
    return {value: i for i, value in enumerate([*order, *rest])}
