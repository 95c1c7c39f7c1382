"""The report's tables: numbers as a reader wants them, with their intervals beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import pandas as pd

from analysis.audit import Audit
from analysis.correlation import ALL_DISTANCES, rank_correlations
from analysis.costs.cost import Costs
from analysis.descriptive.means import differences_from_best, mean_ratings
from analysis.descriptive.quality import missing_answers, people_overview
from analysis.descriptive.shares import PAIR_OUTCOMES, pair_comparison_shares, pair_notice_shares
from analysis.tables.columns import NOTICED
from analysis.tables.reading import Tables
from analysis.words.wording import interval, milliseconds, number, percent

_MOST_PEOPLE: Final = 60


@dataclass(frozen=True)
class ReportTable:
    """A table of texts; ``text_columns`` (from the left) are words, the others numbers.

    In a table of prose the words are sentences, which may wrap.
    """

    caption: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    text_columns: int = 1
    note: str = ""
    is_prose: bool = False


def rating_tables(tables: Tables, costs: Costs | None = None) -> list[ReportTable]:
    """Return the tables of ratings in order; those without rows are left out."""
    return [table for table in (_means(tables, costs), _correlations(tables)) if table.rows]


def comparison_tables(tables: Tables) -> list[ReportTable]:
    """Return the tables of preferences and of noticing; those without rows are left out."""
    made = [
        _pairs(
            pair_comparison_shares(tables.comparisons),
            PAIR_OUTCOMES,
            "Which LoD of a pair was called more realistic (95 % Wilson intervals).",
            ("lesser", "no difference", "greater"),
        ),
        _pairs(
            pair_notice_shares(tables.comparisons),
            NOTICED,
            "Whether a difference was noticed (95 % Wilson intervals).",
            ("yes", "not sure", "no"),
        ),
    ]
    return [table for table in made if table.rows]


def design_table(audit: Audit) -> ReportTable:
    """Return how many clips show each LoD at each distance and on each side."""
    at = tuple(f"at {distance}" for distance in audit.distances)
    rows = tuple(
        (
            lod,
            *(f"{audit.cells.get((distance, lod), 0)}" for distance in audit.distances),
            *map(str, audit.sides[lod]),
        )
        for lod in audit.lods
    )
    head = ("LoD", *at, "on the left", "on the right")
    return ReportTable("Clips that show each LoD, by distance and by side.", head, rows)


def quality_tables(tables: Tables) -> list[ReportTable]:
    """Return the tables on missing answers and on people; those without rows are left out."""
    return [table for table in (_missing(tables), _people(tables)) if table.rows]


def _means(tables: Tables, costs: Costs | None) -> ReportTable:
    means = mean_ratings(tables.ratings, ["distance", "lod"])
    gaps = differences_from_best(tables.ratings).set_index(["distance", "lod"])
    head = ["distance", "LoD", "people", "ratings", "mean", "95 % CI", "sd", "below the best"]
    head += ["95 % CI of it"] + (["per frame"] if costs else [])
    rows = []
    for _, row in means.iterrows():
        key = (row["distance"], row["lod"])
        cells = [*key, f"{row['people']}", f"{row['ratings']}", number(row["mean"])]
        cells += [interval(row["low"], row["high"]), number(row["sd"])]
        if key in gaps.index:
            gap = gaps.loc[[key]].iloc[0]
            cells += [number(gap["difference"]), interval(gap["low"], gap["high"])]
        else:
            cells += ["–", "–"]
        if costs:
            cost = costs.ms(*key)
            cells.append("–" if cost is None else milliseconds(cost))
        rows.append(tuple(map(str, cells)))
    note = "Below the best: mean difference within people from the highest LoD at that distance."
    if costs:
        note += f" Cost: {costs.condition}."
    return ReportTable(
        "Mean realism per distance and LoD.", tuple(head), tuple(rows), text_columns=2, note=note
    )


def _correlations(tables: Tables) -> ReportTable:
    rows = []
    for _, row in rank_correlations(tables.ratings).iterrows():
        is_all = row["distance"] == ALL_DISTANCES
        rows.append(
            (
                "all, within distances" if is_all else str(row["distance"]),
                f"{row['people']}",
                f"{row['without_spread']}",
                number(row["tau_b"]),
                interval(row["tau_low"], row["tau_high"]),
                number(row["somers_d"]),
                interval(row["d_low"], row["d_high"]),
                number(row["rmcorr"]),
                interval(row["rm_low"], row["rm_high"]),
                f"{row['rm_dof']}",
            )
        )
    head = ("distance", "people", "of them without τ", "τ-b", "95 % CI", "Somers' d", "95 % CI")
    return ReportTable(
        "How perceived realism follows the actual LoD.",
        (*head, "r (repeated measures)", "95 % CI", "dof"),
        tuple(rows),
    )


def _pairs(
    shares: pd.DataFrame, answers: Sequence[str], caption: str, names: tuple[str, ...]
) -> ReportTable:
    rows = []
    for key, own in shares.groupby(["distance", "lesser", "greater"], sort=False):
        by_answer = own.set_index("answer")
        first = own.iloc[0]
        cells = [str(key[0]), f"{key[1]} – {key[2]}", f"{first['people']}", f"{first['total']}"]
        for answer in answers:
            row: Any = by_answer.loc[answer]
            cells.append(
                f"{percent(row['share'])} ({percent(row['low'])} to {percent(row['high'])})"
            )
        rows.append(tuple(cells))
    head = ("distance", "LoDs (lesser – greater)", "people", "answers", *names)
    return ReportTable(caption, head, tuple(rows), text_columns=2)


def _missing(tables: Tables) -> ReportTable:
    rows = [
        (
            str(row["question"]),
            str(row["column"]),
            f"{row['asked']}",
            f"{row['answered']}",
            f"{row['missing']}",
            percent(row["share"]),
        )
        for _, row in missing_answers(tables).iterrows()
        if row["asked"]
    ]
    head = ("question", "column", "asked", "answered", "missing", "share missing")
    note = "Free text is expected from few."
    return ReportTable("Missing answers.", head, tuple(rows), text_columns=2, note=note)


def _people(tables: Tables) -> ReportTable:
    people = people_overview(tables)
    rows = [
        (
            str(row["participant"]),
            f"{row['ratings']}",
            f"{row['missing']}",
            number(row["mean"]),
            f"{row['lowest']}",
            f"{row['highest']}",
            f"{row['distinct']}",
            "–"
            if pd.isna(row["median_response_s"])
            else number(row["median_response_s"], digits=0),
        )
        for _, row in people.head(_MOST_PEOPLE).iterrows()
    ]
    low, high = tables.scale
    head = ("participant", "ratings", "missing", "mean", f"rated {low}", f"rated {high}")
    note = "Nobody was excluded."
    if len(people) > _MOST_PEOPLE:
        note += f" The first {_MOST_PEOPLE} of {len(people)}; all stand in people.csv."
    return ReportTable(
        "Participants and their use of the scale.",
        (*head, "different ratings", "median response, s"),
        tuple(rows),
        note=note,
    )
