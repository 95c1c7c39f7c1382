"""The words of a study in other languages: which texts there are, and what is missing.

A translation mirrors the study file: a text stands where it stands there, but a question, an
option or another table of a list is found by its id or value. Whatever a study's models mark with
``parts.Text`` is a text that participants read, and needs its translation.
"""

from __future__ import annotations

import tomllib
import types
import typing
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from pydantic.fields import FieldInfo

from study.design.faults import Fault, suggestion
from study.design.parts import Part, Translated
from study.design.question_kinds import Labelled
from study.design.raw import Data

Words = Mapping[str, Any]
APart = TypeVar("APart", bound=Part)


@dataclass(frozen=True)
class Found:
    """One text of a study: its words, and whether they must be translated."""

    words: str
    is_needed: bool


def texts_of(part: Part, place: str = "") -> Iterator[tuple[str, Found]]:
    """Yield place and words of everything in a study that participants read."""
    for name, field in type(part).model_fields.items():
        value, here = getattr(part, name), _place(part, name, place)
        mark = _mark(field)
        if mark is not None and isinstance(value, str):
            yield here, Found(value, mark.is_needed)
        elif mark is not None and isinstance(value, tuple):
            for index, words in enumerate(value):
                yield f"{here}.{index}", Found(words, mark.is_needed)
        else:
            for key, inner in _parts_within(value):
                yield from texts_of(inner, f"{here}.{key}." if key else f"{here}.")


def _parts_within(value: object) -> Iterator[tuple[str, Part]]:
    """Yield the tables that a field holds, by what a translation calls them."""
    if isinstance(value, Part):
        yield "", value
    elif isinstance(value, Mapping):
        yield from ((key, part) for key, part in value.items() if isinstance(part, Part))
    elif isinstance(value, tuple):
        for index, part in enumerate(value):
            if isinstance(part, Part):
                yield _name_of(part, index), part


def _name_of(part: Part, index: int) -> str:
    """Return what a translation calls a table of a list: id, value, or where it stands."""
    return str(getattr(part, "id", None) or getattr(part, "value", index))


def _place(part: Part, name: str, place: str) -> str:
    """Return where a text stands; an option is its label: ``options = { yes = "Oui" }``."""
    return place.removesuffix(".") if isinstance(part, Labelled) else f"{place}{name}"


def _mark(field: FieldInfo) -> Translated | None:
    """Return the mark of ``Text``, ``Text | None`` and ``tuple[Text, ...]``, None for others."""
    for mark in field.metadata:
        if isinstance(mark, Translated):
            return mark
    inner = field.annotation
    if typing.get_origin(inner) in (typing.Union, types.UnionType):
        kept = [one for one in typing.get_args(inner) if one is not types.NoneType]
        inner = kept[0] if len(kept) == 1 else None
    elif typing.get_origin(inner) is tuple:
        inner = typing.get_args(inner)[0]
    marks = typing.get_args(inner)[1:] if typing.get_origin(inner) is typing.Annotated else ()
    return next((mark for mark in marks if isinstance(mark, Translated)), None)


def find_translations(data: Data, path: Path) -> tuple[dict[str, Any], list[Fault]]:
    """Put the files' contents in the place of ``translations = ["ar"]``: lod.ar.toml by lod.toml.

    Returns the study's data and the faults of files that could not be read.
    """
    named = data.get("translations")
    if not isinstance(named, list):
        return dict(data), []
    found: dict[str, Any] = {}
    faults: list[Fault] = []
    for index, language in enumerate(named):
        beside = path.with_name(f"{path.stem}.{language}.toml")
        try:
            found[str(language)] = tomllib.loads(beside.read_text(encoding="utf-8-sig"))
        except OSError as error:
            hint = f"ocularist check {path} --translation {language} writes one to fill in"
            faults.append(Fault(f"translations.{index}", f"{beside}: {error.strerror}; {hint}"))
        except ValueError as error:
            faults.append(Fault(f"translations.{index}", f"{beside}: not a TOML file: {error}"))
    return {**data, "translations": found}, faults


def translation_faults(study: Part, words: Words, place: str) -> Iterator[Fault]:
    """Yield what a translation lacks, and what it holds that the study does not."""
    expected = dict(texts_of(study))
    given = dict(_flat(words))
    for key, found in given.items():
        if key not in expected:
            yield Fault(f"{place}.{key}", f"no text of the study{suggestion(key, expected)}")
        elif not isinstance(found, str) or not found.strip():
            yield Fault(f"{place}.{key}", f"expected text in quotes; found {found!r}")
    for key, text in expected.items():
        if text.is_needed and text.words and key not in given:
            yield Fault(f"{place}.{key}", f"missing; the study has {_short(text.words)}")


def _short(words: str) -> str:
    return f'"{words}"' if len(words) <= 60 else f'"{words[:57]}..."'


def _flat(words: object, place: str = "") -> Iterator[tuple[str, object]]:
    """Yield place and words of every text of a translation."""
    if isinstance(words, Mapping):
        entries = [(str(key), inner) for key, inner in words.items()]
    elif isinstance(words, list | tuple):
        entries = [(str(index), inner) for index, inner in enumerate(words)]
    else:
        yield place, words
        return
    for key, inner in entries:
        yield from _flat(inner, f"{place}.{key}" if place else key)


def translated(study: APart, words: Words, language: str) -> APart:
    """Return a study with the words of a translation; what has none keeps its own."""
    given = {key: found for key, found in _flat(words) if isinstance(found, str)}
    return _with_words(study, given, "").model_copy(update={"language": language})


def _with_words(part: APart, given: Mapping[str, str], place: str) -> APart:
    changed: dict[str, Any] = {}
    for name, field in type(part).model_fields.items():
        value, here = getattr(part, name), _place(part, name, place)
        if _mark(field) is not None and isinstance(value, str):
            changed[name] = given.get(here, value)
        elif _mark(field) is not None and isinstance(value, tuple):
            changed[name] = tuple(given.get(f"{here}.{i}", own) for i, own in enumerate(value))
        elif isinstance(value, Part):
            changed[name] = _with_words(value, given, f"{here}.")
        elif isinstance(value, Mapping):
            parts = _parts_within(value)
            within = {key: _with_words(inner, given, f"{here}.{key}.") for key, inner in parts}
            changed[name] = {**value, **within}
        elif isinstance(value, tuple):
            changed[name] = tuple(
                _with_words(inner, given, f"{here}.{_name_of(inner, index)}.")
                if isinstance(inner, Part)
                else inner
                for index, inner in enumerate(value)
            )
    return part.model_copy(update=changed)
