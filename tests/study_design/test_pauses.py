"""Pauses: in which order they come, what passes a question, and where none can stand."""

from __future__ import annotations

from typing import Any

import pytest

from study.design.definition import DefinitionError, parse_definition

BREAKS = {"title": "Rest", "button": "On", "paragraphs": [{"text": "Rest."}], "after": [1]}
OPTIONS = [{"value": value, "label": value} for value in ("red", "blue")]
QUESTION = {"id": "colour", "kind": "choice", "text": "Choose blue.", "options": OPTIONS}
ASKED = {"after": 1, "expected": "blue", "question": QUESTION}


def test_pauses_come_by_number_and_a_question_before_a_break(raw: dict[str, Any]) -> None:
    raw["catch"] = [{"distance": "near", "lod": "low"}, {"distance": "far", "lod": "low"}]
    other = {**ASKED, "after": 2, "question": {**QUESTION, "id": "again"}}
    raw |= {"breaks": BREAKS | {"after": [3, 1]}, "attention": [other, ASKED]}
    found = parse_definition(raw).pauses
    assert [pause.key for pause in found] == [
        *("attention-colour", "break-1", "attention-again", "break-3")
    ]
    assert [pause.after for pause in found] == [1, 1, 2, 3]


def test_a_study_without_pauses_has_none(raw: dict[str, Any]) -> None:
    assert parse_definition(raw).pauses == ()


def test_an_attention_question_is_passed_by_the_answer_that_it_names(raw: dict[str, Any]) -> None:
    (asked,) = parse_definition(raw | {"attention": [ASKED]}).attention
    assert asked.is_passed({"colour": "blue"}) is True
    assert asked.is_passed({"colour": "red"}) is False
    assert asked.is_passed({"colour": None}) is None
    assert asked.is_passed({}) is None


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        (
            {"breaks": BREAKS | {"after": [2]}},
            "breaks.after: 2 is no place between 2 trials; use 1 to 1",
        ),
        ({"breaks": BREAKS | {"after": [1, 1]}}, "breaks.after: 1 is listed twice"),
        (
            {"attention": [ASKED | {"after": 5}]},
            "attention.0.after: 5 is no place between 2 trials; use 1 to 1",
        ),
        (
            {"attention": [ASKED | {"expected": "green"}]},
            'attention.0.expected: unknown answer "green"; choose one of red, blue',
        ),
        (
            {"attention": [ASKED, ASKED]},
            'attention.1.question.id: id "colour" is taken by attention.0; ids must differ',
        ),
        (
            {"order": {"warm_up": 2}},
            "order.warm_up: 2 of 2 trials; no trial would be left",
        ),
    ],
)
def test_faults_of_pauses_are_told(raw: dict[str, Any], changes: dict[str, Any], told: str) -> None:
    with pytest.raises(DefinitionError) as caught:
        parse_definition(raw | changes, source="x")
    assert f"x: {told}" in str(caught.value).splitlines()


def test_a_question_between_trials_depends_on_no_other(raw: dict[str, Any]) -> None:
    rule = {"question": "noticed", "values": ["yes"]}
    with pytest.raises(DefinitionError, match=r"attention\.0\.question\.shown_if: such a question"):
        parse_definition(raw | {"attention": [ASKED | {"question": QUESTION | {"shown_if": rule}}]})
