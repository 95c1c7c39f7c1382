"""In which language people read: by link, by choice, as their browser prefers; then for good."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any

import pytest
from sqlalchemy import select

from study.data import export
from study.data.schema import ParticipantRow
from study.design.definition import StudyDefinition, read_definition
from study.texts import catalogue

ARABIC = catalogue("ar").text


@pytest.fixture
def definition(small_study: Any) -> StudyDefinition:
    """The small study in English and Arabic."""
    made: StudyDefinition = small_study(translations=read_definition("thesis").translations)
    return made


@pytest.fixture
def reader(site: Any) -> Iterator[Any]:
    """Somebody whose browser asks for Arabic as spoken in Egypt."""
    one = site.guest(**{"Accept-Language": "ar-EG,ar;q=0.9,en;q=0.5"})
    yield one
    one.client.close()


def shown(guest: Any) -> tuple[str, str]:
    """Return language and direction of the last page."""
    found = re.search(r'<html lang="([^"]+)" dir="([^"]+)">', guest.page.text)
    assert found
    return found[1], found[2]


def stored(site: Any) -> list[str]:
    with site.db.reading() as session:
        return list(session.scalars(select(ParticipantRow.language)))


def test_the_browsers_preference_is_served_as_far_as_the_study_speaks_it(
    site: Any, guest: Any, reader: Any
) -> None:
    reader.get("/")
    assert shown(reader) == ("ar", "rtl")
    assert ARABIC("landing.begin") in reader.page.text
    assert site.study.definition.in_language("ar").title in reader.page.text
    guest.client.headers["Accept-Language"] = "fr, de;q=0.5"
    guest.get("/")
    assert shown(guest) == ("en", "ltr")


def test_a_link_goes_before_the_browser_and_is_remembered(reader: Any) -> None:
    reader.get("/?lang=en")
    assert shown(reader) == ("en", "ltr")
    reader.get("/consent")
    assert shown(reader) == ("en", "ltr")
    reader.get("/no-such-page")
    assert shown(reader) == ("en", "ltr")


def test_a_link_that_leads_on_is_remembered_too(guest: Any) -> None:
    answer = guest.client.get("/continue?lang=ar", follow_redirects=False)
    assert answer.status_code == 303
    assert answer.headers["set-cookie"] == "ocularist_language=ar; HttpOnly; Path=/; SameSite=lax"
    guest.get("/")
    assert shown(guest) == ("ar", "rtl")


@pytest.mark.parametrize(
    "wish", ["xx", "", "a", "ar;%20Path=/x", "%0d%0aSet-Cookie:x=1", "ar" * 30]
)
def test_a_wish_that_cannot_be_served_changes_nothing(guest: Any, wish: str) -> None:
    page = guest.get(f"/?lang={wish}")
    assert page.status_code == 200
    assert shown(guest) == ("en", "ltr")
    assert "x=1" not in page.headers.get("set-cookie", "")


def test_the_first_page_offers_every_language_in_its_own_words(guest: Any) -> None:
    page = guest.get("/").text
    assert re.search(r'href="\?lang=ar" lang="ar" dir="rtl" hreflang="ar">العربية</a>', page)
    assert re.search(r'lang="en" dir="ltr" hreflang="en" aria-current="true">English</a>', page)
    arabic = guest.get("/?lang=ar").text
    assert re.search(r'lang="en" dir="ltr" hreflang="en">English</a>', arabic)
    assert 'hreflang="ar" aria-current="true"' in arabic


def test_the_language_of_the_consent_is_stored_and_kept(site: Any, reader: Any) -> None:
    reader.agree()
    assert stored(site) == ["ar"]
    reader.client.headers["Accept-Language"] = "en"
    reader.client.cookies.delete("ocularist_language")
    reader.get("/continue?lang=en")
    assert shown(reader) == ("ar", "rtl")
    assert site.study.definition.in_language("ar").about_page.title in reader.page.text


def test_what_is_wrong_with_an_answer_is_said_in_the_same_language(reader: Any) -> None:
    reader.agree()
    reader.post("/about-you", age="7")
    assert ARABIC("answer.whole_number", lowest=18, highest=120) in reader.page.text
    reader.post("/about-you", age="٣٣")  # digits as they are typed there
    assert reader.at == "/instructions"
    reader.post("/instructions")
    screen = {"screen_width_px": "1920", "screen_height_px": "1080", "pixel_ratio": "1"}
    reader.post("/preparing", **screen)
    told = reader.send(kind="answer", key="k", position=1, question="rating_left", value="9").json()
    assert told["faults"] == {"rating_left": ARABIC("answer.choose")}


def test_a_page_gives_its_scripts_their_texts_and_no_more(reader: Any) -> None:
    reader.walk_to_trial()
    block = re.search(
        r'<script type="application/json" id="texts">(.*?)</script>', reader.page.text
    )
    assert block
    texts = json.loads(block[1])
    assert texts["all.saved"] == ARABIC("scripts.all.saved")
    assert texts["trial.open_questions"]["two"]
    assert {key.partition(".")[0] for key in texts} == {"all", "trial"}


def test_answers_in_another_language_are_the_same_data(site: Any, reader: Any) -> None:
    reader.walk_to_trial()
    assert "بالمقارنة مع العين اليسرى" in reader.page.text
    reader.watch()
    reader.finish(comparison="1", rating_left="2", noticed="yes", what_differed="اللمعان")
    row = export.tables(site.db, site.study).comparisons.iloc[0]
    assert (row["comparison"], row["noticed"], row["what_differed"]) == (1, "yes", "اللمعان")


def test_the_tables_tell_who_read_which_language(site: Any, guest: Any, reader: Any) -> None:
    guest.agree()
    reader.agree()
    found = export.tables(site.db, site.study)
    assert sorted(found.participants["language"]) == ["ar", "en"]
    [column] = [c for c in found.codebook["tables"]["participants"] if c["name"] == "language"]
    assert column["accepted"] == ["en", "ar"]


def test_researchers_read_english(reader: Any) -> None:
    reader.get("/researcher/sign-in")
    assert '<html lang="en"' in reader.page.text
