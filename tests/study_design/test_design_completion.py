"""Outcomes, recruiting and consent in the study file: what is accepted and what each fault says."""

from __future__ import annotations

from typing import Any

import pytest

from study.design.completion import CheckRule, Completion, filled
from study.design.definition import parse_definition
from study.design.faults import DefinitionError
from study.design.recruiting import readable


def faults(raw: dict[str, Any]) -> list[str]:
    with pytest.raises(DefinitionError) as caught:
        parse_definition(raw, source="my.toml")
    return [str(fault) for fault in caught.value.faults]


def test_without_tables_everybody_who_took_part_gets_a_code_of_their_own() -> None:
    usual = Completion()
    codes = [usual.code_of(name) for name in ("completed", "failed_checks", "screened_out")]
    assert codes == ["generated", "generated", "none"]
    assert not usual.rule.is_failed(attention=9, gold=9)


def test_the_rule_counts_each_kind_of_check_apart() -> None:
    rule = CheckRule(failed_attention=2, failed_gold=3)
    assert not rule.is_failed(attention=1, gold=2)
    assert rule.is_failed(attention=2, gold=0)
    assert rule.is_failed(attention=0, gold=3)


def test_every_fault_of_completion_is_told_at_once(raw: dict[str, Any]) -> None:
    raw["recruiting"] = {"parameters": [{"name": "PROLIFIC_PID"}, {"name": "id", "store": "plain"}]}
    raw["completion"] = {
        "completed": {"code": "no spaces", "redirect": "https://a.example/{PROLIFIC_PID}/{ids}"},
        "screened_out": {"redirect": "https://a.example/{code}"},
        "failed_checks": {"redirect": "javascript:alert(1)"},
        "rule": {"failed_gold": 0},
    }
    told = faults(raw)
    assert told == [
        'completion.completed.code: "no spaces" is no code; use 1 to 40 letters, digits and "-", '
        'or write "generated" for one of their own for everybody, "none" for none',
        'completion.failed_checks.redirect: "javascript:alert(1)" is no address; begin it with '
        "https:// and the name of the site",
        "completion.rule.failed_gold: input should be greater than or equal to 1; found 0",
        'completion.completed.redirect: unknown place "PROLIFIC_PID"; choose one of code, id; a '
        "parameter can be filled in only where it is stored plain",
        'completion.completed.redirect: unknown place "ids"; choose one of code, id; did you mean '
        '"id"?; a parameter can be filled in only where it is stored plain',
        'completion.screened_out.redirect: unknown place "code"; choose one of id; a parameter '
        "can be filled in only where it is stored plain",
    ]


def test_an_address_with_an_open_brace_is_a_fault(raw: dict[str, Any]) -> None:
    raw["completion"] = {"completed": {"redirect": "https://a.example/{code"}}
    [told] = faults(raw)
    assert told.startswith('completion.completed.redirect: "https://a.example/{code": expected')


def test_what_is_filled_into_an_address_stays_a_value() -> None:
    hostile = "x&cc=OTHER#<script>/../"
    assert filled("https://a.example/?id={id}&cc={code}", {"id": hostile, "code": "C1"}) == (
        "https://a.example/?id=x%26cc%3DOTHER%23%3Cscript%3E%2F..%2F&cc=C1"
    )


def test_parameters_have_names_of_their_own(raw: dict[str, Any]) -> None:
    names = ("PROLIFIC_PID", "PROLIFIC_PID", "age", "arm", "a b")
    raw["recruiting"] = {"parameters": [{"name": name} for name in names]}
    assert faults(raw) == [
        'recruiting.parameters.4.name: "a b" is no parameter; use 1 to 40 letters, digits and '
        '"_", a letter first, like PROLIFIC_PID',
        'recruiting.parameters.1.name: "PROLIFIC_PID" is taken by recruiting.parameters.0; names '
        "must differ",
        'recruiting.parameters.2.name: "age" is taken by about.0; names must differ',
        'recruiting.parameters.3.name: "arm" is taken by a column of participants.csv; names must '
        "differ",
    ]


@pytest.mark.parametrize(
    ("value", "read"),
    [
        ("5f3a", "5f3a"),
        ("  5f3a ", "5f3a"),
        ("", ""),
        ("x" * 201, ""),
        ("a\nb", ""),
        ("a\x00b", ""),
        ("\ud83d", ""),
        ("<script>", "<script>"),  # text like any other; pages escape it
    ],
)
def test_only_what_a_recruiter_sends_is_read(value: str, read: str) -> None:
    assert readable(value) == read


def test_health_questions_have_to_be_asked_somewhere(raw: dict[str, Any]) -> None:
    raw["consent"] = {**raw["consent"], "health": {"questions": ["agee"]}}
    [told] = faults(raw)
    assert told.startswith(
        'consent.health.questions.0: unknown question about the participant "agee"; choose one of'
    )


def test_a_consent_asks_health_questions_only_of_those_who_agreed(raw: dict[str, Any]) -> None:
    first = raw["about"][0]["id"]
    raw["consent"] = {**raw["consent"], "health": {"questions": [first]}, "minimum_age": 16}
    consent = parse_definition(raw).consent
    assert consent.asks(first, with_health=True)
    assert not consent.asks(first, with_health=False)
    assert consent.asks("anything", with_health=False)
    assert consent.tick_count == 1 + len(consent.statements)


def test_new_tables_that_are_left_out_leave_a_study_its_name(raw: dict[str, Any]) -> None:
    before = parse_definition(raw).definition_hash
    assert parse_definition(raw | {"recruiting": None}).definition_hash == before
    changed = raw | {"recruiting": {"links_only": True}}
    assert parse_definition(changed).definition_hash != before
