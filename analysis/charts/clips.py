"""The thesis's Figure 5.2 anew: mean realism of each eye of each clip, by distance.

Every person's rating is a dot, the mean carries its t interval, and n stands above it.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase

from analysis.charts.parts import clip_label, distance_label, draw_mean, lod_legend, upright_in
from analysis.charts.style import (
    INK,
    NO_RATINGS,
    NORMAL,
    PAGE_WIDTH_IN,
    QUIET,
    SMALL,
    beeswarm,
    lod_colour,
    message_figure,
    new_figure,
    rating_axis,
    tidy,
)
from analysis.descriptive.means import mean_ratings, person_means
from analysis.descriptive.shares import PAIRED, clips_or_pairings
from analysis.tables.ordering import lod_order
from analysis.tables.reading import Tables
from analysis.tables.records import records

TITLE: Final = "Perceived realism of each eye, per clip"
_CLIPS_PER_ROW: Final = 10
_SLOT_IN: Final = 0.6  # width of one eye's column where there is room
_UPRIGHT_IN: Final = 0.5  # below this width names of columns stand upright
_UPRIGHT_PT: Final = 62.0  # what short names take that stand upright
_ROW_IN: Final = 2.9
_MOST_IN: Final = 8.2  # all rows together: a page with its caption
_LEAST_IN: Final = 1.35  # a row that can be read; many distances take more than a page
_GAP: Final = 0.5  # between clips, in columns
_MOST_DOTS: Final = 80  # with more people the area of one dot per rating shows their share
_KEYS: Final = ["distance", "clip", "eye", "lod"]


def eye_means(tables: Tables) -> pd.DataFrame:
    """Return the mean rating of each eye of each clip (or pairing, where there are many clips)."""
    return mean_ratings(clips_or_pairings(tables.ratings), _KEYS)


def realism_per_clip(tables: Tables) -> Figure:
    """Draw mean realism per clip and eye, grouped by distance, coloured by LoD."""
    means = eye_means(tables)
    if means.empty:
        return message_figure(TITLE, NO_RATINGS, is_simulated=tables.is_simulated)
    people = person_means(clips_or_pairings(tables.ratings), _KEYS)
    lods = lod_order(tables.ratings)
    rows = _rows_of_panels(means)
    widest = max(sum(_columns(panel) for panel in row) for row in rows)
    width = min(PAGE_WIDTH_IN, max(5.5, 0.9 + _SLOT_IN * widest))
    is_narrow = (width - 0.9) / widest < max(_UPRIGHT_IN, upright_in(set(means["lod"])))
    below = upright_in(lods) if is_narrow else 0.0
    height = max(_LEAST_IN + below, min(_ROW_IN + below, _MOST_IN / len(rows)))
    figure = new_figure(width, 1.0 + height * len(rows), TITLE, is_simulated=tables.is_simulated)
    for band, row in zip(_bands(figure, len(rows)), rows, strict=True):
        # A row with fewer clips is filled up, so that columns are equally wide in all rows.
        spare = widest - sum(_columns(panel) for panel in row)
        widths = [_columns(panel) for panel in row] + ([spare] if spare > 0.5 else [])
        panels = band.subplots(1, len(widths), squeeze=False, sharey=True, width_ratios=widths)[0]
        for place, (axes, panel) in enumerate(zip(panels, row, strict=False)):
            _draw_clips(axes, panel, people, lods, is_narrow=is_narrow)
            rating_axis(axes, tables.scale, is_labelled=place == 0, is_short=len(rows) > 2)
            axes.set_title(
                distance_label(str(panel["distance"].iloc[0]), tables), fontsize=NORMAL, color=INK
            )
        for axes in panels[len(row) :]:
            axes.set_visible(False)
    lod_legend(figure, [lod for lod in lods if lod in set(means["lod"])], lods)
    return figure


def _bands(figure: Figure, count: int) -> Sequence[FigureBase]:
    if count == 1:
        return [figure]
    return [band for row in figure.subfigures(count, 1, squeeze=False) for band in row]


def _columns(panel: pd.DataFrame) -> float:
    return len(panel) + _GAP * panel["clip"].nunique() + 0.3


def _rows_of_panels(means: pd.DataFrame) -> list[list[pd.DataFrame]]:
    """Cut the clips into panels of one distance each, and the panels into rows."""
    by_distance = [own for _, own in means.groupby("distance", sort=False)]
    if len(means[["distance", "clip"]].drop_duplicates()) <= _CLIPS_PER_ROW:
        return [by_distance]
    rows = []
    for own in by_distance:
        clips = np.array(list(dict.fromkeys(own["clip"])), dtype=object)
        for part in np.array_split(clips, -(-clips.size // _CLIPS_PER_ROW)):
            rows.append([own[own["clip"].isin(part)]])
    return rows


def _draw_clips(
    axes: Axes,
    panel: pd.DataFrame,
    people: pd.DataFrame,
    lods: Sequence[str],
    *,
    is_narrow: bool,
) -> None:
    tidy(axes)
    places: list[float] = []
    names: list[str] = []
    x = 0.0
    for clip, own in panel.groupby("clip", sort=False):
        for offset, row in enumerate(records(own)):
            _draw_eye(axes, x + offset, row, _ratings_of(row, people), lods)
            count = f"{row['people']}" if is_narrow and places else f"n = {row['people']}"
            _write_count(axes, x + offset, count, is_first=is_narrow and not places)
            places.append(x + offset)
            joint = " " if is_narrow else "\n"
            names.append(row["lod"] if pd.isna(row["eye"]) else f"{row['eye']}{joint}{row['lod']}")
        if own["eye"].notna().any() and PAIRED not in str(clip):
            upright = [f"right {lod}" for lod in own["lod"]] if is_narrow else []
            _name_clip(axes, x + (len(own) - 1) / 2, clip_label(str(clip)), upright=upright)
        x += len(own) + _GAP
    axes.set_xticks(places, names, rotation=90 if is_narrow else 0)
    axes.tick_params(axis="x", length=0)
    axes.set_xlim(-0.65, x - _GAP - 0.35)


def _ratings_of(row: dict[str, Any], people: pd.DataFrame) -> np.ndarray:
    is_own = np.ones(len(people), dtype=bool)
    for key in _KEYS:
        column = people[key]
        is_own &= (column.isna() if pd.isna(row[key]) else column == row[key]).to_numpy(bool)
    return people.loc[is_own, "rating"].to_numpy(dtype=float)


def _draw_eye(
    axes: Axes, x: float, row: dict[str, Any], ratings: np.ndarray, lods: Sequence[str]
) -> None:
    colour = lod_colour(row["lod"], lods)
    if ratings.size <= _MOST_DOTS:
        sideways = beeswarm(ratings, step=min(0.1, 0.8 / ratings.size))
        axes.scatter(x + sideways, ratings, s=9, color=colour, alpha=0.5, linewidths=0, zorder=2)
    else:
        values, counts = np.unique(np.round(ratings), return_counts=True)
        size = 260 * counts / ratings.size
        axes.scatter(np.full(values.size, x), values, s=size, color=colour, alpha=0.35,
                     linewidths=0, zorder=2)  # fmt: skip
    draw_mean(axes, x, row, lods=lods)


def _write_count(axes: Axes, x: float, text: str, *, is_first: bool) -> None:
    """Write n above a column; in narrow ones only the first says that it is n."""
    axes.annotate(
        text,
        (x, 1),
        xycoords=("data", "axes fraction"),
        xytext=(4 if is_first else 0, -1),
        textcoords="offset points",
        ha="right" if is_first else "center",
        va="top",
        fontsize=6.5,
        color=QUIET,
    )


def _name_clip(axes: Axes, x: float, name: str, *, upright: Sequence[str]) -> None:
    """Write a clip's name below those of its eyes, which may stand ``upright``."""
    under = max(_UPRIGHT_PT, 72 * upright_in(upright) + 8) if upright else 29.0
    axes.annotate(
        textwrap.fill(name, 12 if upright else 20),
        (x, 0),
        xycoords=("data", "axes fraction"),
        xytext=(0, -under),
        textcoords="offset points",
        ha="center",
        va="top",
        fontsize=SMALL,
        color=QUIET,
    )
