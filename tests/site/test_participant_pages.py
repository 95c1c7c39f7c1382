"""A participant's way over HTTP: every page, every answer once, and always to the same place."""

from __future__ import annotations

from typing import Any

from study.data import completion, export, participants, progress, trials
from study.data.database import Database


def answers_at(db: Database, participant: participants.Participant, position: int) -> Any:
    found = trials.at(db, participant, position)
    assert found is not None
    return found.answers


ANSWERS = {"comparison": "1", "noticed": "yes", "what_differed": "the shine"}
RATINGS = {"rating_left": "2", "rating_right": "5", "comments": ""}


def test_a_participant_goes_from_the_first_page_to_the_completion_code(
    site: Any, guest: Any
) -> None:
    assert "watch 3 short clips" in guest.get("/").text
    guest.agree()
    assert guest.at == "/about-you"
    guest.post("/about-you", age="33", gender="woman")
    assert guest.at == "/instructions"
    guest.post("/instructions")
    assert guest.at == "/preparing"
    screen = {"screen_width_px": "1920", "screen_height_px": "1080", "pixel_ratio": "2"}
    guest.post("/preparing", **screen)
    for position in (1, 2, 3):
        assert guest.at == f"/trial/{position}"
        assert guest.watch().json()["certified"] is True
        guest.finish(**ANSWERS, **RATINGS, response_ms="8123")
    assert guest.at == "/thanks"
    code = completion.code(site.db, site.people()[0])
    assert code is not None
    assert code in guest.page.text
    tables = export.tables(site.db, site.study)
    assert list(tables.comparisons["comparison"]) == [1, 1, 1]
    assert list(tables.comparisons["response_ms"]) == [8123, 8123, 8123]
    assert list(tables.comparisons["certified"]) == [True, True, True]
    assert list(tables.ratings["shown_scale"]) == [1.0] * 6
    assert tables.participants["screen_width"][0] == 960
    assert tables.participants["age"][0] == 33


def test_consent_needs_every_statement(guest: Any, site: Any) -> None:
    guest.get("/consent")
    page = guest.post("/consent", version=guest.hidden("version"), agree=["1"])
    assert page.status_code == 422
    assert "please tick every sentence" in page.text
    assert len(export.tables(site.db, site.study).participants) == 0


def test_consent_to_another_version_does_not_count(guest: Any) -> None:
    guest.get("/consent")
    page = guest.post("/consent", version="0", agree=["1", "2"])
    assert "This text has changed" in page.text


def test_consent_sent_twice_makes_one_participant(guest: Any, site: Any) -> None:
    guest.agree()
    guest.client.post("/consent", data={"version": "1", "agree": ["1", "2"]})
    assert len(export.tables(site.db, site.study).participants) == 1


def test_every_other_page_leads_to_the_present_one(guest: Any) -> None:
    guest.agree()
    for path in ("/consent", "/instructions", "/preparing", "/trial/2", "/thanks", "/withdrawn"):
        guest.get(path)
        assert guest.at == "/about-you", path


def test_a_stranger_is_led_to_the_first_page(guest: Any) -> None:
    guest.get("/trial/1")
    assert guest.at == "/"


def test_a_wrong_age_is_explained_and_everything_typed_stays(guest: Any) -> None:
    guest.agree()
    page = guest.post("/about-you", age="7", gender="woman")
    assert page.status_code == 422
    assert "Please enter a whole number from 18 to 120." in page.text
    assert 'value="7"' in page.text
    assert 'value="woman" checked' in page.text


def test_what_was_typed_about_oneself_survives_leaving_the_page(guest: Any) -> None:
    guest.agree()
    assert guest.send(kind="answer", key="a1", question="age", value="41").json()["ok"]
    guest.get("/continue")
    assert 'value="41"' in guest.page.text


