"""The consent: motion, age, contact, withdrawal, and what eyes can see as a question apart."""

from __future__ import annotations

from typing import Any

import pytest

from study.data import consents, events, export
from study.design.definition import StudyDefinition, parse_definition
from study.site.consent_words import consent_words
from study.texts import catalogue

pytestmark = pytest.mark.parametrize("database_kind", ["sqlite"])


@pytest.fixture
def changes() -> dict[str, Any]:
    return {}


@pytest.fixture
def definition(definition: StudyDefinition, changes: dict[str, Any]) -> StudyDefinition:
    data = definition.model_dump(mode="json", exclude_unset=True, exclude={"translations"})
    data["consent"] = data["consent"] | changes
    return parse_definition(data)


def with_consent(**changes: Any) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("changes", [changes])


def agree(guest: Any, **fields: Any) -> None:
    guest.get("/consent")
    guest.post("/consent", version=guest.hidden("version"), **fields)


def consented(site: Any) -> Any:
    [person] = site.people()
    return next(e.payload for e in events.history(site.db, person) if e.kind == "consented")


def test_the_page_says_what_people_must_know_before_they_agree(guest: Any) -> None:
    page = guest.get("/consent").text
    for words in (
        "dizzy",
        "I am at least 18 years old.",
        "Everything that is stored about you is then erased.",
        "Only the day on which someone withdrew and how far they had come remain",
        "Copies made for safety",
        "archives that others have taken away stay as they are",
        "the researcher who invited you",
        "data about your health",
    ):
        assert words in page, words


@with_consent(
    minimum_age=16, backup_days=30, motion_warning="It sways.", health=None, statements=[]
)
def test_the_study_file_sets_age_backups_and_warning(site: Any, guest: Any) -> None:
    page = guest.get("/consent").text
    for words in ("I am at least 16 years old.", "kept for 30 days at most", "It sways."):
        assert words in page, words
    assert 'name="health"' not in page
    agree(guest, agree=["1"])
    assert guest.at == "/about-you"
    kept = consented(site)
    assert (kept["minimum_age"], kept["health"]) == (16, None)


def test_which_text_somebody_agreed_to_is_kept(site: Any, guest: Any) -> None:
    guest.agree()
    kept, definition = consented(site), site.study.definition
    assert kept["consent_version"] == definition.consent.version
    assert kept["statements"][0] == "I am at least 18 years old."
    assert kept["text_sha256"] == consent_words(definition, catalogue("en")).sha256
    other = consent_words(definition, catalogue("ar"))
    assert kept["text_sha256"] != other.sha256


def test_without_the_consent_to_it_nobody_asks_about_eyesight(site: Any, guest: Any) -> None:
    agree(guest, agree=["1", "2"])
    assert guest.at == "/about-you"
    assert 'name="eyesight"' not in guest.page.text
    entry = {"kind": "answer", "key": "k", "question": "eyesight", "value": "corrected"}
    assert guest.send(**entry).json()["ok"] is False
    guest.post("/about-you", age="33", eyesight="corrected")
    assert guest.at == "/instructions"
    [person] = site.people()
    assert not consents.allows_health(site.db, person)
    assert "corrected" not in str([event.payload for event in events.history(site.db, person)])


def test_with_the_consent_to_it_eyesight_is_asked(site: Any, guest: Any) -> None:
    agree(guest, agree=["1", "2"], health="yes")
    assert 'name="eyesight"' in guest.page.text
    [person] = site.people()
    assert consents.allows_health(site.db, person)


def test_what_was_ticked_stays_when_something_is_missing(guest: Any) -> None:
    agree(guest, agree=["2"], health="yes")
    page = guest.page.text
    assert guest.page.status_code == 422
    assert 'name="agree" value="2" required checked' in page
    assert 'name="agree" value="1" required>' in page
    assert 'name="health" value="yes" checked' in page


def test_declining_stores_nothing(site: Any, guest: Any) -> None:
    guest.get("/declined")
    assert "nothing about you was stored" in guest.page.text
    assert len(export.tables(site.db, site.study).participants) == 0
