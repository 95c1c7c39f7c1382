"""What a table says without saying it: ranks, names of clips, catch trials, repeated rows.

Nothing is guessed about answers: only columns that follow from other columns are filled in.
"""

from __future__ import annotations

from typing import Final

import pandas as pd

from analysis.tables.columns import STANDARD_LODS
from analysis.words.wording import listed

UNSTATED: Final = "unstated"
"""The distance of ratings that come without one."""

# What makes a row of each table the same row; nothing is known about repetitions without trial.
_KEYS: Final = {
    "ratings": ["participant", "session", "trial", "eye"],
    "comparisons": ["participant", "session", "trial"],
    "participants": ["participant"],
}


def rank_faults(ratings: pd.DataFrame, source: str) -> list[str]:
    """Return what is wrong with the LoDs' ranks: a LoD with two of them, or two LoDs with one.

    The frame's index plus two is the row that a fault names.
    """
    own = ratings[["lod", "lod_rank"]].assign(lod_rank=_ranked(ratings)).dropna()
    known = own.drop_duplicates("lod")
    first = own["lod"].map(known.set_index("lod")["lod_rank"])
    other = own[own["lod_rank"] != first].drop_duplicates("lod")
    faults = [
        f"{source}: row {row + 2}, lod_rank: found {rank} for {lod}, which has {first[row]} in an "
        "earlier row; accepted: one rank for each LoD"
        for row, lod, rank in zip(other.index, other["lod"], other["lod_rank"], strict=True)
    ]
    for rank, lods in known.groupby("lod_rank")["lod"]:
        if len(lods) > 1:
            faults.append(
                f"{source}: row {lods.index[1] + 2}, lod_rank: found {rank} for "
                f"{listed(lods.tolist())}; accepted: a rank for one LoD alone, 1 for the least"
            )
    return faults


def _ranked(ratings: pd.DataFrame) -> pd.Series:
    """Return the LoDs' ranks, the standard ones' where the table has none."""
    standard = ratings["lod"].map({lod: i + 1 for i, lod in enumerate(STANDARD_LODS)})
    ranks: pd.Series = ratings["lod_rank"].fillna(standard.astype("Int64"))
    return ranks


def complete_ratings(ratings: pd.DataFrame, participants: pd.DataFrame) -> pd.DataFrame:
    """Fill in what follows from other columns: rank, clip, distance, catch, practice, simulated."""
    table = _complete(ratings, participants)
    table["lod_rank"] = _ranked(table)
    is_same = (table["lod"] == table["other_lod"]).fillna(False).astype(bool)
    table["is_catch"] = table["is_catch"].fillna(is_same).astype(bool)
    beside = table["other_lod"].map(lambda lod: f" beside {lod}", na_action="ignore").fillna("")
    place = table["distance"].where(table["distance"] != UNSTATED, "")
    name = (table["lod"] + beside + " " + place).str.strip()
    table["clip"] = table["clip"].fillna(name)
    return table


def complete_comparisons(comparisons: pd.DataFrame, participants: pd.DataFrame) -> pd.DataFrame:
    """Fill in what follows from other columns: clip, distance, catch, practice, simulated."""
    table = _complete(comparisons, participants)
    is_same = (table["left_lod"] == table["right_lod"]).fillna(False).astype(bool)
    table["is_catch"] = table["is_catch"].fillna(is_same).astype(bool)
    place = table["distance"].where(table["distance"] != UNSTATED, "")
    name = (table["left_lod"] + ", " + table["right_lod"] + " " + place).str.strip()
    table["clip"] = table["clip"].fillna(name)
    return table


def drop_repeated_rows(
    table: pd.DataFrame, name: str, source: str, *, faults: list[str], notes: list[str]
) -> pd.DataFrame:
    """Keep one of rows that are equal in every cell; two answers to one question are a fault."""
    key = [column for column in _KEYS[name] if not table[column].isna().all()]
    is_equal = table.duplicated(keep="first")
    if table.empty or (name != "participants" and "trial" not in key):
        if is_equal.any():
            notes.append(
                f"{source}: {is_equal.sum()} of {len(table)} rows are like an earlier one in every "
                "cell. Without a column trial each counts as an answer of its own; if the table "
                "was put together twice, leave them out."
            )
        return table
    kept = table[~is_equal]
    if is_equal.any():
        rows = "row was" if is_equal.sum() == 1 else "rows were"
        notes.append(f"{source}: {is_equal.sum()} repeated {rows} left out.")
    has_key = kept[key].notna().all(axis=1)
    clash = kept[has_key & kept.duplicated(key, keep="first")]
    faults += [
        f"{source}: row {row + 2}: a second, different row for "
        + ", ".join(f"{column} {kept[column][row]}" for column in key)
        + "; accepted: one row each"
        for row in clash.index
    ]
    return kept.reset_index(drop=True)


def _complete(rows: pd.DataFrame, participants: pd.DataFrame) -> pd.DataFrame:
    table = rows.copy()
    if not participants.empty:
        known = participants.set_index("participant")["simulated"]
        table["simulated"] = table["simulated"].fillna(
            table["participant"].map(known).astype("boolean")
        )
    table["simulated"] = table["simulated"].fillna(False).astype(bool)
    table["is_gold"] = table["is_gold"].fillna(False).astype(bool)
    # A gold trial says who looks and nothing about LoDs: it is left out wherever practice is.
    table["is_practice"] = table["is_practice"].fillna(False).astype(bool) | table["is_gold"]
    table["distance"] = table["distance"].fillna(UNSTATED)
    return table
