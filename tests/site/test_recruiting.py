"""How people come in: by parameters of their address, by a personal link, at a shared computer."""

from __future__ import annotations

import json
import re
import threading
from datetime import timedelta
from typing import Any

import pytest

from study.data import completion, events, export, links, participants, studies
from study.data.schema import ParticipantRow, SessionRow
from study.design.definition import StudyDefinition, parse_definition

PROLIFIC = {
    "parameters": [
        {"name": "PROLIFIC_PID", "is_person": True, "is_exported": True, "is_required": True},
        {"name": "STUDY_ID", "store": "plain", "is_exported": True},
        {"name": "SESSION_ID"},
    ]
}
# What the database itself has to do is tried on both kinds, pages on the quicker one.
on_sqlite = pytest.mark.parametrize("database_kind", ["sqlite"])
COMING = "/?PROLIFIC_PID=5f3a&STUDY_ID=st-1&SESSION_ID=se-1"


@pytest.fixture
def recruiting() -> dict[str, Any]:
    return PROLIFIC


@pytest.fixture
def definition(definition: StudyDefinition, recruiting: dict[str, Any]) -> StudyDefinition:
    data = definition.model_dump(mode="json", exclude_unset=True, exclude={"translations"})
    return parse_definition(data | {"recruiting": recruiting})


def with_recruiting(**table: Any) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("recruiting", [table])


def let_pass(site: Any, **span: float) -> None:
    """Let time pass since anybody was last seen."""
    with site.db.writing() as session:
        for row in (ParticipantRow, SessionRow):
            for one in session.query(row).all():
                one.last_seen_at -= timedelta(**span)


def people(site: Any) -> Any:
    return export.tables(site.db, site.study).participants


@on_sqlite
def test_parameters_are_kept_as_the_study_file_says(site: Any, guest: Any) -> None:
    page = guest.get(COMING)
    assert (guest.at, str(page.url.query)) == ("/", "b''")  # nobody passes on a name by accident
    assert "carries PROLIFIC_PID, STUDY_ID, SESSION_ID" in guest.get("/consent").text
    guest.walk_to_preparing()
    row = people(site).iloc[0]
    assert row["STUDY_ID"] == "st-1"
    assert len(row["PROLIFIC_PID"]) == 16
    assert row["PROLIFIC_PID"] != "5f3a"
    assert "SESSION_ID" not in people(site).columns
    [person] = site.people()
    assert set(person.arrival) == {"PROLIFIC_PID", "STUDY_ID", "SESSION_ID"}
    assert "5f3a" not in str(person.arrival)


def test_the_same_person_in_another_browser_gets_their_own_session(site: Any, guest: Any) -> None:
    guest.get(COMING)
    guest.walk_to_preparing()
    other = site.guest()
    other.get(COMING)
    assert other.at == "/preparing"
    assert len(people(site)) == 1
    private = re.findall(r'href="[^"]*(/resume/[^"]+)"', other.get("/stop").text)[0]
    third = site.guest()
    third.get(private)
    assert third.at == "/preparing"
    third.client.close()
    other.get("/?PROLIFIC_PID=ffff")
    assert other.at == "/"
    assert "Begin" in other.page.text
    other.client.close()


