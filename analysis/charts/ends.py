"""Are the scale's ends used as the model expects? Shares of ones and fives, given and predicted."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from analysis.charts.material import Material
from analysis.charts.parts import distance_label, grouped_places
from analysis.charts.scales import NO_MODEL
from analysis.charts.style import (
    INK,
    NORMAL,
    PAGE_WIDTH_IN,
    QUIET,
    SMALL,
    message_figure,
    new_figure,
    tidy,
)
from analysis.diagnostics.predicted import HIGHEST, LOWEST
from analysis.tables.records import records
from analysis.words.wording import number, people

ENDS: Final = "Are the ends of the scale used as the model expects?"
_MOST_PEOPLE: Final = 200
_ROW_IN: Final = 0.24
_PEOPLE_IN: Final = 2.1
_GIVEN: Final = {True: ("#0072B2", "o"), False: ("#D55E00", "D")}


def ends_table(material: Material) -> pd.DataFrame:
    """Return the shares of lowest and highest ratings by cell and person, given and predicted."""
    found = material.ends
    return pd.DataFrame(columns=["of", "end", "share"]) if found.empty else found


def ends_chart(material: Material) -> Figure:
    """Draw each cell's shares with what the model expects; below it everyone's."""
    table = ends_table(material)
    if table.empty:
        return message_figure(ENDS, NO_MODEL, is_simulated=material.is_simulated)
    cells, own = table[table["of"] == "cell"], table[table["of"] == "person"]
    names = cells[cells["end"] == HIGHEST]
    distances = [str(distance) for distance in names["distance"]]
    places = grouped_places(distances)
    cells_in = 0.35 + min(_ROW_IN, 5.8 / places[-1]) * (places[-1] + 1)
    figure = new_figure(
        PAGE_WIDTH_IN, 1.0 + cells_in + _PEOPLE_IN, ENDS, is_simulated=material.is_simulated
    )
    grid = figure.subplots(2, 2, height_ratios=(cells_in, _PEOPLE_IN), sharey="row")
    low, high = material.tables.scale
    for column, (end, rating) in enumerate(((LOWEST, low), (HIGHEST, high))):
        axes, below = grid[0, column], grid[1, column]
        _draw_cells(axes, places, cells[cells["end"] == end])
        axes.set_title(f"share of ratings that are {rating}", fontsize=NORMAL, color=INK)
        _draw_people(below, own[own["end"] == end], rating)
    most = float(own[["share", "high"]].to_numpy(dtype=float).max())
    grid[1, 0].set_ylim(0, 1.06 * most if most else 1.0)  # one scale for both ends
    _name_rows(grid[0, 0], places, names, material)
    grid[1, 0].set_ylabel("share of a person's ratings", fontsize=SMALL)
    figure.supxlabel(
        "bars: where the model expects 95 % of studies like this one, mean in white; "
        "orange diamonds lie outside",
        fontsize=SMALL,
        color=INK,
    )
    return figure


def _name_rows(axes: Axes, places: list[float], names: pd.DataFrame, material: Material) -> None:
    first = ~names["distance"].duplicated().to_numpy()
    distances = [str(distance) for distance in names["distance"]]
    ratings = [int(count) for count in names["ratings"]]
    lods = [str(lod) for lod in names["lod"]]
    axes.set_yticks(places, [f"{lod} ({people(n)})" for lod, n in zip(lods, ratings, strict=True)])
    axes.set_ylim(places[-1] + 0.6, places[0] - 1.4)
    for y, distance, is_first in zip(places, distances, first, strict=True):
        if is_first:
            axes.text(0, y - 0.5, distance_label(distance, material.tables),
                      transform=axes.get_yaxis_transform(), fontsize=SMALL, fontweight="bold",
                      color=INK, va="bottom")  # fmt: skip


def _draw_cells(axes: Axes, places: list[float], table: pd.DataFrame) -> None:
    tidy(axes, grid="x")
    axes.tick_params(axis="y", length=0)
    y = np.array(places)
    low, high, mean = (table[name].to_numpy(dtype=float) for name in ("low", "high", "predicted"))
    axes.hlines(y, low, high, colors=QUIET, linewidth=6, alpha=0.45, zorder=2)
    axes.plot(mean, y, marker="|", linestyle="", color="white", markersize=6, zorder=3)
    for at, row in zip(y, records(table), strict=True):
        colour, marker = _GIVEN[bool(row["is_within"])]
        axes.plot([row["share"]], [at], marker=marker, color=colour, markeredgecolor=INK,
                  markeredgewidth=0.7, markersize=5.5, linestyle="", zorder=4)  # fmt: skip
    axes.set_xlim(left=min(0.0, axes.get_xlim()[0]))
    axes.xaxis.set_major_formatter(lambda value, _: f"{100 * value:.0f} %")


def _draw_people(axes: Axes, table: pd.DataFrame, rating: int) -> None:
    """Draw everyone in the order of their share; of very many people evenly spaced ones."""
    tidy(axes)
    rows = table.sort_values(["share", "predicted"], kind="stable")
    shown = np.unique(np.linspace(0, len(rows) - 1, min(len(rows), _MOST_PEOPLE)).round())
    rows = rows.iloc[shown.astype(int)]
    x = shown + 1
    width = float(np.clip(260 / len(rows), 0.8, 6.0))
    axes.vlines(x, rows["low"], rows["high"], colors=QUIET, linewidth=width, alpha=0.45, zorder=2)
    is_within = rows["is_within"].to_numpy(dtype=bool)
    for own, (colour, marker) in ((is_within, _GIVEN[True]), (~is_within, _GIVEN[False])):
        axes.plot(x[own], rows["share"][own], marker=marker, linestyle="", color=colour,
                  markeredgecolor=INK, markeredgewidth=0.5, zorder=3,
                  markersize=5 if len(rows) < 60 else 3)  # fmt: skip
    given = table["count"]
    total, most = int(given.sum()), int(given.max())
    share = f", {number(100 * most / total, digits=0)} % by one person" if total else ""
    axes.set_xlabel(
        f"people in this order, {people(len(table))}\n{total} ratings of {rating}{share}",
        fontsize=SMALL - 0.5,
    )
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.yaxis.set_major_formatter(lambda value, _: f"{100 * value:.0f} %")
