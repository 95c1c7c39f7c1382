"""The thesis's findings beside the same quantities in these data, each with its interval."""

from __future__ import annotations

from typing import Final

import pandas as pd

from analysis.tables.reading import Tables
from analysis.thesis.findings import CLAIMS, Evidence
from analysis.writing.coding import ManualCodes, code_remarks, mentions

COLUMNS: Final = ("claim", "thesis", "section", "found", "value", "low", "high", "unit", "people")


def claims_table(tables: Tables, manual: ManualCodes | None = None) -> pd.DataFrame:
    """Return every claim with what the thesis said and what these data hold; columns COLUMNS.

    ``found`` is our number with its 95 % interval in words, or "not asked here".
    """
    said = mentions(tables.comparisons, manual)
    wrote = len(code_remarks(tables.comparisons)) > 0  # else nobody was asked to write
    evidence = Evidence(tables, said if wrote else said.iloc[:0])
    rows: list[dict[str, object]] = []
    for claim in CLAIMS:
        found = claim.measure(evidence)
        row: dict[str, object] = {
            "claim": claim.claim,
            "thesis": claim.thesis,
            "section": claim.section,
        }
        row |= {"found": found.text, "value": found.value, "low": found.low, "high": found.high}
        rows.append(row | {"unit": found.unit, "people": found.people})
    return pd.DataFrame(rows, columns=list(COLUMNS))
