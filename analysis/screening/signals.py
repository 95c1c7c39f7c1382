"""What each person's answers show, one row per person: all that flags and weights rest on."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from analysis.descriptive.shares import wilson
from analysis.screening.annex_e import bias_and_inconsistency
from analysis.screening.bt500 import is_rejected
from analysis.screening.evidence import evidence_of
from analysis.screening.following import following
from analysis.screening.presented import Presented, presented, sums
from analysis.tables.ordering import lod_ranks
from analysis.tables.reading import Tables

COLUMNS: Final = (
    *("participant", "ratings", "bias", "inconsistency", "bt500"),
    *("slope", "slope_error", "correlation", "same_share", "ends_share"),
    *("looking", "upright"),
    *("compared", "side", "side_share", "against", "against_share"),
    *("catch_pairs", "false_alarms", "alarms_low", "alarms_high"),
    *("presentations", "certified_share"),
)


def observer_signals(tables: Tables) -> pd.DataFrame:
    """Return one row per person who answered anything that counts; columns are COLUMNS.

    looking and upright: natural logarithms of the odds that the person looked, against that they
    did not and against that they turned the scale round (``evidence``);
    same_share: of the person's most frequent rating; ends_share: of the lowest and the highest;
    side_share: of comparisons that name ``side``; against: comparisons in which the greater LoD
    stood on the other side, and against_share how many of them name ``side`` all the same;
    false_alarms: share of yes among catch pairs, with Wilson's 95 % interval. A cell is empty
    where the person gave nothing to tell it from.
    """
    made = _of_ratings(tables)
    for part in (
        _of_comparisons(tables),
        _of_catches(tables),
        _watched(tables),
        _of_evidence(tables),
    ):
        made = made.merge(part, on="participant", how="outer")
    for name in ("ratings", "compared", "against", "catch_pairs", "presentations"):
        made[name] = made[name].fillna(0).astype(int)
    made["bt500"] = made["bt500"].eq(True)
    made["side"] = made["side"].fillna("")
    return made[list(COLUMNS)].sort_values("participant", ignore_index=True)


def _of_ratings(tables: Tables) -> pd.DataFrame:
    shown = presented(tables.ratings)
    found, follows = bias_and_inconsistency(shown), following(shown)
    low, high = tables.scale
    steps = np.stack(
        [
            sums(shown.person, (shown.rating == k).astype(float), len(shown.people))
            for k in range(low, high + 1)
        ]
    )
    return pd.DataFrame(
        {
            "participant": pd.Series(shown.people, dtype="string"),
            "ratings": shown.answers.astype(int),
            "bias": found.bias,
            "inconsistency": np.where(_has_scatter(shown), found.inconsistency, np.nan),
            "bt500": is_rejected(shown),
            "slope": follows.slope,
            "slope_error": follows.error,
            "correlation": follows.correlation,
            "same_share": steps.max(axis=0) / shown.answers,
            "ends_share": (steps[0] + steps[-1]) / shown.answers,
        }
    )


def _has_scatter(shown: Presented) -> np.ndarray:
    """Say who has residuals at all: more than one rating, and someone to compare with."""
    return (shown.answers > 1) & (len(shown.people) > 1)


def _counted(comparisons: pd.DataFrame, question: str) -> pd.DataFrame:
    return comparisons[comparisons[question].notna() & ~comparisons["is_practice"]]


def _of_comparisons(tables: Tables) -> pd.DataFrame:
    """Count sides; ties count as answers that name no side."""
    ranks = lod_ranks(tables.ratings)
    rows = _counted(tables.comparisons, "comparison")
    right, left = (
        np.array([ranks.get(str(lod), -1.0) for lod in rows[name]], dtype=float)
        for name in ("right_lod", "left_lod")
    )
    greater = np.where((right >= 0) & (left >= 0), np.sign(right - left), 0.0)
    said = rows["comparison"].astype(float).to_numpy()
    table = pd.DataFrame({"participant": rows["participant"].astype("string").to_numpy()})
    for name, sign in (("right", 1.0), ("left", -1.0)):
        table[name] = said == sign
        table[f"{name}_against"] = greater == -sign
        table[f"{name}_anyway"] = (greater == -sign) & (said == sign)
    table["compared"] = 1
    people = table.groupby("participant", sort=True).sum().astype(float)
    is_right = (people["right"] >= people["left"]).to_numpy()
    own = {
        name: np.where(is_right, people[f"right{name}"], people[f"left{name}"])
        for name in ("", "_against", "_anyway")
    }
    against = own["_against"]
    return pd.DataFrame(
        {
            "participant": people.index.astype("string"),
            "compared": people["compared"].to_numpy(),
            "side": np.where(is_right, "right", "left"),
            "side_share": own[""] / people["compared"].to_numpy(),
            "against": against,
            "against_share": np.divide(
                own["_anyway"], against, out=np.full(len(people), np.nan), where=against > 0
            ),
        }
    )


def _of_catches(tables: Tables) -> pd.DataFrame:
    rows = _counted(tables.comparisons, "noticed")
    rows = rows[(rows["left_lod"] == rows["right_lod"]).to_numpy(dtype=bool)]
    table = []
    for who, own in rows.groupby("participant", sort=True):
        yes, count = int((own["noticed"] == "yes").sum()), len(own)
        low, high = wilson(yes, count)
        table.append((who, count, yes / count, low, high))
    names = ["participant", "catch_pairs", "false_alarms", "alarms_low", "alarms_high"]
    return pd.DataFrame(table, columns=names).astype({"participant": "string"})


def _of_evidence(tables: Tables) -> pd.DataFrame:
    found = evidence_of(tables)
    return pd.DataFrame(
        {
            "participant": pd.Series(found.people, dtype="string"),
            "looking": found.looking,
            "upright": found.upright,
        }
    )


def _watched(tables: Tables) -> pd.DataFrame:
    """Return the share of certified presentations where the study certified any."""
    rows = tables.ratings[~tables.ratings["is_practice"] & tables.ratings["certified"].notna()]
    passed = rows.assign(passed=rows["certified"].astype(bool)).groupby("participant")["passed"]
    found = passed.agg(presentations="count", certified_share="mean").reset_index()
    return found.astype({"participant": "string"})
