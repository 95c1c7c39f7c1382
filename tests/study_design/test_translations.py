"""A study in other languages: every text in its place, nothing else changed."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest

from study.cli import main
from study.design.definition import (
    DefinitionError,
    StudyDefinition,
    built_in_names,
    parse_definition,
    read_definition,
)
from study.design.translation_file import translation_lines
from study.design.translations import texts_of, translated, translation_faults

ROWS = [{"id": "iris", "label": "Iris"}, {"id": "white", "label": "White"}]
MATRIX = {
    "id": "real",
    "kind": "matrix",
    "text": "How real?",
    "labels": list("abcde"),
    "rows": ROWS,
}


def words_of(definition: StudyDefinition) -> dict[str, Any]:
    """Return a translation that turns every text into capitals."""
    words: dict[str, Any] = {}
    for place, found in texts_of(definition):
        *inner, last = place.split(".")
        table = words
        for key in inner:
            table = table.setdefault(key, {})
        if found.words:
            table[last] = found.words.upper()
    return words


def messages(raw: dict[str, Any]) -> list[str]:
    with pytest.raises(DefinitionError) as caught:
        parse_definition(raw)
    return [str(fault) for fault in caught.value.faults]


@pytest.fixture
def bilingual(raw: dict[str, Any]) -> dict[str, Any]:
    raw["questions"].append(MATRIX)
    return raw | {"translations": {"de": words_of(parse_definition(raw))}}


def test_a_study_in_another_language_differs_in_its_words_alone(bilingual: dict[str, Any]) -> None:
    source = parse_definition(bilingual)
    german = source.in_language("de")
    assert source.languages == ("en", "de")
    assert german.language == "de"
    changed = dict(texts_of(german))
    for place, found in texts_of(source):
        assert changed[place].words == found.words.upper(), place
    assert [q.id for q in german.questions] == [q.id for q in source.questions]
    assert german.trial_clips == source.trial_clips


def test_a_language_that_a_study_lacks_gets_the_study_as_it_is(raw: dict[str, Any]) -> None:
    definition = parse_definition(raw)
    assert definition.in_language("fr") is definition


def test_everything_that_is_read_is_found_by_id_or_value(raw: dict[str, Any]) -> None:
    raw["questions"].append(MATRIX)
    places = dict(texts_of(parse_definition(raw)))
    assert places["questions.noticed.options.yes"].words == "yes"
    assert places["questions.real.rows.iris"].words == "Iris"
    assert places["questions.real.labels.4"].words == "e"
    assert not places["contact.name"].is_needed
    assert not any(place.endswith((".id", ".value", "version", "key")) for place in places)


def test_missing_and_unknown_texts_are_told_at_once(bilingual: dict[str, Any]) -> None:
    words = bilingual["translations"]["de"]
    del words["consent"]["title"]
    words["questions"]["noticed"]["options"]["yess"] = words["questions"]["noticed"]["options"].pop(
        "yes"
    )
    words["title"] = ""
    found = messages(bilingual)
    assert "translations.de.title: expected text in quotes; found ''" in found
    assert any(
        line.startswith("translations.de.consent.title: missing; the study has ") for line in found
    )
    assert (
        "translations.de.questions.noticed.options.yess: no text of the study; did you mean "
        '"questions.noticed.options.yes"?'
    ) in found
    assert 'translations.de.questions.noticed.options.yes: missing; the study has "yes"' in found


def test_a_study_is_not_translated_into_its_own_language(bilingual: dict[str, Any]) -> None:
    bilingual["translations"]["en"] = {}
    assert "translations.en: this is the study's own language" in messages(bilingual)


def test_a_name_may_stay_as_it_is(bilingual: dict[str, Any]) -> None:
    del bilingual["translations"]["de"]["contact"]
    german = parse_definition(bilingual).in_language("de")
    assert german.contact == parse_definition(bilingual).contact


def test_a_file_beside_the_study_holds_its_translation(tmp_path: Path) -> None:
    folder = Path(__file__).parents[2] / "study" / "design" / "definitions"
    for name in ("thesis.toml", "thesis.ar.toml"):
        (tmp_path / name).write_bytes((folder / name).read_bytes())
    assert read_definition(tmp_path / "thesis.toml").in_language("ar").title == (
        "ما مدى واقعية هذه العيون؟"
    )
    (tmp_path / "thesis.ar.toml").write_text("title = ", encoding="utf-8")
    with pytest.raises(DefinitionError, match=r"translations\.0: .*thesis\.ar\.toml: not a TOML"):
        read_definition(tmp_path / "thesis.toml")
    (tmp_path / "thesis.ar.toml").unlink()
    with pytest.raises(DefinitionError, match=r"translations\.0: .*thesis\.ar\.toml: No such file"):
        read_definition(tmp_path / "thesis.toml")


@pytest.mark.parametrize("name", built_in_names())
def test_every_built_in_study_speaks_arabic(name: str) -> None:
    definition = read_definition(name)
    assert definition.languages == ("en", "ar")
    arabic = {place: found.words for place, found in texts_of(definition.in_language("ar"))}
    left = [p for p, found in texts_of(definition) if found.words and arabic[p] == found.words]
    assert left == []


def test_a_translation_tells_a_study_from_the_one_without(bilingual: dict[str, Any]) -> None:
    source = {key: value for key, value in bilingual.items() if key != "translations"}
    silent = parse_definition(source | {"translations": {}})
    assert silent.definition_hash == parse_definition(source).definition_hash
    assert parse_definition(bilingual).definition_hash != silent.definition_hash


@pytest.mark.parametrize("name", built_in_names())
def test_the_file_to_translate_holds_every_text_and_nothing_else(name: str) -> None:
    definition = read_definition(name)
    for language in ("fr", "ar"):
        written = tomllib.loads("\n".join(translation_lines(definition, language)))
        assert list(translation_faults(definition, written, "fr")) == []
        french = translated(definition, written, "fr")
        expected = definition.in_language(language)
        assert {p: t.words for p, t in texts_of(french)} == {
            p: t.words for p, t in texts_of(expected)
        }


def test_the_file_to_translate_quotes_what_has_to_be_quoted(raw: dict[str, Any]) -> None:
    raw["title"] = 'Say "eye" \\ now\nand\tthen'
    raw["questions"].append(MATRIX)
    definition = parse_definition(raw)
    written = tomllib.loads("\n".join(translation_lines(definition, "de")))
    assert written["title"] == raw["title"]
    assert written["questions"]["real"]["labels"] == list("abcde")


def test_check_writes_the_file_to_translate(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "thesis", "--translation", "ar"]) == 0
    written = tomllib.loads(capsys.readouterr().out)
    assert written["thanks"]["title"] == "شكرًا لك"


def test_check_writes_it_although_the_study_names_it_already(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = Path(__file__).parents[2] / "study" / "design" / "definitions"
    text = (folder / "thesis.toml").read_text(encoding="utf-8")
    file = tmp_path / "mine.toml"
    file.write_text(
        text.replace('translations = ["ar"]', 'translations = ["fr"]'), encoding="utf-8"
    )
    beside = tmp_path / "mine.fr.toml"
    with pytest.raises(DefinitionError, match=rf"ocularist check {file} --translation fr writes"):
        read_definition(file)
    beside.touch()  # as a shell does before it starts the command
    assert main(["check", str(file), "--translation", "fr"]) == 0
    beside.write_text(capsys.readouterr().out, encoding="utf-8")
    assert read_definition(file).in_language("fr").title == "How real do these eyes look?"
