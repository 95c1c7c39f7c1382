"""The numbers beside the report: tables that no chart stands for, and how one becomes a file."""

from __future__ import annotations

import pandas as pd

from analysis.audit import Audit
from analysis.correlation import person_concordance
from analysis.costs.cost import Costs
from analysis.descriptive.means import differences_from_best, mean_ratings
from analysis.descriptive.quality import missing_answers, people_overview
from analysis.report.answer import Finding
from analysis.tables.reading import Tables


def further_tables(
    tables: Tables, audit: Audit, costs: Costs | None, found: tuple[Finding, ...]
) -> dict[str, pd.DataFrame]:
    """Return the tables that no chart stands for, by file name."""
    means = mean_ratings(tables.ratings, ["distance", "lod"])
    if costs is not None:
        means["ms_per_frame"] = [
            costs.ms(d, lod) for d, lod in zip(means["distance"], means["lod"], strict=True)
        ]
    cells = [
        {"distance": d, "lod": lod, "clips": audit.cells.get((d, lod), 0)}
        for d in audit.distances
        for lod in audit.lods
    ]
    remarks = tables.comparisons[
        ["participant", "distance", "clip", "left_lod", "right_lod", "what_differed", "comments"]
    ].dropna(subset=["what_differed", "comments"], how="all")
    answers = [{"distance": f.distance, "lod": f.lod, "sentence": f.sentence} for f in found]
    return {
        "answer": pd.DataFrame(answers, columns=["distance", "lod", "sentence"]),
        "mean-realism": means,
        "differences-from-best": differences_from_best(tables.ratings),
        "correlation-per-person": person_concordance(tables.ratings),
        "design": pd.DataFrame(cells, columns=["distance", "lod", "clips"]),
        "missing-answers": missing_answers(tables),
        "people": people_overview(tables),
        "remarks": remarks,
    }


def csv_bytes(table: pd.DataFrame, *, is_simulated: bool) -> bytes:
    """Return a table as CSV in UTF-8; every row says whether its data are simulated."""
    labelled = table.assign(simulated="true" if is_simulated else "false")
    return labelled.to_csv(index=False, float_format="%.6g", lineterminator="\n").encode()
