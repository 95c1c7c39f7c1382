"""What charts do with the names in a study's tables: which they shorten, in which fonts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from analysis.charts.fonts import Fonts, fonts_for
from analysis.charts.long_names import LONGEST, LONGEST_CLIP, shortened
from analysis.tables.reading import Tables

_NAMES: Final = ("distance", "lod", "other_lod", "left_lod", "right_lod", "participant")
_CLIPS: Final = ("clip",)


def names_in(tables: Tables, columns: Sequence[str] = (*_NAMES, *_CLIPS)) -> set[str]:
    """Return every name that a chart may show."""
    return {
        str(name)
        for table in (tables.ratings, tables.comparisons)
        for column in columns
        if column in table
        for name in table[column].dropna().unique()
    }


def short_names(tables: Tables) -> dict[str, str]:
    """Return what charts write for names that are too long for them."""
    clips = shortened(names_in(tables, _CLIPS), longest=LONGEST_CLIP)
    return clips | shortened(names_in(tables, _NAMES))


def fonts_of(tables: Tables) -> Fonts:
    """Return the fonts for the names in these tables."""
    return fonts_for(names_in(tables))


def chart_notes(tables: Tables) -> list[str]:
    """Say in sentences what a reader of the charts must know about their names."""
    told = [fonts_of(tables).sentence()]
    if short_names(tables):
        told.append(
            f"Charts shorten names of more than {LONGEST} letters (of clips, {LONGEST_CLIP}); "
            "tables have them whole."
        )
    return [sentence for sentence in told if sentence]
