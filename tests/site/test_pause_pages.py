"""Breaks and questions between trials on the real pages, in a study of blocks, gold and all."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest

from study import bots
from study.data import export, trials
from study.data.validity import Tally
from study.design.definition import StudyDefinition
from study.site.signatures import simulation_token

REST = {"title": "A rest", "button": "I have rested", "paragraphs": [{"text": "Look away."}]}
COLOUR = {
    "id": "colour",
    "kind": "choice",
    "text": "Please choose blue.",
    "is_required": True,
    "options": [{"value": name, "label": name.title()} for name in ("red", "blue")],
}
EXPECTED = [{"question": "comparison", "value": 1}]


@pytest.fixture
def definition(small_study: Callable[..., StudyDefinition]) -> StudyDefinition:
    """Six pairings of which one person sees four, a gold trial, a question and a break."""
    factors = {"distances": ["near"], "lods": ["low", "medium", "high"], "against": ["ultra"]}
    gold = {"id": "gold", "distance": "macroscopic", "left": "low", "right": "ultra", "after": 1}
    return small_study(
        clips=[],
        factors=[factors],
        per_person={"pairs": 4},
        order={"trials": "balanced", "warm_up": 1},
        gold=[gold | {"expected": EXPECTED}],
        breaks=REST | {"after": [2]},
        attention=[{"after": 2, "expected": "blue", "question": COLOUR}],
    )


def rate(guest: Any) -> None:
    guest.watch()
    guest.finish(comparison="1")


def to_question(guest: Any) -> None:
    guest.walk_to_trial()
    for _ in range(3):  # practice and two trials
        rate(guest)


def test_a_question_and_a_break_stand_between_trials(guest: Any) -> None:
    to_question(guest)
    assert guest.at == "/pause"
    assert "Please choose blue." in guest.page.text
    guest.post("/pause", pause=guest.hidden("pause"), colour="blue")
    assert guest.at == "/pause"
    assert "A rest" in guest.page.text
    assert "2 of 5 clips are done." in guest.page.text
    guest.post("/pause", pause=guest.hidden("pause"))
    assert guest.at == "/trial/4"


def test_reload_back_and_a_skipped_page_lead_to_the_pause(guest: Any) -> None:
    to_question(guest)
    for path in ("/trial/4", "/trial/2", "/continue", "/thanks", "/preparing"):
        guest.get(path)
        assert guest.at == "/pause", path
    name = guest.hidden("pause")
    guest.post("/pause", pause="break-2")  # not due yet
    assert guest.hidden("pause") == name
    guest.post("/pause", pause=name, colour="red")
    assert guest.hidden("pause") == "break-2"
    guest.post("/pause", pause=name, colour="blue")  # sent twice: the first answer stays
    assert guest.hidden("pause") == "break-2"


def test_a_question_left_open_is_asked_kindly_again(guest: Any) -> None:
    to_question(guest)
    guest.post("/pause", pause=guest.hidden("pause"))
    assert guest.page.status_code == 422
    assert "Please answer this question to go on." in guest.page.text
    guest.post("/pause", pause=guest.hidden("pause"), colour="red")
    assert "A rest" in guest.page.text


def test_the_end_tells_nobody_what_they_passed_and_the_tables_do(guest: Any, site: Any) -> None:
    to_question(guest)
    guest.post("/pause", pause=guest.hidden("pause"), colour="red")
    guest.post("/pause", pause=guest.hidden("pause"))
    while guest.at.startswith("/trial/"):
        rate(guest)
    assert guest.at == "/thanks"
    for word in ("attention", "gold", "passed", "failed"):
        assert word not in guest.page.text.lower()
    (row,) = export.tables(site.db, site.study).participants.to_dict("records")
    found = Tally(gold_passed=1, attention_failed=1)
    assert {name: row[name] for name in vars(found)} == vars(found)


def test_a_gold_trial_looks_like_any_other(guest: Any, site: Any) -> None:
    guest.walk_to_trial()
    pages = []
    for _ in range(3):
        rate(guest)
        pages.append(guest.page.text)
    person = site.people()[0]
    mine = trials.all_trials(site.db, person)
    assert [trial.clip for trial in mine].index("gold") == 2
    assert "Clip 2 of 5" in pages[1]
    assert "gold" not in pages[1].replace("golden", "")


def test_bots_pass_pauses_and_share_out_the_blocks(site: Any) -> None:
    codes = bots.walk(
        site.url,
        site.study.definition,
        media_folder=site.settings.media_folder,
        simulation_token=simulation_token(site.settings.secret_key()),
        participants=3,
        seed=3,
    )
    assert len(set(codes)) == 3
    people = export.tables(site.db, site.study).participants
    assert people["block"].nunique() == 3
    assert people["order_row"].nunique() == 3
    passed = people["attention_passed"] + people["attention_failed"]
    assert passed.tolist() == [1, 1, 1]


def test_nobody_meets_a_pause_who_is_not_at_one(guest: Any) -> None:
    guest.get("/pause")
    assert guest.at == "/"
    guest.walk_to_trial()
    guest.get("/pause")
    assert guest.at == "/trial/1"


def test_the_dashboard_counts_checks_and_groups_the_blocks(guest: Any) -> None:
    to_question(guest)
    guest.post("/pause", pause=guest.hidden("pause"), colour="red")
    guest.sign_in()
    text = " ".join(re.sub(r"<[^>]*>", " ", guest.get("/researcher").text).split())
    assert "Gold trials passed 1 of 1" in text
    assert "Attention passed 0 of 1" in text
    assert "320x180 rightward 1 0 1" in text  # one person, in one of six blocks
