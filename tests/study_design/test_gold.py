"""Gold trials: what counts as the expected answer, and what a file may expect."""

from __future__ import annotations

from typing import Any

import pytest

from study.design.definition import DefinitionError, parse_definition, read_definition
from study.design.gold import Expected, Gold, is_passed

NEAR = {"distance": "near", "left": "low", "right": "ultra"}


def gold(*expected: Expected) -> Gold:
    return Gold(id="g", **NEAR, after=1, expected=expected)


def test_an_answer_passes_within_its_tolerance() -> None:
    rating = Expected(question="rating_right", value=5, tolerance=1)
    assert [rating.is_met(n) for n in (3, 4, 5)] == [False, True, True]
    assert Expected(question="comparison", value=1).is_met(1)
    assert not Expected(question="comparison", value=1).is_met(0)
    assert Expected(question="noticed", value="yes").is_met("yes")
    assert not Expected(question="noticed", value="yes").is_met("no")


def test_every_expected_answer_has_to_be_given() -> None:
    both = gold(Expected(question="a", value=1), Expected(question="b", value="yes"))
    assert is_passed(both, {"a": 1, "b": "yes"}) is True
    assert is_passed(both, {"a": 1, "b": "no"}) is False
    assert is_passed(both, {"a": 0, "b": "no"}) is False


def test_a_skipped_question_counts_neither_way() -> None:
    both = gold(Expected(question="a", value=1), Expected(question="b", value="yes"))
    assert is_passed(both, {"a": 1}) is None
    assert is_passed(both, {"a": 0, "b": None}) is None


@pytest.mark.parametrize("name", ["lod", "ablation"])
def test_the_studies_that_come_along_expect_what_nobody_can_miss(name: str) -> None:
    (found,) = read_definition(name).gold
    assert (found.distance, found.left, found.right) == ("macroscopic", "ultra", "bare")
    assert is_passed(found, {"comparison": -1}) is True
    assert is_passed(found, {"comparison": 0}) is False


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"expected": []}, "gold.0.expected: "),
        ({"after": 3}, "gold.0.after: 3 is no place among 3 trials"),
        ({"left": "lo"}, 'gold.0.left: unknown LoD "lo"; choose one of low, ultra, no-caustics'),
        ({"id": "a"}, 'gold.0.id: id "a" is taken by clips.0.id; ids must differ'),
        (
            {"expected": [{"question": "notice", "value": "yes"}]},
            'gold.0.expected.0.question: unknown question "notice"; choose one of noticed, '
            'what_differed, rating_left; did you mean "noticed"?',
        ),
        (
            {"expected": [{"question": "noticed", "value": "maybe"}]},
            'gold.0.expected.0.value: unknown answer "maybe"; choose one of yes, no, unsure',
        ),
        (
            {"expected": [{"question": "rating_left", "value": 6}]},
            'gold.0.expected.0.value: unknown answer "6"; choose one of 1, 2, 3, 4, 5',
        ),
        ({"iris": "red"}, 'gold.0.iris: unknown iris "red"; no iris is defined'),
    ],
)
def test_faults_of_gold_trials_are_told(
    raw: dict[str, Any], changes: dict[str, Any], told: str
) -> None:
    sound = {"id": "g", **NEAR, "after": 1, "expected": [{"question": "noticed", "value": "yes"}]}
    parse_definition(raw | {"gold": [sound]})
    with pytest.raises(DefinitionError) as caught:
        parse_definition(raw | {"gold": [sound | changes]}, source="x")
    assert any(line.startswith(f"x: {told}") for line in str(caught.value).splitlines())
