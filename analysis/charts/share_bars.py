"""Charts of shares: which eye was called more realistic, and who noticed a difference.

Each row is a bar of all answers. Comparisons stand between the names of the two LoDs, so the part
next to a name is the share that preferred it. Lines beside a bar are Wilson's intervals: above it
for the first answer, below it for the last.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from analysis.charts.parts import clip_label, grouped_places, head_groups, readable_on, records
from analysis.charts.style import (
    CHOICE_COLOURS,
    INK,
    NOTICE_COLOURS,
    PAGE_WIDTH_IN,
    SMALL,
    message_figure,
    new_figure,
    tidy,
)
from analysis.shares import (
    OUTCOMES,
    PAIR_OUTCOMES,
    PAIRED,
    clips_or_pairings,
    comparison_shares,
    notice_shares,
    pair_comparison_shares,
    pair_notice_shares,
)
from analysis.tables.columns import NOTICED
from analysis.tables.reading import Tables

CLIP_COMPARED: Final = "Which eye is more realistic, per clip"
PAIR_COMPARED: Final = "Which LoD is more realistic, per pair"
CLIP_NOTICED: Final = "Difference noticed, per clip"
PAIR_NOTICED: Final = "Difference noticed, per pair"
_ROW_IN: Final = 0.36
_MOST_IN: Final = 7.4  # all rows together: a page with its caption
NO_COMPARISONS: Final = "No comparison of the two eyes has been answered yet."
NO_NOTICES: Final = "Whether a difference was noticed has not been answered yet."


@dataclass(frozen=True)
class _Look:
    """What a chart of shares shows: its title, its answers in order, and their names."""

    title: str
    answers: Sequence[str]
    names: Sequence[str]
    colours: Sequence[str]
    is_two_sided: bool


def comparisons_per_clip(tables: Tables) -> Figure:
    """Draw, per clip, how many called the left eye, neither, or the right eye more realistic."""
    look = _Look(
        CLIP_COMPARED,
        OUTCOMES,
        ("left eye", "no difference noticed", "right eye"),
        CHOICE_COLOURS,
        True,
    )
    shares = comparison_shares(clips_or_pairings(tables.comparisons))
    return _draw(shares, tables, look, ("left_lod", "right_lod"), NO_COMPARISONS)


def comparisons_per_pair(tables: Tables) -> Figure:
    """Draw, per pair of LoDs, how many called the lesser, neither or the greater more real."""
    look = _Look(
        PAIR_COMPARED,
        PAIR_OUTCOMES,
        ("lesser LoD", "no difference noticed", "greater LoD"),
        CHOICE_COLOURS,
        True,
    )
    shares = pair_comparison_shares(tables.comparisons)
    return _draw(shares, tables, look, ("lesser", "greater"), NO_COMPARISONS)


def noticed_per_clip(tables: Tables) -> Figure:
    """Draw, per clip, how many noticed anything missing or different between the eyes."""
    look = _Look(CLIP_NOTICED, NOTICED, _NOTICE_NAMES, NOTICE_COLOURS, False)
    shares = notice_shares(clips_or_pairings(tables.comparisons))
    return _draw(shares, tables, look, ("left_lod", "right_lod"), NO_NOTICES)


def noticed_per_pair(tables: Tables) -> Figure:
    """Draw, per pair of LoDs, how many noticed a difference; equal LoDs show false alarms."""
    look = _Look(PAIR_NOTICED, NOTICED, _NOTICE_NAMES, NOTICE_COLOURS, False)
    shares = pair_notice_shares(tables.comparisons)
    return _draw(shares, tables, look, ("lesser", "greater"), NO_NOTICES)


_NOTICE_NAMES: Final = ("yes", "not sure", "no")


def _draw(
    shares: pd.DataFrame, tables: Tables, look: _Look, sides: tuple[str, str], empty: str
) -> Figure:
    if shares.empty:
        return message_figure(look.title, empty, is_simulated=tables.is_simulated)
    keys = [name for name in ("distance", "clip", *sides) if name in shares]
    rows = [own for _, own in shares.groupby(keys, sort=False, dropna=False)]
    first = [records(own)[0] for own in rows]
    distances = [str(row["distance"]) for row in first]
    places = grouped_places(distances)
    row_in = min(_ROW_IN, _MOST_IN / places[-1])
    figure = new_figure(
        PAGE_WIDTH_IN, 1.45 + row_in * places[-1], look.title, is_simulated=tables.is_simulated
    )
    axes = figure.subplots()
    tidy(axes, grid="x")
    for y, own in zip(places, rows, strict=True):
        answers = {row["answer"]: row for row in records(own)}
        _draw_bar(axes, y, answers, look)
    names = [_names(row, sides, look) for row in first]
    axes.set_yticks(places, [left for left, _ in names])
    for y, (_, right) in zip(places, names, strict=True):
        _write_beside(axes, y, right)
    head_groups(axes, places, distances, tables)
    axes.set_xlim(0, 1)
    axes.set_xticks(np.linspace(0, 1, 5), [f"{p} %" for p in (0, 25, 50, 75, 100)])
    axes.set_xlabel(
        "share of answers; lines: 95 % intervals of the shares in their colour", fontsize=SMALL
    )
    figure.legend(
        handles=[Patch(color=c, label=n) for n, c in zip(look.names, look.colours, strict=True)],
        loc="outside lower center",
        ncols=3,
        frameon=False,
        fontsize=SMALL,
    )
    return figure


def _names(row: Mapping[str, Any], sides: tuple[str, str], look: _Look) -> tuple[str, str]:
    left, right = str(row[sides[0]]), str(row[sides[1]])
    has_clip = "clip" in row and PAIRED not in str(row["clip"])
    clip = f"{clip_label(str(row['clip']))}:  " if has_clip else ""
    count = f"n = {row['total']}"
    if look.is_two_sided:
        return f"{clip}{left}", f"{right}   ({count})"
    pair = f"{left} – {right}" if left != right else f"{left} – {right} (the same)"
    return f"{clip}{pair}", count


def _write_beside(axes: Axes, y: float, text: str) -> None:
    axes.text(
        1.012,
        y,
        text,
        transform=axes.get_yaxis_transform(),
        ha="left",
        va="center",
        fontsize=SMALL,
        color=INK,
    )


def _draw_bar(axes: Axes, y: float, answers: Mapping[str, Mapping[str, Any]], look: _Look) -> None:
    start = 0.0
    for answer, colour in zip(look.answers, look.colours, strict=True):
        row = answers[answer]
        axes.barh(y, row["share"], left=start, height=0.56, color=colour, edgecolor="white")
        if row["share"] > 0.04:
            axes.text(
                start + row["share"] / 2,
                y,
                f"{row['count']}",
                ha="center",
                va="center",
                fontsize=7.5,
                color=readable_on(colour),
            )
        start += row["share"]
    first, last = answers[look.answers[0]], answers[look.answers[-1]]
    _draw_interval(axes, y - 0.37, first["low"], first["high"], colour=look.colours[0])
    if look.is_two_sided:
        _draw_interval(axes, y + 0.37, 1 - last["high"], 1 - last["low"], colour=look.colours[-1])


def _draw_interval(axes: Axes, y: float, low: float, high: float, *, colour: str) -> None:
    """Draw an interval beside the bar, in the colour of the share it belongs to."""
    axes.plot([low, high], [y, y], color=colour, linewidth=1.3, zorder=3, clip_on=False)
    for end in (low, high):
        axes.plot(
            [end, end], [y - 0.08, y + 0.08], color=colour, linewidth=1.3, zorder=3, clip_on=False
        )
