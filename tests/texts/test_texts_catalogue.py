"""The catalogue: texts by key, plurals by number, languages by wish; every file whole."""

from __future__ import annotations

import string
from pathlib import Path

import pytest
from markupsafe import Markup

from study.texts import catalogue, first_spoken, languages, tongue, wished_in_header
from study.texts.catalogue import CATEGORIES, Text, written_in

ENGLISH = catalogue("en")
OTHERS = [language for language in languages() if language != "en"]
# Some plural forms name the number in words: one, two, none.
NAMED_IN_WORDS = {"zero", "one", "two"}


def places(sentence: str) -> set[str]:
    return {name for _, name, _, _ in string.Formatter().parse(sentence) if name is not None}


def places_of(text: Text) -> set[str]:
    return places(text if isinstance(text, str) else text["other"])


def test_english_is_the_source_and_arabic_is_whole() -> None:
    assert languages()[0] == "en"
    assert "ar" in languages()


@pytest.mark.parametrize("language", OTHERS)
def test_every_language_has_every_text_and_no_other(language: str) -> None:
    texts = written_in(language)
    assert sorted(ENGLISH.texts.keys() - texts.keys()) == []
    assert sorted(texts.keys() - ENGLISH.texts.keys()) == []


@pytest.mark.parametrize("language", languages())
def test_every_text_has_the_places_of_the_english_one(language: str) -> None:
    texts = catalogue(language).texts
    for key, english in ENGLISH.texts.items():
        expected, found = places_of(english), texts[key]
        assert places_of(found) == expected, key
        for category, sentence in {} if isinstance(found, str) else found.items():
            lacking = expected - places(sentence)
            assert places(sentence) <= expected, (key, category)
            assert lacking <= ({"count"} if category in NAMED_IN_WORDS else set()), (key, category)


@pytest.mark.parametrize("language", languages())
def test_a_text_with_a_number_has_every_plural_form_of_its_language(language: str) -> None:
    found = catalogue(language)
    forms = found.tongue.locale.plural_form.tags | {"other"}
    for key, text in found.texts.items():
        assert isinstance(text, str) == isinstance(ENGLISH.texts[key], str), key
        if not isinstance(text, str):
            assert set(text) == forms, key


@pytest.mark.parametrize("language", languages())
def test_texts_are_sentences_and_no_code(language: str) -> None:
    for key, text in catalogue(language).texts.items():
        for sentence in [text] if isinstance(text, str) else text.values():
            assert sentence == sentence.strip(), key
            assert not set("<>&") & set(sentence), key


@pytest.mark.parametrize(
    ("language", "count", "said"),
    [
        ("en", 1, "1 question is still open."),
        ("en", 2, "2 questions are still open."),
        ("ar", 1, "بقي سؤال واحد بلا إجابة."),
        ("ar", 2, "بقي سؤالان بلا إجابة."),
        ("ar", 3, "بقيت 3 أسئلة بلا إجابة."),
        ("ar", 11, "بقي 11 سؤالًا بلا إجابة."),
        ("ar", 100, "بقي 100 سؤال بلا إجابة."),
    ],
)
def test_a_number_chooses_the_form_of_its_language(language: str, count: int, said: str) -> None:
    assert catalogue(language).text("scripts.trial.open_questions", count=count) == said


def test_values_are_escaped_on_a_page_and_links_are_not() -> None:
    hostile = ENGLISH.markup("frame.contact", name="<b>{x}</b>")
    assert hostile == "Questions? Please ask &lt;b&gt;{x}&lt;/b&gt;"
    link = ENGLISH.markup("landing.someone_else", link=Markup('<a href="/next">x</a>'))
    assert link.endswith('<a href="/next">x</a>.')


@pytest.mark.parametrize(("key", "values"), [("no.such", {}), ("trial.clip_number", {"number": 1})])
def test_an_unknown_key_or_a_place_left_empty_is_an_error(
    key: str, values: dict[str, object]
) -> None:
    with pytest.raises(KeyError):
        ENGLISH.text(key, **values)


def test_a_count_that_is_no_number_is_an_error() -> None:
    with pytest.raises(TypeError, match=r"landing\.minutes: count is a number, not 'ten'"):
        ENGLISH.text("landing.minutes", count="ten")


def test_a_language_without_texts_is_served_in_english() -> None:
    assert catalogue("xx").tongue.language == "en"


def test_scripts_get_the_texts_of_their_page_alone() -> None:
    assert {key.partition(".")[0] for key in ENGLISH.of_scripts("trial")} == {"all", "trial"}
    assert {key.partition(".")[0] for key in ENGLISH.of_scripts("landing")} == {"all"}


@pytest.mark.parametrize(
    ("language", "direction", "name"),
    [("en", "ltr", "English"), ("ar", "rtl", "العربية"), ("de", "ltr", "Deutsch")],
)
def test_a_language_knows_its_direction_and_its_own_name(
    language: str, direction: str, name: str
) -> None:
    assert (tongue(language).direction, tongue(language).name) == (direction, name)


def test_an_unknown_language_keeps_its_tag_and_runs_left_to_right() -> None:
    assert (tongue("klingon").language, tongue("klingon").direction) == ("klingon", "ltr")


@pytest.mark.parametrize(
    ("wishes", "found"),
    [
        (["ar-EG", "en"], "ar"),
        (["fr", "AR"], "ar"),
        (["pt-BR"], "pt-br"),
        (["pt-BR-x-any"], "pt-br"),
        (["pt"], None),
        ([], None),
    ],
)
def test_a_wish_is_served_by_its_language_or_a_wider_one(
    wishes: list[str], found: str | None
) -> None:
    assert first_spoken(wishes, ("en", "ar", "pt-br")) == found


@pytest.mark.parametrize(
    ("header", "wishes"),
    [
        ("ar-EG,ar;q=0.9,en;q=0.5", ["ar-EG", "ar", "en"]),
        ("en;q=0.5, ar", ["ar", "en"]),
        ("*", []),
        ("de;q=0, en", ["en"]),
        ("en;q=x, ar;;", []),
        ("", []),
    ],
)
def test_the_browsers_preference_is_read_best_first(header: str, wishes: list[str]) -> None:
    assert wished_in_header(header) == wishes


def test_numbers_are_written_in_european_digits_without_marks() -> None:
    assert catalogue("ar").tongue.number(12345) == "12345"
    assert tongue("de").number(2.5) == "2,5"


def test_every_file_of_texts_is_a_language(tmp_path: Path) -> None:
    del tmp_path
    assert set(CATEGORIES) >= {
        tag for one in languages() for tag in tongue(one).locale.plural_form.tags
    }
