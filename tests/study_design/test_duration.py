"""How long a visit takes: what the estimate is made of, and that fifteen minutes are enough."""

from __future__ import annotations

from typing import Any

import pytest

from study.design.definition import parse_definition, read_definition
from study.design.duration import minutes, visit_parts


@pytest.mark.parametrize("name", ["lod", "ablation"])
def test_a_visit_to_the_recommended_studies_fits_fifteen_minutes(name: str) -> None:
    assert 10 < minutes(read_definition(name)) <= 15


def test_the_thesis_takes_the_ten_minutes_that_its_consent_promises() -> None:
    assert 5 < minutes(read_definition("thesis")) <= 10


def test_watching_grows_with_clips_views_and_length(raw: dict[str, Any]) -> None:
    once = visit_parts(parse_definition(raw))["watching"]
    assert once == pytest.approx(3 * (1.4 * 1.0 + 2.0))  # practice and two trials of a second each
    raw["order"] = {"min_views": 3}
    assert visit_parts(parse_definition(raw))["watching"] == pytest.approx(3 * (3 * 1.0 + 2.0))
    raw["orbit"]["duration_s"] = 4.0
    assert visit_parts(parse_definition(raw))["watching"] == pytest.approx(3 * (3 * 4.0 + 2.0))


def test_answering_takes_less_where_a_question_is_shown_to_some(raw: dict[str, Any]) -> None:
    # A choice, a text that a rule shows to every second and one in three writes, and a scale.
    answering = visit_parts(parse_definition(raw))["answering"]
    assert answering == pytest.approx(3 * (3 + 10 / 3 / 2 + 3))


def test_reading_goes_by_the_words_of_the_pages(raw: dict[str, Any]) -> None:
    before = visit_parts(parse_definition(raw))["instructions"]
    raw["instructions"] = {**raw["instructions"], "paragraphs": [{"text": "word " * 239}]}
    after = visit_parts(parse_definition(raw))["instructions"]
    assert after - before == pytest.approx(60, abs=1)


def test_checks_breaks_and_questions_between_take_their_time(raw: dict[str, Any]) -> None:
    assert "breaks and questions between" not in visit_parts(parse_definition(raw))
    rest = {"title": "Rest", "button": "On", "paragraphs": [{"text": "Rest."}], "after": [1]}
    parts = visit_parts(parse_definition(raw | {"breaks": rest, "calibration": {}}))
    assert parts["breaks and questions between"] == 20
    assert parts["calibration"] == 75
