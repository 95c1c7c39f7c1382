"""Statistics and charts from tidy tables: plain tables in, tables and figures out.

Imports nothing of the renderer or the study: it works on anyone's ratings. What is listed here may
be used by others; it is loaded on first use, so importing the package loads no plotting library.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from analysis.audit import Audit, ShownClip, audit_design
    from analysis.charts import CHARTS, Chart, figure_bytes, figures
    from analysis.costs.cost import read_bench
    from analysis.decision.margins import Margins, declared_margins
    from analysis.report.publish import analyse
    from analysis.report.summary import Summary
    from analysis.simulation.observers import Answer, Observer, Stimulus, draw_observer
    from analysis.tables.codebook import accepted_in, codebook, columns_of
    from analysis.tables.column import Column
    from analysis.tables.columns import COLUMNS, column_names
    from analysis.tables.parsing import TableError
    from analysis.tables.reading import Tables, read_source, tables_from

_HOMES = {
    "audit": ("Audit", "ShownClip", "audit_design"),
    "charts": ("CHARTS", "Chart", "figure_bytes", "figures"),
    "costs.cost": ("read_bench",),
    "tables.column": ("Column",),
    "decision.margins": ("Margins", "declared_margins"),
    "simulation.observers": ("Answer", "Observer", "Stimulus", "draw_observer"),
    "tables.parsing": ("TableError",),
    "report.publish": ("analyse",),
    "report.summary": ("Summary",),
    "tables.reading": ("Tables", "read_source", "tables_from"),
    "tables.codebook": ("accepted_in", "codebook", "columns_of"),
    "tables.columns": ("COLUMNS", "column_names"),
}

__all__ = [
    "CHARTS",
    "COLUMNS",
    "Answer",
    "Audit",
    "Chart",
    "Column",
    "Margins",
    "Observer",
    "ShownClip",
    "Stimulus",
    "Summary",
    "TableError",
    "Tables",
    "accepted_in",
    "analyse",
    "audit_design",
    "codebook",
    "column_names",
    "columns_of",
    "declared_margins",
    "draw_observer",
    "figure_bytes",
    "figures",
    "read_bench",
    "read_source",
    "tables_from",
]


def __getattr__(name: str) -> Any:
    for module, names in _HOMES.items():
        if name in names:
            return getattr(importlib.import_module(f"analysis.{module}"), name)
    raise AttributeError(f'module "analysis" has no attribute "{name}"')
