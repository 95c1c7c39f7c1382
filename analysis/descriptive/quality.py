"""Is the data good? Missing answers per question, what was left out, and how people used the scale.

Facts only: nobody is excluded here.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from analysis.tables.reading import Tables
from analysis.words.wording import percent

_QUESTIONS: Final = (
    ("ratings", "rating", "realism of each eye"),
    ("comparisons", "comparison", "which eye is more realistic"),
    ("comparisons", "noticed", "anything missing or different"),
    ("comparisons", "what_differed", "what was different"),
    ("comparisons", "comments", "other comments"),
)


def missing_answers(tables: Tables) -> pd.DataFrame:
    """Return, per question, how many answers were asked for and how many are missing.

    Columns: question, column, asked, answered, missing, share (missing). Free text is asked for in
    every trial but expected in few.
    """
    rows = []
    for table, column, question in _QUESTIONS:
        frame: pd.DataFrame = getattr(tables, table)
        cells = frame.loc[~frame["is_practice"], column]
        missing = int(cells.isna().sum())
        row = {"question": question, "column": column, "asked": len(cells)}
        row |= {"answered": len(cells) - missing, "missing": missing}
        rows.append(row | {"share": missing / len(cells) if len(cells) else float("nan")})
    return pd.DataFrame(rows)


def people_overview(tables: Tables) -> pd.DataFrame:
    """Return one row per participant: how much was answered and how the scale was used.

    Columns: participant, ratings, missing, mean, lowest and highest (ratings at the ends of the
    scale), distinct (different ratings used), median_response_s.
    """
    rows = tables.ratings[~tables.ratings["is_practice"]]
    low, high = tables.scale
    rating = rows["rating"].astype("Float64").to_numpy(dtype=float, na_value=np.nan)
    response_s = rows["response_ms"].astype("Float64").to_numpy(dtype=float, na_value=np.nan) / 1000
    cells = pd.DataFrame(
        {
            "participant": rows["participant"].to_numpy(),
            "rating": rating,
            "missing": np.isnan(rating),
            "lowest": rating == low,
            "highest": rating == high,
            "response_s": response_s,
        }
    )
    return (
        cells.groupby("participant", sort=True)
        .agg(
            ratings=("rating", "count"),
            missing=("missing", "sum"),
            mean=("rating", "mean"),
            lowest=("lowest", "sum"),
            highest=("highest", "sum"),
            distinct=("rating", "nunique"),
            median_response_s=("response_s", "median"),
        )
        .reset_index()
    )


def quality_statements(tables: Tables) -> list[str]:
    """Say in sentences what a reader must know about the data behind the figures."""
    ratings = tables.ratings
    text = list(tables.notes)
    for kind, rows in (
        ("practice", ratings["is_practice"] & ~ratings["is_gold"]),
        ("gold", ratings["is_gold"]),
    ):
        if rows.any():
            text.append(f"Ratings of {kind} trials, not counted: {int(rows.sum())}.")
    counted = ratings[~ratings["is_practice"]]
    missing = int(counted["rating"].isna().sum())
    if missing:
        text.append(
            f"Missing ratings, left out and not replaced: {missing} of {len(counted)} "
            f"({percent(missing / len(counted))})."
        )
    uncertified = int(counted["certified"].eq(False).fillna(False).sum())
    if uncertified:
        text.append(
            f"Ratings of presentations that failed the study's rule, kept and counted: "
            f"{uncertified}."
        )
    text += _unfinished(tables)
    text += _versions(counted)
    text += _use_of_scale(people_overview(tables), tables.scale)
    text += _unknown_people(tables)
    return text


def _unfinished(tables: Tables) -> list[str]:
    people = tables.participants
    if people["completed_at"].isna().all():
        return []
    given = set(tables.ratings.loc[tables.ratings["rating"].notna(), "participant"])
    unfinished = set(people.loc[people["completed_at"].isna(), "participant"]) & given
    if not unfinished:
        return []
    return [f"People who have not finished, whose answers are counted: {len(unfinished)}."]


def _versions(ratings: pd.DataFrame) -> list[str]:
    versions = ratings[["study", "study_version"]].dropna(how="all").drop_duplicates()
    if len(versions) < 2:
        return []
    names = "; ".join(" ".join(row.dropna().astype(str)) for _, row in versions.iterrows())
    return [f"Several studies or versions are pooled: {names}."]


def _use_of_scale(people: pd.DataFrame, scale: tuple[int, int]) -> list[str]:
    total, highest = int(people["ratings"].sum()), int(people["highest"].sum())
    if not total:
        return []
    text = f"The highest rating ({scale[1]}) was given {highest} times in {total}"
    if highest > 1:
        text += f", at most {int(people['highest'].max())} times by one person"
    alike = people.loc[(people["ratings"] > 2) & (people["distinct"] == 1), "participant"]
    found = [text + "."]
    if len(alike):
        found.append(f"Gave the same rating throughout: {', '.join(map(str, alike))}.")
    return found


def _unknown_people(tables: Tables) -> list[str]:
    if tables.participants.empty:
        return []
    known = set(tables.participants["participant"])
    unknown = sorted(set(tables.ratings["participant"]) - known)
    return [f"Not in the table of participants: {', '.join(unknown)}."] if unknown else []
