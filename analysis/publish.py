"""From tables to files: charts, CSV tables and one self-contained report.

The edge of the package: it writes into one folder and returns what it found.
"""

from __future__ import annotations

import base64
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from jinja2 import Environment, FileSystemLoader, StrictUndefined

from analysis.answer import Finding, findings
from analysis.audit import Audit, audit_design, shown_clips
from analysis.charts import CHARTS
from analysis.charts.style import SIMULATED, figure_bytes
from analysis.coding import read_codes
from analysis.correlation import person_concordance
from analysis.cost import Costs, read_bench
from analysis.decision.margins import Margins
from analysis.decision.sentences import answer
from analysis.descriptive import answered, differences_from_best, mean_ratings
from analysis.inference import Inference, infer
from analysis.inference_tables import inference_tables
from analysis.limits import limits
from analysis.methods import methods
from analysis.quality import missing_answers, people_overview, quality_statements
from analysis.reading import Tables
from analysis.report_tables import design_table, quality_tables, report_tables
from analysis.sections import (
    Section,
    claims_section,
    observers_section,
    reliability_section,
    text_section,
    weights_of,
)

REPORT = "report.html"


@dataclass(frozen=True)
class Summary:
    """What an analysis found and wrote; ``findings`` describe, ``verdicts`` decide, by distance."""

    findings: tuple[Finding, ...]
    verdicts: tuple[tuple[str, str], ...]
    limits: tuple[str, ...]
    design: tuple[str, ...]
    quality: tuple[str, ...]
    is_simulated: bool
    people: int
    ratings: int
    report: Path
    files: tuple[Path, ...]

    def lines(self) -> list[str]:
        """Return the answer as lines of plain text for a terminal."""
        decided = [f"{distance}: {sentence}" for distance, sentence in self.verdicts]
        described = [f"{finding.distance}: {finding.sentence}" for finding in self.findings]
        label = [SIMULATED] if self.is_simulated else []
        return [*label, *((decided or described) if self.ratings else self.limits[:1])]


def analyse(
    tables: Tables,
    out: str | Path,
    *,
    bench: str | Path | None = None,
    margins: Margins | None = None,
    codes: str | Path | None = None,
) -> Summary:
    """Write every chart, table and the report into the folder ``out`` and return the findings.

    ``bench`` is the path of ``bench.json``, which adds what each LoD costs; ``margins`` are what
    counts as no loss (without, what the study declared); ``codes`` is a CSV file of remarks coded
    by hand. Raises TableError for its faults, before anything is written.
    """
    costs = read_bench(bench) if bench is not None else None
    manual = read_codes(codes) if codes is not None else None
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    audit = audit_design(shown_clips(tables.ratings, tables.comparisons))
    rated = answered(tables.ratings)
    found = tuple(findings(tables, costs))
    inference = infer(tables, margins=margins, weights=weights_of(tables) or None)
    findings_more = (claims_section(tables, manual), text_section(tables, manual))
    people_more = (observers_section(tables, inference), reliability_section(tables))
    files: dict[str, bytes] = {}
    for chart in CHARTS:
        figure = chart.draw(tables)
        files |= {f"{chart.name}.{kind}": figure_bytes(figure, kind) for kind in ("svg", "png")}
        files[f"{chart.name}.csv"] = _csv(chart.table(tables), tables)
    more = _more_tables(tables, audit, costs, found) | inference.tables()
    for section in (*findings_more, *people_more):
        more |= section.data
    for name, table in more.items():
        files[f"{name}.csv"] = _csv(table, tables)
    summary = Summary(
        findings=found,
        verdicts=tuple((own.distance, answer(own)) for own in inference.decisions),
        limits=(*limits(tables, audit), *inference.warnings()),
        design=tuple(audit.facts()),
        quality=tuple(quality_statements(tables)),
        is_simulated=tables.is_simulated,
        people=rated["participant"].nunique(),
        ratings=len(rated),
        report=folder / REPORT,
        files=tuple(folder / name for name in [*sorted(files), REPORT]),
    )
    files[REPORT] = _report(
        tables,
        summary,
        files,
        audit=audit,
        costs=costs,
        inference=inference,
        more=(findings_more, people_more),
    ).encode()
    for name, content in files.items():
        (folder / name).write_bytes(content)
    return summary


def _more_tables(
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


def _csv(table: pd.DataFrame, tables: Tables) -> bytes:
    labelled = table.assign(simulated="true" if tables.is_simulated else "false")
    return labelled.to_csv(index=False, float_format="%.6g", lineterminator="\n").encode()


def _report(
    tables: Tables,
    summary: Summary,
    files: Mapping[str, bytes],
    *,
    audit: Audit,
    costs: Costs | None,
    inference: Inference,
    more: tuple[tuple[Section, ...], tuple[Section, ...]],
) -> str:
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    studies = tables.ratings[["study", "study_version"]].dropna(how="all").drop_duplicates()
    return environment.get_template(REPORT).render(
        summary=summary,
        study=", ".join(" ".join(row.dropna()) for _, row in studies.iterrows()),
        source=Path(tables.source).name,
        charts=[
            {
                "caption": chart.caption,
                "image": base64.b64encode(files[f"{chart.name}.svg"]).decode(),
                "name": chart.name,
            }
            for chart in CHARTS
        ],
        tables=[*inference_tables(inference), *report_tables(tables, costs)],
        design_table=design_table(audit),
        quality_tables=quality_tables(tables),
        findings_more=more[0],
        people_more=more[1],
        methods=methods(tables, costs),
        label=SIMULATED,
    )