def test_an_answer_is_stored_when_given_and_shown_after_a_reload(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    guest.send(kind="answer", key="k1", position=1, question="rating_left", value="4")
    assert answers_at(site.db, site.people()[0], 1) == {"rating_left": 4}
    assert 'name="rating_left" value="4" checked' in guest.get("/trial/1").text


def test_the_same_entry_twice_counts_once(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    assert [guest.watch("same").json()["new"] for _ in range(2)] == [True, False]
    found = trials.at(site.db, site.people()[0], 1)
    assert found is not None
    assert found.views == 1


def test_a_form_sent_twice_finishes_one_trial(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    guest.watch()
    form = {"csrf": guest.hidden("csrf"), "key": guest.hidden("key"), "rating_left": "3"}
    first = guest.client.post("/trial/1", data=form)
    second = guest.client.post("/trial/1", data=form)
    assert first.url.path == second.url.path == "/trial/2"
    assert [t.is_complete for t in trials.all_trials(site.db, site.people()[0])] == [
        True,
        False,
        False,
    ]


def test_the_form_waits_for_the_clip_and_keeps_the_answers(guest: Any) -> None:
    guest.walk_to_trial()
    page = guest.finish(rating_left="3")
    assert page.status_code == 422
    assert "Please watch the clip to its end first" in page.text
    assert 'name="rating_left" value="3" checked' in page.text


def test_a_skipped_question_is_missing_and_not_zero(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    guest.watch()
    guest.finish(rating_left="3", rating_right="")
    ratings = export.tables(site.db, site.study).ratings
    first = ratings[ratings["trial"].str.endswith("-01")]
    assert list(first["rating"].isna()) == [False, True]


def test_a_page_of_a_passed_trial_leads_to_the_present_one(guest: Any) -> None:
    guest.walk_to_trial()
    guest.watch()
    guest.finish(rating_left="3")
    guest.get("/trial/1")
    assert guest.at == "/trial/2"
    guest.post("/trial/1", key="late", rating_left="5")
    assert guest.at == "/trial/2"


def test_an_entry_for_a_trial_ahead_is_refused(guest: Any) -> None:
    guest.walk_to_trial()
    answer = guest.send(kind="answer", key="k", position=3, question="rating_left", value="1")
    assert answer.status_code == 409


def test_an_answer_that_does_not_fit_says_why(guest: Any) -> None:
    guest.walk_to_trial()
    answer = guest.send(kind="answer", key="k", position=1, question="rating_left", value="9")
    assert answer.json() == {
        "key": "k",
        "ok": False,
        "faults": {"rating_left": "Please choose one of the answers shown."},
    }


def test_entries_and_forms_without_their_token_are_refused(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    entry = {"kind": "answer", "key": "k", "position": 1, "question": "rating_left", "value": "1"}
    assert guest.client.post("/events", json=entry).status_code == 403
    forged = guest.client.post("/trial/1", data={"csrf": "0" * 64, "rating_left": "1"})
    assert forged.status_code == 403
    assert "Please send that again" in forged.text
    assert answers_at(site.db, site.people()[0], 1) == {}


def test_an_entry_without_a_cookie_is_not_taken_for_stored(guest: Any) -> None:
    entry = {"kind": "answer", "key": "k", "position": 1, "question": "rating_left", "value": "1"}
    assert guest.client.post("/events", json=entry).status_code == 401


def test_the_personal_link_leads_another_browser_to_the_same_trial(site: Any, guest: Any) -> None:
    guest.walk_to_preparing()
    guest.get("/stop")
    link = guest.page.text.split("/resume/")[1].split('"')[0]
    guest.get("/continue")
    guest.post("/preparing", screen_width_px="1920", screen_height_px="1080", pixel_ratio="1")
    guest.watch()
    guest.finish(rating_left="3")
    other = site.guest()
    other.get(f"/resume/{link}")
    assert other.at == "/trial/2"
    other.client.close()


def test_a_wrong_personal_link_leads_to_the_first_page(guest: Any) -> None:
    guest.get("/resume/abc")
    assert guest.at == "/"


def test_withdrawing_removes_the_answers(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    guest.watch()
    guest.finish(rating_left="3")
    guest.get("/stop")
    assert "please tick the sentence" in guest.post("/stop", choice="remove").text
    guest.post("/stop", choice="remove", sure="yes")
    assert guest.at == "/withdrawn"
    assert "Your answers are removed" in guest.page.text
    assert len(export.tables(site.db, site.study).ratings) == 0
    guest.get("/trial/2")
    assert guest.at == "/withdrawn"


def test_whoever_withdrew_hands_over_a_computer_that_holds_nothing_of_them(guest: Any) -> None:
    guest.walk_to_trial()
    guest.get("/next")
    assert "All answers of the last person are stored." in guest.page.text
    guest.get("/stop")
    guest.post("/stop", choice="remove", sure="yes")
    guest.get("/next")
    assert "Nothing of the last person is stored." in guest.page.text
    assert "All answers" not in guest.page.text
    guest.post("/next")
    assert "ocularist_participant" not in guest.client.cookies
    guest.get("/withdrawn")
    assert guest.at == "/"


def test_stopping_keeps_the_answers_and_lets_the_browser_go(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    guest.watch()
    guest.finish(rating_left="3")
    guest.get("/stop")
    assert "The answers you gave are kept." in guest.post("/stop", choice="keep").text
    assert answers_at(site.db, site.people()[0], 1)["rating_left"] == 3
    guest.get("/continue")
    assert guest.at == "/"


def test_the_next_person_at_a_shared_computer_is_somebody_else(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    guest.get("/next")
    assert "To go on later they need their personal" in guest.page.text
    guest.post("/next")
    assert guest.at == "/"
    guest.walk_to_trial()
    people = export.tables(site.db, site.study).participants
    assert people["participant"].nunique() == 2


def test_orders_differ_between_people(site: Any) -> None:
    orders = set()
    for _ in range(8):
        one = site.guest()
        one.walk_to_trial()
        one.client.close()
    for person in site.people():
        assert progress.current_step(site.db, person).name == "practice"
        orders.add(tuple(trial.clip for trial in trials.all_trials(site.db, person)))
    assert orders == {("practice", "1", "2"), ("practice", "2", "1")}
