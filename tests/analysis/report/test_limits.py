"""What cannot be concluded follows from verdicts, margins, design and people."""

from dataclasses import replace

import pytest

from analysis.audit import Audit, audit_design, shown_clips
from analysis.decision import verdicts as words
from analysis.decision.margins import Margins
from analysis.decision.verdicts import Decision, Verdict
from analysis.inference.inferring import Inference, infer
from analysis.report.limits import limits
from analysis.tables.reading import Tables

WITHIN, OPEN, BEYOND = (
    words.Test(value, value - 0.2, value + 0.2, 0.5) for value in (0.1, 0.5, 0.9)
)


def verdict(
    lod: str, realism: words.Test, *, noticed: words.Test | None = WITHIN, reached: bool = True
) -> Verdict:
    return Verdict("near", lod, "ultra", realism, noticed, reached, 0.3)


@pytest.fixture(scope="module")
def audit(thesis_tables: Tables) -> Audit:
    return audit_design(shown_clips(thesis_tables.ratings, thesis_tables.comparisons))


def said(tables: Tables, audit: Audit, *verdicts: Verdict, margins: Margins | None = None) -> str:
    own = Margins(declared=("realism_points", "noticed_share", "confidence"))
    decision = Decision("near", "ultra", "ultra", verdicts, 0.1)
    inference = Inference(None, None, None, (decision,) if verdicts else (), margins or own)
    return "\n".join(limits(tables, audit, inference))


def test_what_is_open_untested_and_unmeasured_is_named(thesis_tables: Tables, audit: Audit) -> None:
    text = said(
        thesis_tables,
        audit,
        verdict("high", OPEN),
        verdict("medium", OPEN, noticed=None, reached=False),
        verdict("low", BEYOND),
    )
    assert "Open, neither shown to be enough nor shown not to be: high at near." in text
    assert "Not tested, because a higher LoD had failed before: medium at near." in text
    assert "without which no LoD is called equivalent: medium at near." in text
    assert "a LoD is the cheapest, these go by their ratings alone." in text
    assert "low at near" not in text  # that one is decided


def test_equality_is_denied_only_beyond_the_margins(thesis_tables: Tables, audit: Audit) -> None:
    text = said(thesis_tables, audit, verdict("high", WITHIN))
    assert (
        "Equivalent means within the margins (0.50 points, 25\N{NO-BREAK SPACE}% of people)" in text
    )
    assert "Open," not in text
    assert "needs a margin declared before" not in text
    different = said(thesis_tables, audit, verdict("high", BEYOND))
    assert "Equivalent means" not in different


def test_margins_set_after_the_data_make_verdicts_exploratory(
    thesis_tables: Tables, audit: Audit
) -> None:
    own = verdict("high", WITHIN)
    assert "exploratory" not in said(thesis_tables, audit, own)
    later = said(thesis_tables, audit, own, margins=Margins())
    assert "were not all declared before there were data (set at analysis)" in later
    assert "take the verdicts as exploratory" in later


def test_small_studies_and_missing_cells_are_told(thesis_tables: Tables, audit: Audit) -> None:
    text = said(thesis_tables, audit)
    assert "There is no verdict on any LoD" in text
    assert "10 people took part, fewer than the 15 that ITU-R BT.500 asks for" in text
    assert "Not shown: high at distance=near; any LoD at distance=medium" in text
    assert "No comparison links two distances" in text


def test_verdicts_of_real_models_are_told(thesis_tables: Tables, audit: Audit) -> None:
    inference = infer(thesis_tables)
    text = "\n".join(limits(thesis_tables, audit, inference))
    for decision in inference.decisions:
        for own in decision.verdicts:
            named = f"{own.lod} at {own.distance}" in text or f"at {decision.distance}" in text
            assert named or own.outcome != "not shown"
    real = replace(thesis_tables, is_simulated=False)
    assert "simulated observers" not in "\n".join(limits(real, audit, inference))
