"""What charts do with the names in a study's tables: which they shorten, in which fonts."""

from __future__ import annotations

from typing import Final

from analysis.charts.fonts import Fonts, fonts_for
from analysis.charts.long_names import LONGEST, shortened
from analysis.tables.reading import Tables

_NAMES: Final = ("distance", "lod", "other_lod", "left_lod", "right_lod", "clip", "participant")


def names_in(tables: Tables) -> set[str]:
    """Return every name that a chart may show."""
    return {
        str(name)
        for table in (tables.ratings, tables.comparisons)
        for column in _NAMES
        if column in table
        for name in table[column].dropna().unique()
    }


def short_names(tables: Tables) -> dict[str, str]:
    """Return what charts write for names that are too long for them."""
    return shortened(names_in(tables))


def fonts_of(tables: Tables) -> Fonts:
    """Return the fonts for the names in these tables."""
    return fonts_for(names_in(tables))


def chart_notes(tables: Tables) -> list[str]:
    """Say in sentences what a reader of the charts must know about their names."""
    told = [fonts_of(tables).sentence()]
    if short_names(tables):
        told.append(f"Charts shorten names of more than {LONGEST} letters; tables have them whole.")
    return [sentence for sentence in told if sentence]
