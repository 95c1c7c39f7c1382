"""Languages: which way they run, what they call themselves, which one a reader wishes for.

A language is named by its BCP 47 tag in lower case: "en", "ar", "pt-br". Plural rules and names are
those of the Unicode CLDR, by way of Babel.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

from babel import Locale, UnknownLocaleError
from babel.numbers import format_decimal

FALLBACK: Final = "en"
# More wishes than this is no reader's browser.
MOST_WISHES: Final = 20


@dataclass(frozen=True)
class Tongue:
    """One language: its tag, its direction ("ltr" or "rtl") and its name in itself."""

    language: str
    direction: str
    name: str
    locale: Locale

    def category(self, count: float) -> str:
        """Return CLDR's plural category of a number: zero, one, two, few, many or other."""
        return str(self.locale.plural_form(count))

    def number(self, value: float) -> str:
        """Write a number as the language does, in European digits, without thousands marks.

        Codes, clocks and number fields show European digits in every language; one page should not
        mix two sets.
        """
        return _number(self.locale, value)


@lru_cache(maxsize=4096, typed=True)
def _number(locale: Locale, value: float) -> str:
    return str(format_decimal(value, locale=locale, group_separator=False, numbering_system="latn"))


@lru_cache(maxsize=64)
def tongue(language: str) -> Tongue:
    """Return a language; one that CLDR does not know is treated like English under its own tag."""
    try:
        locale = Locale.parse(language, sep="-")
    except (ValueError, UnknownLocaleError):
        locale = Locale.parse(FALLBACK)
    name = str(locale.get_display_name(locale) or language)
    return Tongue(language, locale.text_direction, name[:1].upper() + name[1:], locale)


def first_spoken(wishes: Iterable[str], spoken: Sequence[str]) -> str | None:
    """Return the first wish that is spoken, if only as a wider one (RFC 4647, 3.4).

    "ar-EG" is served by "ar".
    """
    for wish in wishes:
        tag = wish.strip().lower()
        while tag:
            if tag in spoken:
                return tag
            tag = tag.rpartition("-")[0]
    return None


def wished_in_header(accept_language: str) -> list[str]:
    """Return the tags of an Accept-Language header, best first (RFC 9110, 12.5.4).

    What cannot be read is left out, and "*" wishes for nothing in particular.
    """
    wishes: list[tuple[float, str]] = []
    for part in accept_language.split(",")[:MOST_WISHES]:
        tag, _, rest = part.strip().partition(";")
        try:
            quality = float(rest.strip().removeprefix("q=")) if rest else 1.0
        except ValueError:
            continue
        if tag and tag != "*" and 0 < quality <= 1:
            wishes.append((quality, tag.strip()))
    return [tag for _, tag in sorted(wishes, key=lambda wish: -wish[0])]
