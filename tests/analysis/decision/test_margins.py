"""Margins: where they come from, what the command line changes, and the declared sequence."""

from __future__ import annotations

from dataclasses import replace

import pytest

from analysis.decision.margins import AT_ANALYSIS, DECLARED, DEFAULT, Margins, declared_margins
from analysis.inference.inferring import infer
from analysis.tables.reading import Tables

BOOK = {"decision": {"realism_margin": 0.3, "noticed_margin": 0.2, "confidence": 0.9}}


def test_without_a_declaration_margins_were_set_at_analysis() -> None:
    assert declared_margins({}) == DEFAULT == Margins()
    assert DEFAULT.origins == AT_ANALYSIS


def test_a_value_changed_on_the_command_line_is_no_longer_declared() -> None:
    declared = declared_margins(BOOK)
    assert declared.origins == DECLARED
    assert declared.changed(realism_points=None, confidence=0.9) == declared
    changed = declared.changed(realism_points=0.6, noticed_share=None)
    assert (changed.realism_points, changed.noticed_share) == (0.6, 0.2)
    assert changed.origin("realism_points") == AT_ANALYSIS
    assert changed.origin("noticed_share") == DECLARED
    assert changed.origins == "realism margin set at analysis"


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"realism_points": 0.0}, "realism_margin: found 0; accepted: above 0"),
        ({"noticed_share": 1.5}, "noticed_margin: found 1.5; accepted: above 0 and below 1"),
        ({"confidence": 0.5}, "confidence: found 0.5; accepted: above 0.5 and below 1"),
    ],
)
def test_impossible_values_are_refused(values: dict[str, float], told: str) -> None:
    with pytest.raises(ValueError, match=f"^{told}$"):
        DEFAULT.changed(**values)


def test_the_report_uses_what_the_study_declared(thesis_tables: Tables) -> None:
    found = infer(replace(thesis_tables, margins=declared_margins(BOOK)))
    table = found.tables()["decision"]
    assert set(table["realism_margin"]) == {0.3}
    assert set(table["confidence"]) == {0.9}
    assert set(table["margins"]) == {DECLARED}


def test_a_declared_sequence_decides_what_is_tested_against_what(thesis_tables: Tables) -> None:
    given = declared_margins({"decision": BOOK["decision"] | {"sequence": ["low", "ultra"]}})
    found = infer(thesis_tables, margins=given).decisions
    assert {d.best for d in found} == {"low"}
    assert {v.lod for d in found for v in d.verdicts} == {"ultra"}  # what it omits is left out
