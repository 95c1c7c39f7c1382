"""Fonts for names in any script: the charts' own, and whatever this system has for the rest.

DejaVu Sans comes with matplotlib and has Latin, Greek, Cyrillic, Arabic and more, but no Chinese,
Japanese, Korean, Thai or emoji. Nothing is fetched: what no font here has is told in a sentence.
"""

from __future__ import annotations

import unicodedata
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from typing import Final

import matplotlib as mpl
from matplotlib.font_manager import fontManager, get_font

_OWN: Final = "DejaVu Sans"
_PLACEHOLDERS: Final = "Last Resort"  # has a box for every character
_MOST_TOLD: Final = 12


@dataclass(frozen=True)
class Fonts:
    """The families that draw what the charts' own font lacks, and what none of them has."""

    families: tuple[str, ...] = ()
    missing: str = ""

    def sentence(self) -> str:
        """Say which characters stand as boxes in charts; empty if none do."""
        if not self.missing:
            return ""
        told = " ".join(self.missing[:_MOST_TOLD])
        more = " and others" if len(self.missing) > _MOST_TOLD else ""
        return (
            f"Charts show boxes for {told}{more}, which no font on this computer has. Install one "
            "that does, such as Noto Sans or Noto Sans CJK, and analyse again; tables have the "
            "names as they are."
        )


def fonts_for(names: Iterable[str]) -> Fonts:
    """Return what draws these names; looks at the system's fonts only for what ours lacks."""
    characters = {character for name in names for character in name if _is_drawn(character)}
    return _chosen(frozenset(map(ord, characters)) - _covered(_path(_OWN)))


@contextmanager
def used(fonts: Fonts) -> Iterator[None]:
    """Draw with these fonts meanwhile, and without a warning for each missing character."""
    family = [*mpl.rcParams["font.family"], *fonts.families]
    with warnings.catch_warnings(), mpl.rc_context({"font.family": family}):
        warnings.filterwarnings("ignore", r"Glyph \d+ .* missing from font", UserWarning)
        yield


def _is_drawn(character: str) -> bool:
    """Say whether a character has a shape; spaces, joiners and selectors of variants have none."""
    return unicodedata.category(character)[0] not in "ZC" and not 0xFE00 <= ord(character) <= 0xFE0F


@cache
def _chosen(wanted: frozenset[int]) -> Fonts:
    """Choose families one by one, each the one that has most of what is still missing."""
    open_ones, families = set(wanted), []
    while open_ones:
        best = max(_paths(), key=lambda name: _usefulness(name, open_ones))
        gained = open_ones & _covered(_paths()[best])
        if not gained:
            break
        families.append(best)
        open_ones -= gained
    return Fonts(tuple(families), "".join(map(chr, sorted(open_ones))))


def _usefulness(name: str, wanted: set[int]) -> tuple[int, bool, str]:
    # Of equals one without serifs, as ours; then by name, so that it is always the same.
    return len(wanted & _covered(_paths()[name])), "Sans" in name, name


@cache
def _paths() -> dict[str, str]:
    """Return the file of each family that this system has, the upright one of normal weight."""
    entries = sorted(
        fontManager.ttflist,
        key=lambda own: (own.style != "normal", own.weight not in (400, "normal"), own.fname),
    )
    found: dict[str, str] = {}
    for entry in entries:
        if not entry.name.startswith(_PLACEHOLDERS):
            found.setdefault(entry.name, str(entry.fname))
    return found


def _path(name: str) -> str:
    return _paths()[name]


@cache
def _covered(path: str) -> frozenset[int]:
    """Return the characters that a font file has; none for a file that cannot be used."""
    try:
        return frozenset(get_font(path).get_charmap())
    except (OSError, RuntimeError):
        return frozenset()
