"""Shares of answers: which eye was more realistic, and whether a difference was noticed.

Per clip as it was shown, and per pair of LoDs whichever side they stood on. Shares carry Wilson's
interval. A person who saw one pair in several clips counts once per clip, so the intervals of pairs
are somewhat narrow; ``people`` says how many they were.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pandas as pd
from scipy.special import ndtri

from analysis.descriptive.means import CONFIDENCE
from analysis.tables.columns import NOTICED, STANDARD_LODS
from analysis.tables.ordering import in_order

MOST_CLIPS: Final = 24
"""More clips than these are told by pairing: what a page can show, and a reader take in."""

LEFT_BETTER: Final = "left"
NO_DIFFERENCE: Final = "none"
RIGHT_BETTER: Final = "right"
OUTCOMES: Final = (LEFT_BETTER, NO_DIFFERENCE, RIGHT_BETTER)
PAIR_OUTCOMES: Final = ("lesser", "none", "greater")
"""Which LoD of a pair was called more realistic; lesser and greater go by the LoDs' ranks."""


def wilson(count: int, total: int, *, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Return Wilson's score interval of a share, nan, nan without observations.

    Wilson 1927; as in Brown, Cai and DasGupta 2001, eq. 4.
    """
    if total == 0:
        return (np.nan, np.nan)
    z = float(ndtri(0.5 + confidence / 2))
    p = count / total
    centre = (p + z * z / (2 * total)) / (1 + z * z / total)
    half = z / (1 + z * z / total) * np.sqrt(p * (1 - p) / total + z * z / (4 * total**2))
    low = 0.0 if count == 0 else float(centre - half)
    high = 1.0 if count == total else float(centre + half)
    return (low, high)


def comparison_shares(comparisons: pd.DataFrame) -> pd.DataFrame:
    """Return, per clip, the shares of left better, no difference and right better.

    Columns: distance, clip, left_lod, right_lod, answer, count, total, share, low, high, people.
    """
    rows = _counted(comparisons, "comparison")
    return _shares(rows.assign(answer=_named(rows["comparison"], OUTCOMES)), _CLIP, OUTCOMES)


def pair_comparison_shares(comparisons: pd.DataFrame) -> pd.DataFrame:
    """Return, per distance and pair of different LoDs, which was called more realistic.

    Columns: distance, lesser, greater, answer (one of PAIR_OUTCOMES), count, total, share, low,
    high, people.
    """
    rows = paired(_counted(comparisons, "comparison"))
    toward = rows["comparison"].where(rows["greater_is_right"], -rows["comparison"])
    return _shares(rows.assign(answer=_named(toward, PAIR_OUTCOMES)), _PAIR, PAIR_OUTCOMES)


def notice_shares(comparisons: pd.DataFrame) -> pd.DataFrame:
    """Return, per clip, the shares of yes, unsure and no; columns as in ``comparison_shares``."""
    rows = _counted(comparisons, "noticed")
    return _shares(rows.assign(answer=rows["noticed"]), _CLIP, NOTICED)


def pair_notice_shares(comparisons: pd.DataFrame) -> pd.DataFrame:
    """Return, per distance and pair of LoDs, the shares of yes, unsure and no.

    Pairs of equal LoDs (catch trials) are pairs too: their yes are false alarms.
    """
    rows = paired(_counted(comparisons, "noticed"), with_equal=True)
    return _shares(rows.assign(answer=rows["noticed"]), _PAIR, NOTICED)


def clips_or_pairings(rows: pd.DataFrame, *, most: int = MOST_CLIPS) -> pd.DataFrame:
    """Return ratings or comparisons with pairings in place of clips where there are many clips.

    A pairing is the LoD on the left and the LoD on the right; clips that differ in size or
    direction alone are taken together. Rows that tell of no pairing keep their clip.
    """
    if rows.loc[~rows["is_practice"], ["distance", "clip"]].drop_duplicates().shape[0] <= most:
        return rows
    if "left_lod" in rows:
        left, right = rows["left_lod"], rows["right_lod"]
    else:
        is_left = (rows["eye"] == "left").fillna(False).astype(bool)
        other = rows["other_lod"].where(rows["eye"].notna())
        left, right = rows["lod"].where(is_left, other), other.where(is_left, rows["lod"])
    return rows.assign(clip=(left + PAIRED + right).fillna(rows["clip"]))


PAIRED: Final = " – "
_CLIP: Final = ("distance", "clip", "left_lod", "right_lod")
_PAIR: Final = ("distance", "lesser", "greater")


def _counted(comparisons: pd.DataFrame, question: str) -> pd.DataFrame:
    return comparisons[comparisons[question].notna() & ~comparisons["is_practice"]]


def _named(comparison: pd.Series, names: Sequence[str]) -> pd.Series:
    return comparison.map(dict(zip((-1, 0, 1), names, strict=True)))


def _rank(lods: pd.Series) -> pd.Series:
    return lods.map({lod: i for i, lod in enumerate(STANDARD_LODS)}).astype(float)


def paired(rows: pd.DataFrame, *, with_equal: bool = False) -> pd.DataFrame:
    """Add to comparisons the lesser and the greater LoD and whether the greater is on the right.

    Pairs without ranks go by name; pairs of equal LoDs are left out unless asked for.
    """
    if not with_equal:
        rows = rows[(rows["left_lod"] != rows["right_lod"]).astype(bool)]
    left, right = _rank(rows["left_lod"]), _rank(rows["right_lod"])
    by_name = (rows["right_lod"] >= rows["left_lod"]).to_numpy(dtype=bool)
    is_ranked = (left.notna() & right.notna()).to_numpy(dtype=bool)
    greater_is_right = np.where(is_ranked, (right >= left).to_numpy(dtype=bool), by_name)
    return rows.assign(
        lesser=rows["left_lod"].where(greater_is_right, rows["right_lod"]),
        greater=rows["right_lod"].where(greater_is_right, rows["left_lod"]),
        greater_is_right=greater_is_right,
    )


def _shares(rows: pd.DataFrame, by: Sequence[str], answers: Sequence[str]) -> pd.DataFrame:
    table = []
    for key, group in rows.groupby(list(by), dropna=False, sort=False, observed=True):
        total, people = len(group), group["participant"].nunique()
        for answer in answers:
            count = int((group["answer"] == answer).sum())
            low, high = wilson(count, total)
            row = dict(zip(by, key, strict=True)) | {"answer": answer, "count": count}
            row |= {"total": total, "share": count / total, "low": low, "high": high}
            table.append(row | {"people": people})
    columns = [*by, "answer", "count", "total", "share", "low", "high", "people"]
    return in_order(pd.DataFrame(table, columns=columns), rows)
