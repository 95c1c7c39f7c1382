"""Every kind of question: what it takes and refuses, when it is shown, what a file gets wrong."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter

from analysis.simulation.observers import draw_observer
from study.answering import about_answers
from study.design.definition import DefinitionError, parse_definition
from study.design.faults import KINDS
from study.design.question_kinds import Question, cell_id
from study.design.questions import AnswerError, each_asked, is_shown, read_answers
from study.texts import catalogue

SAY = catalogue("en").text
BASE = {"id": "q", "text": "?"}
TICKS = [{"value": v, "label": v.upper()} for v in ("iris", "lids", "white")]
NONE = {"value": "none", "label": "None", "is_exclusive": True}
MULTIPLE = BASE | {"kind": "multiple", "options": [*TICKS, NONE], "most": 2}
LINE = BASE | {"kind": "analogue", "lowest_label": "no", "highest_label": "yes"}
NUMBER = BASE | {"kind": "number", "minimum": 0.5, "maximum": 2, "decimals": 2}
ROWS = [{"id": "iris", "label": "Iris"}, {"id": "white", "label": "White"}]
MATRIX = BASE | {
    "kind": "matrix",
    "rows": ROWS,
    "per_eye": True,
    "labels": ["a", "b", "c"],
    "highest": 3,
}


def question(data: dict[str, Any]) -> Any:
    return TypeAdapter(Question).validate_python(data)


def answered(data: dict[str, Any], given: object) -> object:
    return read_answers([question(data)], {"q": given})["q"]


def refusal(data: dict[str, Any], given: object) -> str:
    with pytest.raises(AnswerError) as caught:
        answered(data, given)
    return caught.value.said(SAY)["q"]


def messages(raw: dict[str, Any]) -> list[str]:
    with pytest.raises(DefinitionError) as caught:
        parse_definition(raw)
    return [str(fault) for fault in caught.value.faults]


def test_the_kinds_that_faults_name_are_those_that_there_are() -> None:
    schema = TypeAdapter(Question).json_schema()
    assert set(schema["discriminator"]["mapping"]) == set(KINDS)


@pytest.mark.parametrize(
    ("given", "stored"),
    [
        (["lids", "iris"], ["iris", "lids"]),
        ("white", ["white"]),
        (["none"], ["none"]),
        ([], None),
        ([""], None),
        (None, None),
    ],
)
def test_what_is_ticked_is_a_list_in_the_files_order(given: object, stored: object) -> None:
    assert answered(MULTIPLE, given) == stored


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["iris", "brow"], "Please choose one of the answers shown."),
        (["iris", "none"], "“None” cannot be ticked together with other answers."),
        (["iris", "lids", "white"], "Please tick at most 2 answers."),
    ],
)
def test_ticks_that_do_not_go_together_are_refused(given: object, said: str) -> None:
    assert refusal(MULTIPLE, given) == said


def test_too_few_ticks_are_refused_unless_one_stands_alone() -> None:
    wanted = MULTIPLE | {"fewest": 2}
    assert refusal(wanted, ["iris"]) == "Please tick at least 2 answers."
    assert answered(wanted, ["none"]) == ["none"]


@pytest.mark.parametrize(("given", "stored"), [("0", 0), ("63", 63), ("100", 100), ("", None)])
def test_a_mark_on_a_line_is_a_whole_number(given: str, stored: int | None) -> None:
    assert answered(LINE, given) == stored


@pytest.mark.parametrize("given", ["-1", "101", "1.5", "x"])
def test_a_mark_beside_the_line_is_refused(given: str) -> None:
    assert refusal(LINE, given) == "Please choose one of the answers shown."


@pytest.mark.parametrize(
    ("given", "stored"),
    [("1.25", 1.25), ("1,5", 1.5), ("2", 2.0), ("١٫٥", 1.5), (" 0.50 ", 0.5)],
)
def test_a_number_is_read_as_people_write_it(given: str, stored: float) -> None:
    assert answered(NUMBER, given) == stored


@pytest.mark.parametrize("given", ["0.4", "2.01", "1.234", "1e0", "nan", "inf", "1.", "--1"])
def test_any_other_number_is_refused_with_what_is_accepted(given: str) -> None:
    assert refusal(NUMBER, given) == "Please enter a number from 0.5 to 2 with at most 2 decimals."


def test_whole_numbers_stay_whole_in_any_digits() -> None:
    age = BASE | {"kind": "number", "minimum": 18, "maximum": 99}
    assert answered(age, "٣٣") == 33
    assert isinstance(answered(age, "33"), int)
    assert refusal(age, "33,0") == "Please enter a whole number from 18 to 99."


def test_a_matrix_is_a_scale_for_each_row_and_eye() -> None:
    cells = each_asked([question(MATRIX)])
    assert [cell.id for cell in cells] == [
        "q_iris_left",
        "q_white_left",
        "q_iris_right",
        "q_white_right",
    ]
    assert [cell.kind for cell in cells] == ["scale"] * 4
    assert cells[0].text == "? – Iris"
    assert cell_id("q", "iris") == "q_iris"
    given = {"q_iris_left": "3", "q_white_right": "", "q_iris_right": "1"}
    assert read_answers([question(MATRIX)], given) == {
        "q_iris_left": 3,
        "q_white_right": None,
        "q_iris_right": 1,
    }


def test_every_row_of_a_required_matrix_has_to_be_answered() -> None:
    with pytest.raises(AnswerError) as caught:
        read_answers([question(MATRIX | {"is_required": True})], {"q_iris_left": "3"})
    assert set(caught.value.faults) == {"q_white_left", "q_iris_right", "q_white_right"}


@pytest.mark.parametrize(
    ("rule", "answer", "shown"),
    [
        ({"values": ["iris"]}, ["iris", "lids"], True),
        ({"values": ["iris"]}, ["lids"], False),
        ({"values": [4, 5]}, 4, True),
        ({"values": [4, 5]}, None, False),
        ({"at_least": 4}, 4, True),
        ({"at_least": 4}, 3, False),
        ({"at_least": 1, "at_most": 2}, 2.5, False),
        ({"at_most": 2}, None, False),
        ({"at_most": 2}, "2", False),
    ],
)
def test_a_question_is_shown_after_the_answers_that_its_rule_names(
    rule: dict[str, Any], answer: Any, shown: bool
) -> None:
    ruled = question(BASE | {"kind": "text", "shown_if": {"question": "other", **rule}})
    assert is_shown(ruled, {"other": answer}) is shown


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (MULTIPLE | {"most": 9}, "questions.0.most: 9 of 4 options"),
        (MULTIPLE | {"fewest": 3}, "questions.0.most: 2 is fewer than fewest, 3"),
        (MATRIX | {"highest": 4}, "questions.0.labels: 3 labels for 4 steps"),
        (
            MATRIX | {"labels": []},
            "questions.0.lowest_label: missing; this key is required without labels",
        ),
        (
            MATRIX | {"rows": [ROWS[0], ROWS[0]]},
            'questions.0.rows.1.id: id "q_iris_left" is taken by questions.0.rows.0.id; ids must '
            "differ",
        ),
        (
            BASE | {"kind": "scale", "highest": 20, "lowest_label": "a", "highest_label": "b"},
            "questions.0.highest: 20 steps do not fit on a line; at most 11, or use an analogue",
        ),
        (NUMBER | {"maximum": 0.5}, "questions.0.maximum: 0.5 is not above minimum 0.5"),
        (
            LINE | {"id": "distance"},
            'questions.0.id: "distance" is a column of the tables already; rename it',
        ),
    ],
)
def test_a_question_that_cannot_be_asked_is_a_fault(
    raw: dict[str, Any], changes: dict[str, Any], message: str
) -> None:
    raw["questions"] = [changes]
    assert message in messages(raw)


@pytest.mark.parametrize(
    ("rule", "message"),
    [
        ({}, "questions.1.shown_if: says no answer; give values, at_least or at_most"),
        (
            {"at_least": 1},
            "questions.1.shown_if.at_least: q is answered by no number; use values",
        ),
        (
            {"at_least": 1, "values": ["iris"]},
            "questions.1.shown_if: values and at_least exclude each other; use one of them",
        ),
        (
            {"values": ["iriss"]},
            'questions.1.shown_if.values: unknown answer "iriss"; choose one of iris, lids, white, '
            'none; did you mean "iris"?',
        ),
    ],
)
def test_a_rule_that_leads_nowhere_is_a_fault(
    raw: dict[str, Any], rule: dict[str, Any], message: str
) -> None:
    ruled = {"id": "r", "kind": "text", "text": "?", "shown_if": {"question": "q", **rule}}
    raw["questions"] = [MULTIPLE, ruled]
    assert message in messages(raw)


def test_simulated_people_answer_every_kind(raw: dict[str, Any]) -> None:
    rng = np.random.default_rng(1)
    kinds = [
        data | {"id": f"q{number}", "is_required": True}
        for number, data in enumerate((MULTIPLE, LINE, NUMBER, MATRIX))
    ]
    raw["about"] = kinds
    definition = parse_definition(raw)
    given = about_answers(definition, draw_observer(rng), rng)
    assert set(given) == {one.id for one in each_asked(definition.about)}
    assert read_answers(definition.about, given) == given
