"""The report's sections on fit, rivals, groups and reach: what they say and what stands in them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analysis.decision.margins import DEFAULT
from analysis.inference.inferring import Inference, infer
from analysis.report.diagnostic_sections import (
    detectable_section,
    fit_section,
    groups_section,
    rivals_section,
)
from analysis.report.diagnostic_tables import p_text
from analysis.report.observer_tables import observers_table
from analysis.report.sections import observers_section
from analysis.screening.signals import observer_signals
from analysis.tables.reading import Tables


@pytest.fixture(scope="module")
def inference(thesis_tables: Tables) -> Inference:
    return infer(thesis_tables)


def test_the_fit_is_said_in_a_sentence_each(inference: Inference) -> None:
    section = fit_section(inference.realism)
    residuals, ends, odds = section.sentences
    assert residuals.startswith("Residuals: the model ")
    assert ends.startswith("The rating 5 was given ")
    assert odds.startswith("Proportional odds")
    assert set(section.data) == {"residuals", "predicted-shares", "fit-checks", "odds-tests"}
    assert [len(table.rows) for table in section.tables] == [7, 4]
    again = fit_section(inference.realism)
    assert again.sentences == section.sentences  # seeds are fixed
    assert again.data["residuals"].equals(section.data["residuals"])


def test_rivals_stand_side_by_side_and_the_report_s_is_marked(inference: Inference) -> None:
    section = rivals_section(inference.realism)
    assert [row[0] for row in section.tables[0].rows] == [
        "nothing",
        "leniency *",
        "leniency, scatter and style",
        "leniency, logit link",
        "leniency, on a metric scale",
    ]
    assert "Taken as a metric scale, ratings are foretold" in section.sentences[0]
    assert "rounds to it" in section.tables[0].note


def test_groups_are_named_whether_asked_or_not(thesis_tables: Tables, inference: Inference) -> None:
    observers = observers_section(thesis_tables, inference).data["observer-signals"]
    section = groups_section(thesis_tables, observers)
    assert section.sentences[0] == "Not asked: glasses."
    own = [row for row in section.tables[0].rows if row[0] == "works with graphics"]
    assert own
    nobody = replace(thesis_tables, participants=thesis_tables.participants.iloc[:0])
    silent = groups_section(nobody, observers)
    assert silent.tables == ()
    assert "eyesight" in silent.sentences[0]


def test_what_could_be_shown_is_said_per_distance(inference: Inference) -> None:
    section = detectable_section(inference)
    assert [text.split(":")[0] for text in section.sentences] == ["macroscopic", "near", "far"]
    assert all("0.50 were asked for" in text for text in section.sentences)
    strict = replace(inference, margins=replace(DEFAULT, realism_points=3.0))
    assert "could be shown to be so" in detectable_section(strict).sentences[0]


def test_without_a_model_each_section_says_so() -> None:
    nothing = Inference(None, None, None, (), DEFAULT)
    reason = ("No model of ratings was fitted: that takes ratings by two people.",)
    assert fit_section(None).sentences == reason
    assert rivals_section(None).sentences == reason
    assert detectable_section(nothing).sentences == (
        "No LoD was rated by two people beside a best one.",
    )


def test_the_table_of_observers_shows_who_looked(thesis_tables: Tables) -> None:
    signals = observer_signals(thesis_tables).head(3).copy()
    signals["looking"] = [np.log(12.0), np.nan, -9.0]
    table = observers_table(signals, {}, {})
    place = table.head.index("looking")
    assert [row[place] for row in table.rows] == ["12 : 1", "–", "< 1 : 1000"]
    assert len(table.rows[0]) == len(table.head)


def test_p_values_are_written_with_three_digits() -> None:
    assert [p_text(p) for p in (0.0004, 0.0412, float("nan"))] == ["< 0.001", "0.041", "–"]
