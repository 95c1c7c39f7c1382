"""Bars of shares: how a row of answers is drawn, whatever the question was.

Each row is a bar of all answers. Comparisons stand between the names of the two LoDs, so the part
next to a name is the share that preferred it. Lines beside a bar are Wilson's intervals: above it
for the first answer, below it for the last. Black strokes across it are what a model expects.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from analysis.charts.parts import clip_label, grouped_places, head_groups, readable_on
from analysis.charts.style import INK, PAGE_WIDTH_IN, SMALL, message_figure, new_figure, tidy
from analysis.descriptive.shares import PAIRED
from analysis.tables.reading import Tables
from analysis.tables.records import records

_ROW_IN: Final = 0.36
_MOST_IN: Final = 7.4  # all rows together: a page with its caption
_HALF: Final = 0.28  # of a bar's height, in rows


@dataclass(frozen=True)
class Look:
    """What a chart of shares shows: its title, its answers in order, their names and colours.

    ``sides`` are the columns of the two LoDs; ``empty`` says why there is nothing to draw and
    ``note`` stands below the axis.
    """

    title: str
    answers: Sequence[str]
    names: Sequence[str]
    colours: Sequence[str]
    sides: tuple[str, str]
    empty: str
    is_two_sided: bool
    note: str = ""


def share_chart(shares: pd.DataFrame, tables: Tables, look: Look) -> Figure:
    """Draw a bar per clip or pair; a column ``predicted`` is what a model expects."""
    if shares.empty:
        return message_figure(look.title, look.empty, is_simulated=tables.is_simulated)
    keys = [name for name in ("distance", "clip", *look.sides) if name in shares]
    rows = [records(own) for _, own in shares.groupby(keys, sort=False, dropna=False)]
    distances = [str(own[0]["distance"]) for own in rows]
    places = grouped_places(distances)
    row_in = min(_ROW_IN, _MOST_IN / places[-1])
    height = 1.45 + row_in * places[-1] + (0.15 if look.note else 0.0)
    figure = new_figure(PAGE_WIDTH_IN, height, look.title, is_simulated=tables.is_simulated)
    axes = figure.subplots()
    tidy(axes, grid="x")
    answers = [{str(row["answer"]): row for row in own} for own in rows]
    _draw_bars(axes, places, answers, look, size=min(7.5, 0.95 * 144 * _HALF * row_in))
    is_modelled = _draw_expected(axes, places, answers, look)
    names = [_names(own[0], look) for own in rows]
    axes.set_yticks(places, [left for left, _ in names])
    for y, (_, right) in zip(places, names, strict=True):
        axes.text(1.012, y, right, transform=axes.get_yaxis_transform(), ha="left", va="center",
                  fontsize=SMALL, color=INK)  # fmt: skip
    head_groups(axes, places, distances, tables)
    axes.set_xlim(0, 1)
    axes.set_xticks(np.linspace(0, 1, 5), [f"{p} %" for p in (0, 25, 50, 75, 100)])
    label = "share of answers; lines: 95 % intervals of the shares in their colour"
    axes.set_xlabel(f"{label}\n{look.note}" if look.note else label, fontsize=SMALL)
    handles: list[Patch | Line2D] = [
        Patch(color=c, label=n) for n, c in zip(look.names, look.colours, strict=True)
    ]
    if is_modelled:
        handles.append(Line2D([], [], color=INK, marker="|", markersize=9, markeredgewidth=1.6,
                              linestyle="", label="by the model"))  # fmt: skip
    figure.legend(
        handles=handles, loc="outside lower center", ncols=4, frameon=False, fontsize=SMALL
    )
    return figure


def _names(row: Mapping[str, Any], look: Look) -> tuple[str, str]:
    left, right = str(row[look.sides[0]]), str(row[look.sides[1]])
    has_clip = "clip" in row and PAIRED not in str(row["clip"])
    clip = f"{clip_label(str(row['clip']))}:  " if has_clip else ""
    count = f"n = {row['total']}"
    if look.is_two_sided:
        return f"{clip}{left}", f"{right}   ({count})"
    pair = f"{left} – {right}" if left != right else f"{left} – {right} (the same)"
    return f"{clip}{pair}", count


Answered = Sequence[Mapping[str, Mapping[str, Any]]]


def _draw_bars(
    axes: Axes, places: Sequence[float], rows: Answered, look: Look, *, size: float
) -> None:
    start = np.zeros(len(rows))
    for answer, colour in zip(look.answers, look.colours, strict=True):
        share = np.array([row[answer]["share"] for row in rows])
        axes.barh(places, share, left=start, height=2 * _HALF, color=colour, edgecolor="white")
        ink = readable_on(colour)
        for y, x, row in zip(places, start + share / 2, rows, strict=True):
            if row[answer]["share"] > 0.04:
                axes.text(x, y, f"{row[answer]['count']}", ha="center", va="center", fontsize=size,
                          color=ink, zorder=5)  # fmt: skip
        start += share
    at = np.array(places)
    ends = np.array([[row[look.answers[0]][end] for end in ("low", "high")] for row in rows])
    _draw_intervals(axes, at - 0.37, ends, colour=look.colours[0])
    if look.is_two_sided:
        last = np.array([[row[look.answers[-1]][end] for end in ("high", "low")] for row in rows])
        _draw_intervals(axes, at + 0.37, 1 - last, colour=look.colours[-1])


def _draw_intervals(axes: Axes, y: np.ndarray, ends: np.ndarray, *, colour: str) -> None:
    """Draw each row's interval beside its bar, in the colour of the share it belongs to."""
    style: dict[str, Any] = {"colors": colour, "linewidth": 1.3, "zorder": 3, "clip_on": False}
    axes.hlines(y, ends[:, 0], ends[:, 1], **style)
    axes.vlines(ends.ravel(), np.repeat(y - 0.08, 2), np.repeat(y + 0.08, 2), **style)


def _draw_expected(axes: Axes, places: Sequence[float], rows: Answered, look: Look) -> bool:
    """Draw where the model expects the parts of each bar to meet; say whether there was any."""
    if any("predicted" not in own for row in rows for own in row.values()):
        return False
    share = np.array([[row[answer]["predicted"] for answer in look.answers[:-1]] for row in rows])
    x, y = np.cumsum(share, axis=1), np.repeat(places, share.shape[1])
    known = np.isfinite(x.ravel())
    for colour, width in (("white", 3.0), (INK, 1.5)):
        axes.vlines(x.ravel()[known], y[known] - _HALF, y[known] + _HALF, colors=colour,
                    linewidth=width, zorder=4)  # fmt: skip
    return bool(known.any())