def test_two_windows_of_one_person_make_one_participant(site: Any) -> None:
    guests = [site.guest() for _ in range(3)]
    for one in guests:
        one.get(COMING)
        one.get("/consent")
    threads = [
        threading.Thread(
            target=one.post, args=["/consent"], kwargs={"version": "2", "agree": ["1", "2"]}
        )
        for one in guests
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(30)
    assert len(people(site)) == 1
    assert {one.at for one in guests} == {"/about-you"}
    for one in guests:
        one.client.close()


@on_sqlite
def test_who_brings_no_required_parameter_is_told_to_use_their_link(site: Any, guest: Any) -> None:
    assert "This study is by invitation" in guest.get("/?STUDY_ID=st-1").text
    guest.get("/consent")
    assert guest.at == "/"
    guest.client.post("/consent", data={"version": "2", "agree": ["1", "2"]})
    assert len(people(site)) == 0


@on_sqlite
@pytest.mark.parametrize("value", ["x" * 5000, "%00", "%0d%0aSet-Cookie:a=b", "%ED%A0%BD", "%20"])
def test_a_value_that_no_recruiter_sends_is_none(guest: Any, value: str) -> None:
    page = guest.get(f"/?PROLIFIC_PID={value}")
    assert page.status_code == 200
    assert "This study is by invitation" in page.text


@on_sqlite
@with_recruiting(parameters=[{"name": "id", "store": "plain", "is_exported": True}])
def test_hostile_values_stay_values(site: Any, guest: Any) -> None:
    evil = "'\"><script>alert(1)</script>"
    guest.client.get("/", params={"id": evil})
    page = guest.walk_to_preparing()
    assert "<script>alert" not in page.text
    assert people(site)["id"][0] == evil


@with_recruiting(links_only=True)
def test_a_personal_link_opens_one_session_on_any_device(site: Any, guest: Any) -> None:
    assert "This study is by invitation" in guest.get("/").text
    [link] = links.make(site.db, site.study, 1)
    guest.get(f"/link/{link.token}")
    assert guest.at == "/"
    guest.walk_to_trial()
    other = site.guest()
    other.get(f"/link/{link.token}")
    assert other.at == "/trial/1"
    for _ in range(3):
        other.watch()
        other.finish(rating_left="3")
    assert other.at == "/thanks"
    guest.get(f"/link/{link.token}")  # the same person, in the first browser
    assert guest.at == "/thanks"
    stranger = site.guest()
    page = stranger.get(f"/link/{link.token}")
    assert page.status_code == 410
    assert "This link has been used" in page.text
    stranger.get("/consent")
    assert stranger.at == "/"
    assert links.counts(site.db, site.study) == links.LinkCounts(used=1, unused=0)
    assert [person.recruited_by for person in site.people()] == ["personal link"]
    for one in (other, stranger):
        one.client.close()


@on_sqlite
def test_a_link_that_nobody_made_for_this_study_says_so(site: Any, guest: Any) -> None:
    other = parse_definition(
        json.loads(site.study.definition.to_json()) | {"key": "other", "recruiting": None}
    )
    [link] = links.make(site.db, studies.register(site.db, other), 1)
    assert guest.get(f"/link/{link.token}").status_code == 404
    page = guest.get("/link/abcdef")
    assert page.status_code == 404
    assert "No study here knows this personal link" in page.text
    assert "LINK-UNKNOWN" in page.text


@on_sqlite
def test_a_personal_link_takes_a_browser_over_from_somebody_else(site: Any, guest: Any) -> None:
    guest.get(COMING)
    guest.walk_to_preparing()
    [link] = links.make(site.db, site.study, 1)
    guest.get(f"/link/{link.token}")
    assert "Begin" in guest.page.text
    guest.agree()
    assert len(people(site)) == 2


@on_sqlite
@with_recruiting(shared_computers=True)
def test_half_an_hour_without_a_sign_frees_a_shared_computer(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    mine = guest.data("outbox")
    let_pass(site, minutes=31)
    guest.get("/trial/1")
    assert guest.at == "/"
    assert "Begin" in guest.page.text
    assert "Welcome back" not in guest.page.text
    guest.agree()
    entry = {"kind": "answer", "key": "late", "position": 1, "question": "comments"}
    sent = guest.client.post(
        "/events", json={**entry, "value": "mine"}, headers={"X-Ocularist-Outbox": mine}
    )
    assert sent.json()["ok"] is True
    first, second = site.people()
    assert [event.payload.get("answers") for event in events.history(site.db, first)][-1] == {
        "comments": "mine"
    }
    assert "answered" not in [event.kind for event in events.history(site.db, second)]


@on_sqlite
@with_recruiting(shared_computers=True)
def test_finishing_frees_a_shared_computer(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    for _ in range(3):
        guest.watch()
        guest.finish(rating_left="3")
    assert guest.get("/thanks").status_code == 200
    assert "Begin" in guest.get("/").text
    guest.get("/thanks")
    assert guest.at == "/"
    guest.agree()
    assert len(people(site)) == 2


@on_sqlite
@with_recruiting()
def test_after_half_an_hour_ones_own_browser_asks_who_is_there(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    let_pass(site, minutes=31)
    guest.get("/trial/1")
    assert guest.at == "/"
    assert "Welcome back. Your answers are safe." in guest.page.text
    guest.post("/continue")
    assert guest.at == "/trial/1"


@on_sqlite
@with_recruiting()
def test_what_is_sent_from_a_page_left_open_is_taken(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    let_pass(site, minutes=31)
    assert guest.watch().json()["ok"] is True
    let_pass(site, minutes=31)
    guest.finish(rating_left="3")
    assert guest.at == "/trial/2"


@on_sqlite
@with_recruiting()
def test_an_outbox_delivers_for_its_owner_alone(site: Any, guest: Any) -> None:
    guest.walk_to_trial()
    entry = {"kind": "problem", "key": "k", "position": 1, "code": "X"}
    proof, middle = guest.data("outbox"), len(guest.data("outbox")) - 10  # in the signature
    other = "B" if proof[middle] == "A" else "A"
    forged = {"X-Ocularist-Outbox": proof[:middle] + other + proof[middle + 1 :]}
    assert guest.client.post("/events", json=entry, headers=forged).status_code == 403
    stranger = site.guest()
    headers = {"X-Ocularist-Outbox": guest.data("outbox")}
    assert stranger.client.post("/events", json=entry, headers=headers).json()["ok"] is True
    stranger.get("/trial/1")
    assert stranger.at == "/"  # it delivers, and lets nobody in
    participants_before = len(people(site))
    guest.get("/stop")
    guest.post("/stop", choice="remove", sure="yes")
    late = stranger.client.post("/events", json={**entry, "key": "l"}, headers=headers)
    assert (late.status_code, late.json()["code"]) == (410, "WITHDRAWN")
    assert len(people(site)) == participants_before - 1
    stranger.client.close()


@on_sqlite
def test_a_pseudonym_is_not_a_key(site: Any, guest: Any) -> None:
    guest.get(COMING)
    guest.walk_to_preparing()
    [person] = site.people()
    assert participants.by_name(site.db, person.public_id) == person
    other = site.guest()
    for guess in (person.public_id, f"{person.public_id}.x.y"):
        other.get(f"/resume/{guess}")
        assert other.at == "/"
    other.client.close()


@on_sqlite
def test_the_dashboard_tells_outcomes_links_and_withdrawals(site: Any, guest: Any) -> None:
    links_made = links.make(site.db, site.study, 3)
    guest.get(f"/link/{links_made[0].token}")
    guest.walk_to_preparing()
    completion.screen_out(site.db, site.people()[0], reason="screen")
    gone = site.guest()
    gone.get(COMING)
    gone.walk_to_trial()
    gone.get("/stop")
    gone.post("/stop", choice="remove", sure="yes")
    gone.sign_in()
    overview = gone.get("/researcher").text
    assert "of 3, 2 unused" in overview
    for tile in ("Screened out</dt><dd>1", "Withdrawn</dt><dd>1", "Came</dt><dd>2"):
        assert tile in overview, tile
    listed = gone.get("/researcher/people").text
    assert "<td>screened out</td>" in listed
    assert "<td>personal link</td>" in listed
    assert re.search(r"<td>\d{4}-\d\d-\d\d</td><td>practice clip</td>", listed)
    gone.client.close()


@on_sqlite
def test_a_language_asked_for_is_kept_on_the_way(guest: Any) -> None:
    guest.client.follow_redirects = False
    assert guest.get(COMING + "&lang=pt-br").headers["location"] == "/?lang=pt-br"
    assert guest.get(COMING + "&lang=//x.example").headers["location"] == "/"


@on_sqlite
@with_recruiting(links_only=True)
def test_simulated_people_need_no_invitation(site: Any) -> None:
    one = site.guest(**site.simulation)
    one.agree()
    assert one.at == "/about-you"
    one.client.close()
