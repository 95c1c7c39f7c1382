"""From tables to files: charts, CSV tables and one self-contained report.

The edge of the package: it writes into one folder and returns what it found.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from analysis.audit import audit_tables
from analysis.charts import CHARTS
from analysis.charts.drawing import draw_charts
from analysis.charts.material import Material
from analysis.charts.style import SIMULATED
from analysis.costs.cost import read_bench
from analysis.decision.effect_sentences import effect_answers
from analysis.decision.margins import Margins
from analysis.decision.policy_sentences import policy_answer
from analysis.decision.sentences import answer
from analysis.descriptive.means import answered
from analysis.descriptive.quality import quality_statements
from analysis.inference.inferring import infer
from analysis.report.answer import Finding, findings
from analysis.report.data import csv_bytes, further_tables
from analysis.report.diagnostic_sections import (
    detectable_section,
    fit_section,
    groups_section,
    rivals_section,
)
from analysis.report.limits import limits
from analysis.report.page import REPORT, Parts, report_page
from analysis.report.sections import (
    claims_section,
    observers_section,
    reliability_section,
    text_section,
    weights_of,
)
from analysis.tables.reading import Tables
from analysis.writing.coding import read_codes

POLICY = "lod_policy.json"
BY_SIZE = "by size"  # the answer along the iris's size stands beside those by distance


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
    processes: int = 1,
) -> Summary:
    """Write every chart, table and the report into the folder ``out`` and return the findings.

    ``bench`` is the path of ``bench.json``, which adds what each LoD costs; ``margins`` are what
    counts as no loss (without, what the study declared); ``codes`` is a CSV file of remarks coded
    by hand; with two ``processes`` a second one helps to draw. Raises TableError for its faults,
    before anything is written.
    """
    costs = read_bench(bench) if bench is not None else None
    manual = read_codes(codes) if codes is not None else None
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    audit = audit_tables(tables.ratings, tables.comparisons)
    inference = infer(tables, margins=margins, weights=weights_of(tables) or None, costs=costs)
    found = tuple(findings(tables, costs))
    observers = observers_section(tables, inference)
    parts = Parts(
        audit=audit,
        costs=costs,
        inference=inference,
        could_show=detectable_section(inference),
        findings=(claims_section(tables, manual), text_section(tables, manual)),
        people=(
            observers,
            reliability_section(tables),
            groups_section(tables, observers.data.get("observer-signals")),
        ),
        fit=fit_section(inference.realism),
        rivals=rivals_section(inference.realism),
    )
    numbers = further_tables(tables, audit, costs, found) | inference.tables()
    for section in parts.sections():
        numbers |= section.data
    material = Material(
        tables,
        costs,
        inference,
        sensitivity=numbers.get("verdict-sensitivity"),
        diagnosed=numbers.get("residuals"),
        predicted=numbers.get("predicted-shares"),
    )
    numbers |= {chart.name: chart.table(material) for chart in CHARTS}
    files = draw_charts(material, processes=processes)
    for name, table in numbers.items():
        files[f"{name}.csv"] = csv_bytes(table, is_simulated=tables.is_simulated)
    if inference.policy is not None:
        files[POLICY] = inference.policy.text().encode()
    rated = answered(tables.ratings)
    summary = Summary(
        findings=found,
        verdicts=(
            *((own.distance, answer(own, costs)) for own in inference.decisions),
            *effect_answers(inference.effects, costs),
            *((BY_SIZE, policy_answer(own, costs)) for own in [inference.policy] if own),
        ),
        limits=(*limits(tables, audit, inference), *inference.warnings()),
        design=tuple(audit.facts()),
        quality=tuple(quality_statements(tables)),
        is_simulated=tables.is_simulated,
        people=rated["participant"].nunique(),
        ratings=len(rated),
        report=folder / REPORT,
        files=tuple(folder / name for name in [*sorted(files), REPORT]),
    )
    pictures = {chart.name: files[f"{chart.name}.svg"] for chart in CHARTS}
    page = report_page(tables, summary, parts=parts, charts=pictures)
    for name, content in {**files, REPORT: page.encode()}.items():
        (folder / name).write_bytes(content)
    return summary
