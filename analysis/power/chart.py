"""The chart of power: one panel per distance, a line for each LoD over the number of people."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, NullLocator, PercentFormatter

from analysis.charts.style import INK, QUIET, SMALL, lod_colour, lod_marker, new_figure, tidy
from analysis.power.needed import POWER
from analysis.power.outcome import Outcome

_COLUMNS: Final = 2
_APART: Final = 0.075  # of the axis: two labels of a line's end stand no closer
_BAND: Final = "#c9c9c9"


@dataclass(frozen=True)
class _End:
    """Where a line ends, its name and its look."""

    y: float
    text: str
    colour: str
    width: float


def power_chart(outcome: Outcome, *, title: str) -> Figure:
    """Draw the share of right verdicts by number of people; bars are the simulation's error."""
    distances = list(dict.fromkeys(outcome.verdicts["distance"]))
    rows = math.ceil(len(distances) / _COLUMNS)
    columns = min(_COLUMNS, len(distances))
    height = max(2.9, 0.33 * outcome.verdicts["lod"].nunique() + 0.9)
    figure = new_figure(4.6 * columns, height * rows + 0.7, title, is_simulated=True)
    panels = figure.subplots(rows, columns, squeeze=False, sharey=True).ravel()
    lods = list(dict.fromkeys(outcome.verdicts["lod"]))
    for axes, distance in zip(panels, distances, strict=False):
        _panel(axes, outcome, distance, lods)
    for axes in panels[len(distances) :]:
        axes.set_visible(False)
    for axes in panels[::columns]:
        axes.set_ylabel("studies with the right verdict", fontsize=SMALL, color=INK)
    return figure


def _panel(axes: Axes, outcome: Outcome, distance: str, lods: list[str]) -> None:
    own = outcome.verdicts[outcome.verdicts["distance"] == distance]
    people = sorted(set(own["participants"].astype(int)))
    axes.set_title(distance, fontsize=SMALL + 1, fontweight="bold", color=INK, loc="left")
    ends: list[_End] = []
    silent: list[str] = []
    cheapest = outcome.cheapest[outcome.cheapest["distance"] == distance]
    if not cheapest["right"].isna().any():
        axes.plot(
            *(cheapest["participants"], cheapest["right"]), color=_BAND, linewidth=7, zorder=2
        )
        text = f"{cheapest['right_lod'].iloc[0]} named as cheapest"
        ends.append(_End(float(cheapest["right"].iloc[-1]), text, _BAND, 4.0))
    for lod, rows in own.groupby("lod", sort=False):
        name = str(rows["right_verdict"].iloc[0])
        shown = name or "equivalent"
        if rows[shown].isna().any():
            silent.append(str(lod))
            continue
        colour = lod_colour(str(lod), lods)
        _line(axes, rows, shown, colour=colour, marker=lod_marker(str(lod), lods))
        text = f"{lod}: {shown}" if name else f"{lod}: {shown}, on the margin"
        ends.append(_End(float(rows[shown].iloc[-1]), text, colour, 1.4))
    if ends:
        axes.plot(
            *([people[0], people[-1]], [POWER] * 2), color=QUIET, linewidth=0.8, linestyle="--"
        )
    _label(axes, ends, at=people[-1])
    _axis(axes, people)
    if silent:
        few = ", ".join(silent) if len(silent) < 4 else f"{len(silent)} LoDs"
        place = (0.02, 0.03 if ends else 0.5)
        text = f"cannot be concluded: {few}"
        axes.text(*place, text, transform=axes.transAxes, fontsize=SMALL, color=QUIET)


def _line(axes: Axes, rows: pd.DataFrame, name: str, *, colour: str, marker: str) -> None:
    own = rows.sort_values("participants")
    x, y = own["participants"].astype(float), own[name].astype(float)
    error: Any = [y - own[f"{name}_low"], own[f"{name}_high"] - y]
    axes.errorbar(
        x,
        y,
        yerr=error,
        color=colour,
        marker=marker,
        markersize=5,
        markeredgecolor=INK,
        markeredgewidth=0.5,
        linewidth=1.4,
        elinewidth=0.9,
        capsize=2,
        zorder=3,
    )


def _label(axes: Axes, ends: list[_End], *, at: float) -> None:
    """Write each line's name at its end, moved apart where they meet, with a leader."""
    listed = sorted(ends, key=lambda end: end.y)
    places: list[float] = []
    for end in listed:
        places.append(max(end.y, places[-1] + _APART) if places else max(end.y, 0.0))
    over = max(0.0, places[-1] - 1.02) if places else 0.0
    for place, end in zip(places, listed, strict=True):
        axes.annotate(
            end.text,
            (at, end.y),
            xytext=(at * 1.16, place - over),
            va="center",
            fontsize=SMALL,
            color=INK,
            arrowprops={
                "arrowstyle": "-",
                "color": end.colour,
                "linewidth": end.width,
                "relpos": (0.0, 0.5),
                "shrinkA": 1,
                "shrinkB": 3,
            },
            annotation_clip=False,
        )


def _axis(axes: Axes, people: list[int]) -> None:
    tidy(axes)
    axes.set_xscale("log")
    axes.set_xticks(people, [str(count) for count in people])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_minor_formatter(NullFormatter())
    first, last = people[0], people[-1]
    spread = (last / first) if last > first else 2.0
    axes.set_xlim(first / spread**0.06, last * spread**0.62)
    axes.set_ylim(-0.03, 1.05)
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
    axes.set_xlabel("people", fontsize=SMALL, color=INK)
