"""The consent form sent again after its answer was lost: one participant, whatever brought them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from study.data import consents, events, export, links
from study.design.definition import StudyDefinition, parse_definition
from study.site import signatures

# How somebody comes: by a recruiter that names them, by one that does not, by a link of their own.
WAYS = {
    "prolific": {"parameters": [{"name": "PROLIFIC_PID", "is_person": True, "is_required": True}]},
    "sona": {"parameters": [{"name": "survey_code", "is_person": True, "is_required": True}]},
    "course": {"parameters": [{"name": "course", "store": "plain", "is_required": True}]},
    "personal link": {"links_only": True},
    "plain link": {},
}
ADDRESSES = {
    "prolific": "/?PROLIFIC_PID=5f3a",
    "sona": "/?survey_code=77",
    "course": "/?course=eyes",
    "plain link": "/",
}


@pytest.fixture(params=WAYS)
def way(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture
def definition(definition: StudyDefinition, way: str) -> StudyDefinition:
    data = definition.model_dump(mode="json", exclude_unset=True, exclude={"translations"})
    return parse_definition(data | ({"recruiting": WAYS[way]} if WAYS[way] else {}))


@pytest.fixture
def come(site: Any, way: str) -> Callable[[Any], None]:
    """Return what opens the consent as somebody of this way does."""
    if way == "personal link":
        [link] = links.make(site.db, site.study, 1)
        address = f"/link/{link.token}"
    else:
        address = ADDRESSES[way]

    def open_consent(guest: Any) -> None:
        guest.get(address)
        guest.get("/consent")

    return open_consent


on_one_way = pytest.mark.parametrize("way", ["plain link"])


def send(guest: Any, **fields: Any) -> None:
    """Send the form of the page; its answer, and with it the cookie, is lost on the way."""
    form = {name: guest.hidden(name) for name in ("ticket", "version")}
    kept = dict(guest.client.cookies)
    guest.client.post(
        "/consent", data={**form, "agree": ["1", "2"], **fields}, follow_redirects=False
    )
    guest.client.cookies.clear()
    for name, value in kept.items():
        guest.client.cookies.set(name, value)


def again(guest: Any, **fields: Any) -> None:
    guest.post("/consent", version=guest.hidden("version"), agree=["1", "2"], **fields)


def statuses(site: Any) -> list[str]:
    return [str(one) for one in export.tables(site.db, site.study).participants["status"]]


def test_a_form_sent_again_finds_the_participant_of_the_first(
    site: Any, guest: Any, come: Callable[[Any], None]
) -> None:
    come(guest)
    send(guest)
    assert len(site.people()) == 1
    again(guest)
    assert guest.at == "/about-you"
    guest.post("/about-you", age="33")
    assert guest.at == "/instructions"
    [person] = site.people()
    kinds = [event.kind for event in events.history(site.db, person)]
    assert kinds == ["consented", "about"]


def test_so_does_a_form_opened_anew_by_the_same_way(
    site: Any, guest: Any, come: Callable[[Any], None]
) -> None:
    come(guest)
    send(guest)
    come(guest)
    # Who is known by their address or link needs no second form.
    if guest.at == "/consent":
        again(guest)
    assert guest.at == "/about-you"
    assert len(site.people()) == 1


@on_one_way
def test_two_presses_at_once_make_one_participant(
    site: Any, guest: Any, come: Callable[[Any], None]
) -> None:
    from concurrent.futures import ThreadPoolExecutor

    come(guest)
    form = {name: guest.hidden(name) for name in ("ticket", "version")} | {"agree": ["1", "2"]}
    others = [site.guest() for _ in range(4)]
    with ThreadPoolExecutor(4) as pool:
        pages = list(pool.map(lambda one: one.client.post("/consent", data=form), others))
    assert [page.url.path for page in pages] == ["/about-you"] * 4
    assert len(site.people()) == 1
    for one in others:
        one.client.close()


@on_one_way
def test_what_was_ticked_last_counts(site: Any, guest: Any, come: Callable[[Any], None]) -> None:
    come(guest)
    send(guest, health="yes")
    [person] = site.people()
    assert consents.allows_health(site.db, person)
    send(guest)
    assert not consents.allows_health(site.db, person)
    again(guest)
    assert not consents.allows_health(site.db, person)
    told = [dict(event.payload) for event in events.history(site.db, person)]
    assert [payload["health"] for payload in told] == [True, False]


@on_one_way
def test_a_form_whose_person_has_gone_on_opens_nothing_to_the_next(
    site: Any, guest: Any, come: Callable[[Any], None]
) -> None:
    come(guest)
    form = {name: guest.hidden(name) for name in ("ticket", "version")} | {"agree": ["1", "2"]}
    again(guest)
    guest.post("/about-you", age="33")
    stranger = site.guest()
    page = stranger.client.post("/consent", data=form)
    assert page.status_code == 422
    assert "This form was used before, or lay open for too long." in page.text
    assert "checked" not in page.text
    stranger.page = page
    again(stranger)
    assert stranger.at == "/about-you"
    assert len(site.people()) == 2
    stranger.client.close()


@on_one_way
@pytest.mark.parametrize("ticket", ["", "made-up", None])
def test_a_form_that_is_not_ours_or_too_old_enrols_nobody(
    site: Any,
    guest: Any,
    *,
    come: Callable[[Any], None],
    ticket: str | None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    come(guest)
    if ticket is None:
        ticket = guest.hidden("ticket")
        monkeypatch.setattr(signatures, "ARRIVAL_S", -1)
    version = guest.hidden("version")
    page = guest.client.post(
        "/consent", data={"ticket": ticket, "version": version, "agree": ["1", "2"]}
    )
    assert page.status_code == 422
    assert "This form was used before, or lay open for too long." in page.text
    assert statuses(site) == []
