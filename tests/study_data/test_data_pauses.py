"""Pauses between trials: they come once, in their place, and their answers are data."""

from __future__ import annotations

from typing import Any

import pytest

from study.data import arms, export, pauses, progress, steps, studies, trials
from study.data.database import Database
from study.data.refusals import NotReachedError
from study.data.studies import Study
from study.data.validity import Tally, tally
from study.design.arms import all_arms
from study.design.definition import parse_definition
from study.design.order_codes import read_order_code, trials_of_code
from study.design.questions import AnswerError

PAGE = {"title": "Rest", "button": "On", "paragraphs": [{"text": "Rest."}]}
OPTIONS = [{"value": value, "label": value} for value in ("red", "blue")]
COLOUR = {"id": "colour", "kind": "choice", "text": "Choose blue.", "options": OPTIONS}


@pytest.fixture
def study(db: Database, raw: dict[str, Any]) -> Study:
    """Three trials and a gold one, a question and a break after the first, a break later."""
    expected = [{"question": "comparison", "value": 1}]
    gold = {"id": "g", "distance": "near", "left": "low", "right": "ultra", "after": 2}
    raw |= {
        "gold": [gold | {"expected": expected}],
        "breaks": PAGE | {"after": [1, 3]},
        "attention": [{"after": 1, "expected": "blue", "question": COLOUR | {"is_required": True}}],
        "order": {"trials": "file", "warm_up": 1},
    }
    return studies.register(db, parse_definition(raw))


def at(walk: Any) -> str:
    step = progress.current_step(walk.db, walk.participant)
    return step.pause.key if step.pause else f"{step.name} {step.number}".strip()


def go_on(walk: Any, comparison: str = "1", colour: str = "blue") -> None:
    step = progress.current_step(walk.db, walk.participant)
    if step.pause is not None:
        pauses.finish(walk.db, walk.participant, step.pause.key, {"colour": colour})
    elif step.trial is not None:
        walk.answer(step.trial.position, comparison=comparison)


def test_pauses_come_between_trials_in_order(walk: Any) -> None:
    walk.begin()
    seen = []
    while at(walk) != "thanks 0":
        seen.append(at(walk))
        go_on(walk)
    assert seen == [
        *("practice 1", "trial 1", "attention-colour", "break-1", "trial 2", "trial 3"),
        *("break-3", "trial 4"),
    ]


def test_a_pause_says_how_many_trials_are_done(walk: Any) -> None:
    walk.begin()
    for _ in range(2):
        go_on(walk)
    step = progress.current_step(walk.db, walk.participant)
    assert (step.name, step.number, step.total) == ("pause", 1, 4)


def test_the_trial_behind_a_pause_waits_for_it(walk: Any) -> None:
    walk.begin()
    for _ in range(2):
        go_on(walk)
    assert at(walk) == "attention-colour"
    with pytest.raises(NotReachedError, match="the pause break-1 is not due"):
        pauses.finish(walk.db, walk.participant, "break-1", {})
    with pytest.raises(NotReachedError, match="the pause break-9 is not due"):
        pauses.finish(walk.db, walk.participant, "break-9", {})


def test_a_pause_that_is_over_stays_as_it_was_answered(walk: Any) -> None:
    walk.begin()
    for _ in range(2):
        go_on(walk)
    assert pauses.finish(walk.db, walk.participant, "attention-colour", {"colour": "red"}).new
    again = pauses.finish(walk.db, walk.participant, "attention-colour", {"colour": "blue"})
    assert not again.new
    with walk.db.reading() as session:
        found = tally(session, walk.participant.id, walk.study.definition)
    assert (found.attention_passed, found.attention_failed) == (0, 1)


def test_a_required_question_between_trials_has_to_be_answered(walk: Any) -> None:
    walk.begin()
    for _ in range(2):
        go_on(walk)
    for colour in ("", "green"):
        with pytest.raises(AnswerError) as caught:
            pauses.finish(walk.db, walk.participant, "attention-colour", {"colour": colour})
        assert list(caught.value.faults) == ["colour"]
    assert at(walk) == "attention-colour"


