"""An attention question among a trial's own, on the real pages and in the tables."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest

from study import bots
from study.data import codebook, export
from study.data.validity import Tally
from study.design.definition import StudyDefinition, read_definition
from study.simulate import simulate
from study.site.signatures import simulation_token

DOTS = {
    "id": "dots",
    "kind": "scale",
    "text": "To show that you read this, please choose 2.",
    "is_required": True,
    "lowest_label": "one",
    "highest_label": "five",
}
ARABIC = {
    "text": "لكي نعرف أنك تقرأ، يُرجى اختيار 2.",
    "lowest_label": "واحد",
    "highest_label": "خمسة",
}


@pytest.fixture
def definition(small_study: Callable[..., StudyDefinition]) -> StudyDefinition:
    """Two trials; the second asks one thing more, before the ratings."""
    arabic = read_definition("thesis").model_dump(mode="json")["translations"]["ar"]
    attention = [{"within": 2, "before": "rating_left", "expected": 2, "question": DOTS}]
    return small_study(
        attention=attention,
        translations={"ar": arabic | {"attention": [{"question": ARABIC}]}},
    )


def to_second_trial(guest: Any) -> None:
    guest.walk_to_trial()
    for _ in range(2):  # practice and the first trial
        assert "please choose 2" not in guest.page.text
        guest.watch()
        guest.finish(comparison="1")
    assert guest.at == "/trial/3"


def test_it_is_one_of_the_questions_of_its_trial(guest: Any) -> None:
    to_second_trial(guest)
    text = guest.page.text
    assert text.index("noticed") < text.index("please choose 2") < text.index("rating_left")
    # A reload with an answer given shows it again, in its place and with its answer.
    guest.send(kind="answer", key="k", position=3, question="dots", value="4")
    text = guest.get("/trial/3").text
    assert text.index("please choose 2") < text.index("rating_left")
    assert text.count("checked") == 1


def test_left_open_it_is_asked_kindly_again(guest: Any) -> None:
    to_second_trial(guest)
    guest.watch()
    guest.finish(comparison="-1")
    assert guest.page.status_code == 422
    assert "Please answer this question to go on." in guest.page.text
    assert "please choose 2" in guest.page.text
    guest.finish(comparison="-1", dots="2")
    assert guest.at == "/thanks"


@pytest.mark.parametrize("database_kind", ["sqlite"])
def test_no_other_trial_takes_an_answer_to_it(guest: Any) -> None:
    guest.walk_to_trial()
    told = guest.send(kind="answer", key="k", position=1, question="dots", value="2")
    assert told.json()["faults"] == {"dots": "This question is not part of the study."}
    guest.watch()
    guest.finish(comparison="1", dots="2")
    assert guest.at == "/trial/2"


@pytest.mark.parametrize("database_kind", ["sqlite"])
@pytest.mark.parametrize(
    ("answer", "tally"), [("2", Tally(attention_passed=1)), ("4", Tally(attention_failed=1))]
)
def test_the_tables_tell_what_was_answered_and_what_was_expected(
    site: Any, guest: Any, *, answer: str, tally: Tally
) -> None:
    to_second_trial(guest)
    guest.watch()
    guest.finish(dots=answer)
    assert guest.at == "/thanks"
    tables = export.tables(site.db, site.study)
    dots = tables.comparisons.sort_values("trial")["dots"]
    assert dots.isna().tolist() == [True, True, False]
    assert str(dots.iloc[2]) == answer
    (row,) = tables.participants.to_dict("records")
    counted = {
        "attention_passed": tally.attention_passed,
        "attention_failed": tally.attention_failed,
    }
    assert {name: row[name] for name in counted} == counted
    more = codebook.own_columns(site.study.definition)
    told = codebook.codebook_of(site.study, more)
    assert "(an attention question in trial 2; expected: 2)" in json.dumps(told)


@pytest.mark.parametrize("database_kind", ["sqlite"])
def test_it_is_asked_in_the_language_of_the_reader(site: Any) -> None:
    reader = site.guest(**{"Accept-Language": "ar"})
    to_second_trial(reader)
    assert ARABIC["text"] in reader.page.text
    reader.client.close()


@pytest.mark.parametrize("database_kind", ["sqlite"])
def test_bots_and_simulated_people_answer_it(site: Any) -> None:
    bots.walk(
        site.url,
        site.study.definition,
        media_folder=site.settings.media_folder,
        simulation_token=simulation_token(site.settings.secret_key()),
        participants=1,
        seed=1,
    )
    simulate(site.db, site.study.definition, participants=2, seed=2)
    people = export.tables(site.db, site.study).participants
    passed = people["attention_passed"] + people["attention_failed"]
    assert passed.tolist() == [1, 1, 1]
