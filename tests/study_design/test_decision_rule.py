"""[decision] of a study file: declared margins, their faults, hash, codebook and audit."""

from __future__ import annotations

from typing import Any

import pytest

from analysis import declared_margins
from study.data.codebook import codebook_of
from study.data.studies import Study
from study.design.audit import statements, warnings
from study.design.definition import DefinitionError, parse_definition, read_definition

RULE = {"realism_margin": 0.5, "noticed_margin": 0.2, "sequence": ["ultra", "low"]}


def faults(raw: dict[str, Any], **changes: Any) -> str:
    with pytest.raises(DefinitionError) as caught:
        parse_definition(raw | {"decision": RULE | changes})
    return str(caught.value)


def test_a_file_without_the_table_keeps_its_hash_and_one_with_it_has_its_own(
    raw: dict[str, Any],
) -> None:
    plain, declared = parse_definition(raw), parse_definition(raw | {"decision": RULE})
    other = parse_definition(raw | {"decision": RULE | {"realism_margin": 0.4}})
    assert parse_definition(raw | {"decision": None}).definition_hash == plain.definition_hash
    assert len({d.definition_hash for d in (plain, declared, other)}) == 3
    assert read_definition("thesis").definition_hash == "86967b31e5816c2d"  # as before the table


def test_what_is_declared_comes_out_of_the_codebook_as_the_analysis_takes_it(
    raw: dict[str, Any],
) -> None:
    definition = parse_definition(raw | {"decision": RULE})
    study = Study(1, "small", "1", "A small study", definition)
    margins = declared_margins(codebook_of(study, {}))
    assert (margins.realism_points, margins.noticed_share, margins.confidence) == (0.5, 0.2, 0.95)
    assert margins.sequence == ("ultra", "low")
    assert margins.origins == "declared before data"
    bare = codebook_of(Study(1, "small", "1", "", parse_definition(raw)), {})
    assert "decision" not in bare
    assert declared_margins(bare).origins == "set at analysis"


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"realism_margin": 0}, "decision.realism_margin: input should be greater than 0; found 0"),
        ({"realism_margin": 4.0}, "decision.realism_margin: input should be less than 4; found 4"),
        ({"noticed_margin": 1.0}, "decision.noticed_margin: input should be less than 1; found 1"),
        ({"noticed_margin": "25 %"}, "decision.noticed_margin: expected a number; found '25 %'"),
        ({"confidence": 0.5}, "decision.confidence: input should be greater than 0.5; found 0.5"),
        ({"realism": 0.5}, 'decision.realism: unknown key "realism"; choose one of realism_margin'),
        ({"sequence": ["ultra"]}, "decision.sequence: one LoD is no sequence"),
        ({"sequence": ["ultra", "lo"]}, 'decision.sequence.1: unknown LoD "lo"; choose one of low'),
        ({"sequence": ["low", "low"]}, 'decision.sequence.1: "low" is listed twice'),
        (
            {"sequence": ["ultra", "no-caustics"]},
            'decision.sequence.1: no trial shows "no-caustics"; leave it out or show it',
        ),
    ],
)
def test_faults_name_their_place_and_what_is_accepted(
    raw: dict[str, Any], changes: dict[str, Any], told: str
) -> None:
    assert f"definition: {told}" in faults(raw, **changes)


def test_both_margins_are_required(raw: dict[str, Any]) -> None:
    with pytest.raises(DefinitionError) as caught:
        parse_definition(raw | {"decision": {"confidence": 0.9}})
    assert str(caught.value).splitlines() == [
        "definition: decision.realism_margin: missing; this key is required",
        "definition: decision.noticed_margin: missing; this key is required",
    ]


def test_the_audit_says_what_was_declared_or_that_nothing_was(raw: dict[str, Any]) -> None:
    text = " ".join(statements(parse_definition(raw | {"decision": RULE})))
    assert (
        "Declared before data: a LoD is enough if it is rated less than 0.5 points lower than the "
        "best one and noticed beside it by less than 20 % of people beyond false alarms, each with "
        "95 % confidence; tested in this order: ultra, low." in text
    )
    silent = parse_definition(raw)
    assert not any("Declared" in line for line in statements(silent))
    assert any(line.startswith("decision: no margins; the analysis") for line in warnings(silent))


def test_the_audit_warns_that_a_rule_cannot_be_met_without_equal_pairs(raw: dict[str, Any]) -> None:
    expected = (
        "catch: no equal pairs, so false alarms stay unknown, and no LoD can be called enough"
    )
    told = warnings(parse_definition(raw | {"decision": RULE, "catch": []}))
    assert any(line.startswith(expected) for line in told)
    assert not any(line.startswith("catch") for line in warnings(read_definition("lod")))


@pytest.mark.parametrize(("name", "margin"), [("lod", 0.5), ("ablation", 0.25)])
def test_the_studies_that_we_recommend_declare_their_margins(name: str, margin: float) -> None:
    rule = read_definition(name).decision
    assert rule is not None
    assert (rule.realism_margin, rule.noticed_margin, rule.confidence) == (margin, 0.25, 0.95)
