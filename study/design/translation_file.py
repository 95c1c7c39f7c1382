"""A file to translate: every text of a study in its place, in the study's own words.

Whoever translates replaces the words and leaves the rest. Pure.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any, Final

from study.design.definition import StudyDefinition
from study.design.translations import texts_of

Tree = Mapping[str, Any]
_BARE_KEY: Final = re.compile(r"[A-Za-z0-9_-]+")


def translation_lines(definition: StudyDefinition, language: str) -> Iterator[str]:
    """Yield the lines of a TOML file for one language: its words so far, else the study's own."""
    words = dict(texts_of(definition.in_language(language)))
    tree: dict[str, Any] = {}
    for place, found in texts_of(definition):
        if found.words:
            *inner, last = place.split(".")
            table = tree
            for key in inner:
                table = table.setdefault(key, {})
            table[last] = words[place].words
    yield f"# The words of the study {definition.key} in {language}."
    yield ""
    yield from _table(tree, "")


def _table(tree: Tree, place: str) -> Iterator[str]:
    """Yield what stands in a table: its own texts, then the tables within it."""
    for key, found in tree.items():
        if isinstance(found, str):
            yield f"{_key(key)} = {_quoted(found)}"
        elif _is_list(found) and all(isinstance(words, str) for words in found.values()):
            yield f"{_key(key)} = [{', '.join(map(_quoted, found.values()))}]"
    for key, found in tree.items():
        here = f"{place}.{_key(key)}" if place else _key(key)
        if isinstance(found, str):
            continue
        if not _is_list(found):
            if any(isinstance(inner, str) or _is_list(inner) for inner in found.values()):
                yield from ("", f"[{here}]")
            yield from _table(found, here)
        elif not all(isinstance(words, str) for words in found.values()):
            for entry in found.values():
                yield from ("", f"[[{here}]]")
                yield from _table(entry, here)


def _is_list(tree: Tree) -> bool:
    return list(tree) == [str(index) for index in range(len(tree))]


def _key(name: str) -> str:
    return name if _BARE_KEY.fullmatch(name) else _quoted(name)


def _quoted(words: str) -> str:
    return json.dumps(words, ensure_ascii=False)  # TOML quotes as JSON does
