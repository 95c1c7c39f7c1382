"""Attention questions among a trial's own: where they stand, and where none can."""

from __future__ import annotations

from typing import Any

import pytest

from study.design.definition import DefinitionError, parse_definition
from study.design.duration import minutes
from study.design.translations import translated

DOTS = {
    "id": "dots",
    "kind": "scale",
    "text": "Please choose 2 here.",
    "lowest_label": "one",
    "highest_label": "five",
}
WITHIN = {"within": 2, "expected": 2, "question": DOTS}


def ids(definition: Any, number: int, *, is_practice: bool = False) -> list[str]:
    asked = definition.questions_at(number, is_practice=is_practice)
    return [question.id for question in asked]


def test_it_stands_among_the_questions_of_its_trial_alone(raw: dict[str, Any]) -> None:
    first = {**WITHIN, "before": "rating_left"}
    last = {**WITHIN, "within": 1, "question": DOTS | {"id": "more"}}
    study = parse_definition(raw | {"attention": [first, last]})
    usual = ["noticed", "what_differed", "rating_left"]
    assert ids(study, 1) == [*usual, "more"]
    assert ids(study, 2) == ["noticed", "what_differed", "dots", "rating_left"]
    for number in (1, 2):
        assert ids(study, number, is_practice=True) == usual
    assert study.pauses == ()
    assert [question.id for question in study.questions_of_all_trials] == [*usual, "dots", "more"]


def test_it_takes_its_time_once(raw: dict[str, Any]) -> None:
    longer = minutes(parse_definition(raw | {"attention": [WITHIN]}))
    assert 60 * (longer - minutes(parse_definition(raw))) == pytest.approx(3.0)


def test_what_an_older_file_says_keeps_its_hash(raw: dict[str, Any]) -> None:
    options = [{"value": value, "label": value} for value in ("red", "blue")]
    colour = {"id": "colour", "kind": "choice", "text": "Choose blue.", "options": options}
    raw["attention"] = [{"after": 1, "expected": "blue", "question": colour}]
    assert parse_definition(raw).definition_hash == "9b572de4bdc49a4f"
    raw["attention"] = [{"within": 1, "expected": "blue", "question": colour}]
    assert parse_definition(raw).definition_hash != "9b572de4bdc49a4f"


def test_its_words_are_translated(raw: dict[str, Any]) -> None:
    words = {"attention": [{"question": {"text": "يُرجى اختيار 2 هنا."}}]}
    study = translated(parse_definition(raw | {"attention": [WITHIN]}), words, "ar")
    *_, asked = study.questions_at(2, is_practice=False)
    assert asked.text == "يُرجى اختيار 2 هنا."


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        (
            {"within": None},
            "attention.0: neither is given of after, for a page between trials, and within, for "
            "a trial's own questions; give one",
        ),
        (
            {"after": 1},
            "attention.0: both are given of after, for a page between trials, and within, for a "
            "trial's own questions; give one",
        ),
        ({"within": 3}, "attention.0.within: 3 is none of 2 trials; use 1 to 2"),
        (
            {"before": "ratings"},
            'attention.0.before: unknown question "ratings"; choose one of noticed, '
            'what_differed, rating_left; did you mean "rating_left"?',
        ),
        (
            {"within": None, "after": 1, "before": "noticed"},
            "attention.0.before: a page between trials has no other question; leave this out",
        ),
        (
            {"question": DOTS | {"id": "noticed"}},
            'attention.0.question.id: id "noticed" is taken by questions.0; ids must differ',
        ),
        (
            {"question": DOTS | {"id": "views"}},
            'attention.0.question.id: "views" is a column of the tables already; rename it',
        ),
        (
            {"expected": 9},
            'attention.0.expected: unknown answer "9"; choose one of 1, 2, 3, 4, 5',
        ),
        (
            {"question": {name: DOTS[name] for name in DOTS if name != "highest_label"}},
            "attention.0.question.highest_label: missing; this key is required without labels",
        ),
    ],
)
def test_faults_are_told(raw: dict[str, Any], changes: dict[str, Any], told: str) -> None:
    with pytest.raises(DefinitionError) as caught:
        parse_definition(raw | {"attention": [WITHIN | changes]}, source="x")
    assert f"x: {told}" in str(caught.value).splitlines()


def test_it_does_not_part_the_two_eyes(raw: dict[str, Any]) -> None:
    left = raw["questions"][-1]
    raw["questions"].append(left | {"id": "rating_right"})
    with pytest.raises(DefinitionError, match=r'"rating_right" stands beside "rating_left"; use'):
        parse_definition(raw | {"attention": [WITHIN | {"before": "rating_right"}]})
