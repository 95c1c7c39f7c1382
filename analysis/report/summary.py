"""What an analysis found, as the terminal, the report and the dashboard tell it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from analysis.charts.material import Material
from analysis.charts.names import chart_notes
from analysis.charts.style import SIMULATED
from analysis.decision.effect_sentences import effect_answers
from analysis.decision.policy_sentences import policy_answer
from analysis.decision.sentences import answer
from analysis.descriptive.means import answered
from analysis.descriptive.quality import quality_statements
from analysis.report.answer import Finding
from analysis.report.limits import limits
from analysis.report.page import REPORT, Parts
from analysis.words.wording import place

BY_SIZE: Final = "by size"  # the answer along the iris's size stands beside those by distance


@dataclass(frozen=True)
class Summary:
    """What an analysis found and wrote; ``findings`` describe, ``verdicts`` decide, by distance.

    ``notes`` say what was left out or read otherwise, ``chart_notes`` what charts do with names.
    """

    findings: tuple[Finding, ...]
    verdicts: tuple[tuple[str, str], ...]
    limits: tuple[str, ...]
    design: tuple[str, ...]
    quality: tuple[str, ...]
    notes: tuple[str, ...]
    chart_notes: tuple[str, ...]
    is_simulated: bool
    people: int
    ratings: int
    report: Path
    files: tuple[Path, ...]

    def lines(self) -> list[str]:
        """Return the answer, and what to know about it, as lines of plain text for a terminal."""
        decided = [f"{distance}: {sentence}" for distance, sentence in self.verdicts]
        described = [f"{finding.distance}: {finding.sentence}" for finding in self.findings]
        label = [SIMULATED] if self.is_simulated else []
        found = (decided or described) if self.ratings else self.limits[:1]
        noted = [f"Note: {note}" for note in (*self.notes, *self.chart_notes)]
        return [*label, *found, *noted]


def summarise(
    material: Material, parts: Parts, found: Sequence[Finding], *, folder: Path
) -> Summary:
    """Return what was found; which files were written is added when they are."""
    tables, own, costs = material.tables, material.inference, material.costs
    rated = answered(tables.ratings)
    lods = set(tables.ratings["lod"])
    return Summary(
        findings=tuple(replace(one, distance=place(one.distance, lods)) for one in found),
        verdicts=(
            *((place(one.distance, lods), answer(one, costs)) for one in own.decisions),
            *effect_answers(own.effects, costs),
            *((BY_SIZE, policy_answer(policy, costs)) for policy in [own.policy] if policy),
        ),
        limits=(*limits(tables, parts.audit, own), *own.warnings()),
        design=tuple(parts.audit.facts()),
        quality=tuple(quality_statements(tables)),
        notes=tables.notes,
        chart_notes=tuple(chart_notes(tables)),
        is_simulated=tables.is_simulated,
        people=rated["participant"].nunique(),
        ratings=len(rated),
        report=folder / REPORT,
        files=(),
    )