@pytest.mark.parametrize(
    ("comparison", "colour", "expected"),
    [
        ("1", "blue", Tally(gold_passed=1, attention_passed=1)),
        ("0", "red", Tally(gold_failed=1, attention_failed=1)),
        ("", "blue", Tally(attention_passed=1)),
    ],
)
def test_gold_and_attention_are_counted_and_exported(
    walk: Any, comparison: str, colour: str, expected: Tally
) -> None:
    walk.begin()
    while at(walk) != "thanks 0":
        go_on(walk, comparison, colour)
    with walk.db.reading() as session:
        assert tally(session, walk.participant.id, walk.study.definition) == expected
    (row,) = export.tables(walk.db, walk.study).participants.to_dict("records")
    assert {name: row[name] for name in vars(expected)} == vars(expected)


def test_tables_flag_warm_up_gold_and_iris(walk: Any) -> None:
    walk.begin()
    while at(walk) != "thanks 0":
        go_on(walk)
    rows = export.tables(walk.db, walk.study).comparisons
    assert rows["clip"].tolist() == ["p", "a", "b", "g", "catch-far-low"]
    assert rows["is_practice"].tolist() == [True, False, False, False, False]
    assert rows["is_warm_up"].tolist() == [False, True, False, False, False]
    assert rows["is_gold"].tolist() == [False, False, False, True, False]
    assert rows["is_catch"].tolist() == [False, False, False, False, True]
    assert rows["iris"].isna().all()
    assert set(zip(rows["iris_seed"], rows["iris_colour"], strict=True)) == {(1, "blue")}
    assert set(rows["crowd"]) == {5}


def test_a_study_without_checks_leaves_their_columns_empty(
    db: Database, raw: dict[str, Any], enrol_into: Any
) -> None:
    for name in ("gold", "breaks", "attention"):
        raw.pop(name, None)
    study = studies.register(db, parse_definition(raw | {"key": "plain", "irises": {"eve": {}}}))
    walk = enrol_into(study)
    walk.begin()
    walk.finish()
    (row,) = export.tables(db, study).participants.to_dict("records")
    names = [*vars(Tally()), "block", "order_row"]
    assert export.tables(db, study).participants[names].isna().all(axis=None)
    assert row["order_code"] == f"0/0/{walk.participant.seed}"


def test_tables_name_iris_and_crowd_of_each_clip_and_the_codebook_all_irises(
    db: Database, raw: dict[str, Any], enrol_into: Any
) -> None:
    raw["irises"] = {"dark": {"iris_seed": 4, "iris_colour": "brown"}, "light": {"iris_seed": 2}}
    raw["clips"] = [{**clip, "iris": "dark"} for clip in raw["clips"]]
    raw["clips"][1]["crowd"] = 0
    raw |= {"gold": [], "attention": [], "breaks": None, "key": "two", "order": {"trials": "file"}}
    study = studies.register(db, parse_definition(raw))
    walk = enrol_into(study)
    walk.begin()
    walk.finish()
    found = export.tables(db, study)
    rows = found.comparisons[["clip", "iris", "iris_seed", "iris_colour"]].astype(object)
    assert rows.where(rows.notna(), None).to_numpy().tolist() == [
        ["p", None, 1, "blue"],
        ["a", "dark", 4, "brown"],
        ["b", "dark", 4, "brown"],
        ["catch-far-low", None, 1, "blue"],
    ]
    assert found.comparisons["crowd"].tolist() == [5, 5, 0, 5]
    columns = {column["name"]: column for column in found.codebook["tables"]["ratings"]}
    assert columns["iris"]["accepted"] == ["dark", "light"]


def test_the_order_code_of_the_tables_gives_the_trials_again(
    db: Database, raw: dict[str, Any], enrol_into: Any
) -> None:
    factors = {"distances": ["near", "far"], "lods": ["low", "own"], "against": ["ultra"]}
    more = {"clips": [], "catch": [], "factors": [factors], "per_person": {"pairs": 4}}
    definition = parse_definition(raw | more | {"key": "k", "order": {"trials": "balanced"}})
    study = studies.register(db, definition)
    walk = enrol_into(study, 3)
    walk.to_preparing()
    walk.participant = arms.assign(db, walk.participant, available=all_arms(definition))
    steps.begin(db, walk.participant, key="begin")
    (row,) = export.tables(db, study).participants.to_dict("records")
    told = trials_of_code(definition, read_order_code(row["order_code"], definition))
    assert [t.clip.id for t in told] == [t.clip for t in trials.all_trials(db, walk.participant)]
    assert (row["block"], row["order_row"]) == (walk.participant.block, walk.participant.order_row)
    assert row["arm"] == f"640x360 {row['arm'].split()[1]} block {row['block']}"
