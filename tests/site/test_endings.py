"""The last pages: one for each outcome, with its code and the way back; one's own data."""

from __future__ import annotations

import json
from typing import Any

import pytest

from study.data import completion, export
from study.design.definition import StudyDefinition, parse_definition

pytestmark = pytest.mark.parametrize("database_kind", ["sqlite"])
PROLIFIC = "https://app.prolific.com/submissions/complete?cc={code}"
SONA = "https://x.sona-systems.com/webstudy_credit.aspx?experiment_id=1&survey_code={id}"
COMPLETION = {
    "completed": {"code": "C1DONE", "redirect": PROLIFIC, "redirect_label": "Back to Prolific"},
    "screened_out": {
        "code": "C2SCREEN",
        "title": "Not today",
        "paragraphs": [{"text": "Your screen is too small."}],
    },
    "failed_checks": {"code": "C3FAIL"},
    "rule": {"failed_attention": 1},
}
ATTENTION = {
    "after": 1,
    "question": {
        "id": "told",
        "kind": "choice",
        "text": "Please choose Blue.",
        "options": [{"value": "blue", "label": "Blue"}, {"value": "red", "label": "Red"}],
    },
    "expected": "blue",
}


@pytest.fixture
def changes() -> dict[str, Any]:
    return {"completion": COMPLETION}


@pytest.fixture
def definition(definition: StudyDefinition, changes: dict[str, Any]) -> StudyDefinition:
    data = definition.model_dump(mode="json", exclude_unset=True, exclude={"translations"})
    return parse_definition(data | changes)


def with_changes(**changes: Any) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("changes", [changes])


def finish(guest: Any) -> None:
    for _ in range(3):
        guest.watch()
        guest.finish(rating_left="3")


def test_a_completed_session_shows_the_studys_code_and_the_way_back(guest: Any) -> None:
    guest.walk_to_trial()
    guest.get("/thanks")
    assert "C1DONE" not in guest.page.text  # nothing before the last answer is stored
    finish(guest)
    assert guest.at == "/thanks"
    assert '<p class="code kept" dir="ltr" id="completion-code">C1DONE</p>' in guest.page.text
    assert 'href="https://app.prolific.com/submissions/complete?cc=C1DONE"' in guest.page.text
    assert "Back to Prolific" in guest.page.text
    assert "names your answers" not in guest.page.text  # a code for all names nobody


def test_everybody_has_the_code_that_the_study_gives_to_all(site: Any) -> None:
    for _ in range(2):
        one = site.guest()
        one.walk_to_trial()
        finish(one)
        assert "C1DONE" in one.page.text
        one.client.close()


@with_changes(
    recruiting={"parameters": [{"name": "id", "store": "plain"}]},
    completion={"completed": {"redirect": SONA, "code": "none"}},
)
def test_the_way_back_carries_what_the_address_brought(site: Any, guest: Any) -> None:
    guest.client.get("/", params={"id": "77&x=<b>"})
    guest.walk_to_trial()
    finish(guest)
    assert "survey_code=77%26x%3D%3Cb%3E" in guest.page.text
    assert "completion-code" not in guest.page.text
    other = site.guest()  # who came without it has no way back that would work
    other.walk_to_trial()
    finish(other)
    assert "sona-systems" not in other.page.text
    other.client.close()


def test_who_is_screened_out_has_a_page_and_a_code_of_their_own(site: Any, guest: Any) -> None:
    guest.walk_to_preparing()
    [person] = site.people()
    completion.screen_out(site.db, person, reason="screen", payload={"width": 800})
    completion.screen_out(site.db, person, reason="screen")
    guest.get("/continue")
    assert guest.at == "/screened-out"
    for words in ("Not today", "Your screen is too small.", "C2SCREEN"):
        assert words in guest.page.text
    row = export.tables(site.db, site.study).participants.iloc[0]
    assert (row["outcome"], row["status"]) == ("screened_out", "screened_out")
    guest.get("/thanks")
    assert guest.at == "/screened-out"


@with_changes()
def test_without_words_of_the_study_the_pages_have_their_own(site: Any, guest: Any) -> None:
    guest.walk_to_preparing()
    completion.screen_out(site.db, site.people()[0], reason="screen")
    page = guest.get("/screened-out").text
    assert "Thank you for coming" in page
    assert "That says nothing about you." in page
    assert "completion-code" not in page


@with_changes(completion=COMPLETION, attention=[ATTENTION])
def test_failed_checks_end_with_their_code_by_the_declared_rule(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    for _ in range(4):
        if guest.at.startswith("/trial"):
            guest.watch()
            guest.finish(rating_left="3")
        else:
            guest.post("/pause", pause=guest.hidden("pause"), told="red")
    assert guest.at == "/thanks"
    assert "C3FAIL" in guest.page.text
    assert "answered differently than expected" in guest.page.text
    row = export.tables(site.db, site.study).participants.iloc[0]
    assert row["outcome"] == "failed_checks"


def test_ones_own_data_can_be_taken_away(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    guest.watch()
    guest.finish(comments="all mine")
    answer = guest.client.get("/my-data")
    assert "attachment" in answer.headers["content-disposition"]
    told = json.loads(answer.text)
    assert told["participant"]["public_id"] == site.people()[0].public_id
    assert "all mine" in answer.text
    assert {event["kind"] for event in told["events"]} >= {"consented", "about", "answered"}
    # Who still rates must not read what a clip shows, nor anybody what proves who they are.
    assert not {"clip", "clip_id"} & set(told["trials"][0])
    assert not {"token_hash", "person_key", "seed"} & set(told["participant"])
    stranger = site.guest()
    assert stranger.get("/my-data").url.path == "/"
    stranger.client.close()
    for _ in range(2):
        guest.watch()
        guest.finish(rating_left="3")
    assert json.loads(guest.client.get("/my-data").text)["trials"][0]["clip"] == "practice"
