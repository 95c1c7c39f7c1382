"""The report as one page that loads nothing: texts, tables and charts put into ``report.html``."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from analysis.audit import Audit
from analysis.charts import CHARTS
from analysis.charts.style import SIMULATED
from analysis.costs.cost import Costs
from analysis.decision.pareto import pareto_sentences
from analysis.inference.inferring import Inference
from analysis.report.decision_tables import (
    effects_table,
    joint_table,
    policy_table,
    thresholds_table,
)
from analysis.report.inference_tables import inference_tables
from analysis.report.methods import methods
from analysis.report.sections import Section
from analysis.report.tables import (
    ReportTable,
    comparison_tables,
    design_table,
    quality_tables,
    rating_tables,
)
from analysis.tables.reading import Tables

if TYPE_CHECKING:
    from analysis.report.summary import Summary

REPORT: Final = "report.html"


@dataclass(frozen=True)
class Parts:
    """What the report is put together from, beside the summary and the drawn charts.

    ``findings`` and ``people`` are the sections before and after the quality of the data;
    ``could_show`` follows the verdicts, ``fit`` the people, ``rivals`` stands among the methods.
    """

    audit: Audit
    costs: Costs | None
    inference: Inference
    could_show: Section
    findings: Sequence[Section]
    people: Sequence[Section]
    fit: Section
    rivals: Section

    def sections(self) -> Iterator[Section]:
        """Yield every section, in the report's order."""
        yield from (self.could_show, *self.findings, *self.people, self.fit, self.rivals)


def report_page(
    tables: Tables, summary: Summary, *, parts: Parts, charts: Mapping[str, bytes]
) -> str:
    """Return the page; ``charts`` are the drawn ones as SVG, by name."""
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    own = parts.inference
    studies = tables.ratings[["study", "study_version"]].dropna(how="all").drop_duplicates()
    return environment.get_template(REPORT).render(
        summary=summary,
        study=", ".join(", version ".join(row.dropna()) for _, row in studies.iterrows()),
        source=_source(tables),
        charts=_by_part(charts),
        margins=own.margins.origins,
        size_notes=own.curves.notes,
        model_tables=_filled(*inference_tables(own), effects_table(own), joint_table(own)),
        size_tables=_filled(thresholds_table(own), policy_table(own)),
        cost_sentences=pareto_sentences(own.pareto),
        rating_tables=rating_tables(tables, parts.costs),
        comparison_tables=comparison_tables(tables),
        design_table=design_table(parts.audit),
        quality_tables=quality_tables(tables),
        findings_more=parts.findings,
        people_more=parts.people,
        could_show=parts.could_show,
        fit=parts.fit,
        rivals=parts.rivals,
        methods=methods(tables, parts.costs),
        label=SIMULATED,
    )


def _source(tables: Tables) -> str:
    """Return where the answers come from, unless that is the study that is named already."""
    name = Path(tables.source).name
    return "" if name in set(tables.ratings["study"].dropna()) else name


def _filled(*tables: ReportTable) -> list[ReportTable]:
    """Return the tables that have rows."""
    return [table for table in tables if table.rows]


def _by_part(charts: Mapping[str, bytes]) -> dict[str, list[dict[str, Any]]]:
    made: dict[str, list[dict[str, Any]]] = {chart.part: [] for chart in CHARTS}
    for chart in CHARTS:
        image = base64.b64encode(charts[chart.name]).decode()
        made[chart.part].append(
            {"name": chart.name, "title": chart.title, "caption": chart.caption, "image": image}
        )
    return made
