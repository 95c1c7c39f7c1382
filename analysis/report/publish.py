"""From tables to files: charts, CSV tables and one self-contained report.

The edge of the package: it writes into one folder and returns what it found.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Final

from analysis.audit import audit_tables
from analysis.charts import CHARTS
from analysis.charts.drawing import EARLY, LATE, Drawing
from analysis.charts.material import Material
from analysis.costs.cost import read_bench
from analysis.decision.margins import Margins
from analysis.inference.inferring import infer
from analysis.report.answer import findings
from analysis.report.data import csv_bytes, further_tables
from analysis.report.diagnostic_sections import (
    detectable_section,
    fit_section,
    groups_section,
    rivals_section,
)
from analysis.report.page import REPORT, Parts, report_page
from analysis.report.sections import (
    Section,
    claims_section,
    observers_section,
    reliability_section,
    text_section,
    weights_of,
)
from analysis.report.summary import Summary, summarise
from analysis.tables.reading import Tables
from analysis.writing.coding import ManualCodes, read_codes

POLICY: Final = "lod_policy.json"


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
    by hand; with two ``processes`` others draw while this one works out the rest. Raises
    TableError for its faults and ValueError for margins wider than the scale, before anything is
    written.
    """
    (margins or tables.margins).check(tables.scale)
    costs = read_bench(bench) if bench is not None else None
    manual = read_codes(codes) if codes is not None else None
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    with Drawing(processes=processes) as drawing:
        drawing.start(Material(tables, costs), EARLY)
        inference = infer(tables, margins=margins, weights=weights_of(tables) or None, costs=costs)
        observers = observers_section(tables, inference)
        fit = fit_section(inference.realism)
        material = Material(
            tables,
            costs,
            inference,
            sensitivity=observers.data.get("verdict-sensitivity"),
            diagnosed=fit.data.get("residuals"),
            predicted=fit.data.get("predicted-shares"),
        )
        drawing.start(material, LATE)
        parts = _parts(material, manual, observers=observers, fit=fit)
        found = tuple(findings(tables, costs))
        numbers = further_tables(tables, parts.audit, costs, found) | inference.tables()
        for section in parts.sections():
            numbers |= section.data
        numbers |= {chart.name: chart.table(material) for chart in CHARTS}
        summary = summarise(material, parts, found, folder=folder)
        files = drawing.finish()
    for name, table in numbers.items():
        files[f"{name}.csv"] = csv_bytes(table, is_simulated=tables.is_simulated)
    if inference.policy is not None:
        files[POLICY] = inference.policy.text().encode()
    page = report_page(
        tables,
        summary,
        parts=parts,
        charts={chart.name: files[f"{chart.name}.svg"] for chart in CHARTS},
    )
    for name, content in {**files, REPORT: page.encode()}.items():
        (folder / name).write_bytes(content)
    return replace(summary, files=tuple(folder / name for name in [*sorted(files), REPORT]))


def _parts(
    material: Material, manual: ManualCodes | None, *, observers: Section, fit: Section
) -> Parts:
    tables, inference = material.tables, material.inference
    return Parts(
        audit=audit_tables(tables.ratings, tables.comparisons),
        costs=material.costs,
        inference=inference,
        could_show=detectable_section(inference),
        findings=(claims_section(tables, manual), text_section(tables, manual)),
        people=(
            observers,
            reliability_section(tables),
            groups_section(tables, observers.data.get("observer-signals")),
        ),
        fit=fit,
        rivals=rivals_section(inference.realism),
    )
