"""The catalogue: every text of the participant's pages by its key, in one language.

A text is a sentence with named places, ``"Clip {number} of {total}"``, or a table of such sentences
by CLDR's plural categories, of which ``count`` chooses one. Keys are the tables of the file:
``trial.heading``. Texts below ``scripts`` are for the scripts: ``scripts.NAME.key`` belongs to the
page NAME, ``scripts.all.key`` to every page.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from importlib import resources
from typing import Any, Final

from markupsafe import Markup, escape

from study.texts.languages import FALLBACK, Tongue, tongue

CATEGORIES: Final = ("zero", "one", "two", "few", "many", "other")
SCRIPTS: Final = "scripts"
Text = str | Mapping[str, str]


@dataclass(frozen=True)
class Catalogue:
    """The texts of one language, by key."""

    tongue: Tongue
    texts: Mapping[str, Text]
    _plain: dict[str, Markup] = field(default_factory=dict, compare=False)
    _of_scripts: dict[str, dict[str, Text]] = field(default_factory=dict, compare=False)

    def text(self, key: str, /, **values: object) -> str:
        """Return a text with its places filled; raises KeyError for a key or place unknown."""
        return self._sentence(key, values).format(**self._written(values))

    def markup(self, key: str, /, **values: object) -> Markup:
        """Return a text for a page: it and its values are escaped, but for those marked safe."""
        if not values and key in self._plain:
            return self._plain[key]
        sentence = escape(self._sentence(key, values))
        said = sentence.format(**self._written(values))
        if not values:
            self._plain[key] = said
        return said

    def _sentence(self, key: str, values: Mapping[str, object]) -> str:
        found = self.texts[key]
        if isinstance(found, str):
            return found
        count = values["count"]
        if not isinstance(count, int | float):
            raise TypeError(f"{key}: count is a number, not {count!r}")
        return found.get(self.tongue.category(count), found["other"])

    def _written(self, values: Mapping[str, object]) -> dict[str, object]:
        """Write numbers as the language does; all else stays."""
        return {
            name: self.tongue.number(value) if isinstance(value, int | float) else value
            for name, value in values.items()
        }

    def of_scripts(self, page: str) -> dict[str, Text]:
        """Return what the scripts of a page say: ``all.*`` and the page's own."""
        if page not in self._of_scripts:
            self._of_scripts[page] = {
                key.removeprefix(f"{SCRIPTS}."): found
                for key, found in self.texts.items()
                if key.startswith((f"{SCRIPTS}.all.", f"{SCRIPTS}.{page}."))
            }
        return self._of_scripts[page]


@lru_cache(maxsize=64)
def catalogue(language: str) -> Catalogue:
    """Return the texts of a language, or those of English where there is no file for it.

    The catalogue's tongue says which language its texts are in. A text that is not translated yet
    is there in English: a page half in another language is better than none.
    """
    known = language if language in languages() else FALLBACK
    return Catalogue(tongue(known), {**written_in(FALLBACK), **written_in(known)})


def written_in(language: str) -> dict[str, Text]:
    """Return the texts of one language's file, by key."""
    return dict(_flat(_read(language)))


@lru_cache(maxsize=1)
def languages() -> tuple[str, ...]:
    """Return the languages that there are texts in, English first."""
    names = (entry.name for entry in resources.files("study.texts").iterdir())
    found = {name.removesuffix(".toml") for name in names if name.endswith(".toml")}
    return (FALLBACK, *sorted(found - {FALLBACK}))


def _read(language: str) -> Mapping[str, Any]:
    source = resources.files("study.texts") / f"{language}.toml"
    return tomllib.loads(source.read_text(encoding="utf-8"))


def _flat(table: Mapping[str, Any], place: str = "") -> Iterator[tuple[str, Text]]:
    """Yield key and text of every leaf; a table of plural categories is one."""
    for name, found in table.items():
        key = f"{place}.{name}" if place else name
        if isinstance(found, Mapping) and not (found and found.keys() <= set(CATEGORIES)):
            yield from _flat(found, key)
        else:
            yield key, found
