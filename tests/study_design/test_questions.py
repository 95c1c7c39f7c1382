"""What counts as an answer, and what a participant is told when it does not."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from study.design.definition import StudyDefinition, parse_definition
from study.design.questions import AnswerError, TextQuestion, is_shown, read_answer, read_answers
from study.texts import catalogue

ENGLISH = catalogue("en").text


@pytest.fixture
def definition(raw: dict[str, Any]) -> StudyDefinition:
    return parse_definition(raw)


def test_answers_are_read_as_the_values_of_their_columns(definition: StudyDefinition) -> None:
    given = {"noticed": "yes", "what_differed": " the pupil ", "rating_left": "4"}
    assert read_answers(definition.questions, given) == {
        "noticed": "yes",
        "what_differed": "the pupil",
        "rating_left": 4,
    }


@pytest.mark.parametrize("skipped", ["", "  ", None])
def test_a_skipped_question_is_missing_and_not_zero(
    definition: StudyDefinition, skipped: str | None
) -> None:
    assert read_answers(definition.questions, {"rating_left": skipped}) == {"rating_left": None}


def test_a_hidden_question_keeps_what_was_written(definition: StudyDefinition) -> None:
    answers = read_answers(definition.questions, {"noticed": "no", "what_differed": "x"})
    assert answers["what_differed"] == "x"
    assert not is_shown(definition.questions[1], answers)


def test_every_faulty_answer_is_told_at_once(definition: StudyDefinition) -> None:
    given = {"noticed": "perhaps", "rating_left": "6", "what_differed": "x" * 21, "other": "1"}
    with pytest.raises(AnswerError) as caught:
        read_answers(definition.questions, given)
    assert caught.value.said(ENGLISH) == {
        "noticed": "Please choose one of the answers shown.",
        "rating_left": "Please choose one of the answers shown.",
        "what_differed": "Please shorten your text to 20 characters; it has 21 now.",
        "other": "This question is not part of the study.",
    }


@pytest.mark.parametrize("text", ["17", "100", "12.5", "-1", "abc", "1e2"])
def test_a_number_outside_its_limits_is_refused(definition: StudyDefinition, text: str) -> None:
    with pytest.raises(AnswerError) as caught:
        read_answers(definition.about, {"age": text})
    assert caught.value.said(ENGLISH) == {"age": "Please enter a whole number from 18 to 99."}


def test_a_required_question_is_asked_for_only_when_shown_and_final(raw: dict[str, Any]) -> None:
    raw["questions"][1]["is_required"] = True
    questions = parse_definition(raw).questions
    assert read_answers(questions, {"noticed": "yes"}, is_final=False) == {"noticed": "yes"}
    assert read_answers(questions, {"noticed": "no"}) == {"noticed": "no"}
    with pytest.raises(AnswerError) as caught:
        read_answers(questions, {"noticed": "yes"})
    assert caught.value.said(ENGLISH) == {"what_differed": "Please answer this question to go on."}


@given(st.text(alphabet=st.characters(codec=None), max_size=300))
def test_any_text_can_be_stored_or_is_refused_with_its_length(text: str) -> None:
    question = TextQuestion(id="comments", kind="text", text="?", max_chars=200)
    if len(text.replace("\x00", "").replace("\r\n", "\n").strip()) > 200:
        with pytest.raises(ValueError, match="shorten your text to 200 characters"):
            read_answer(question, text)
        return
    answer = read_answer(question, text)
    assert answer is None or (isinstance(answer, str) and "\x00" not in answer)
    assert answer != ""
    assert str(answer).encode("utf-8")
