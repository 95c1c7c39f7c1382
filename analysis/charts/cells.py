"""Charts per LoD and distance: how often each rating was given, and what was shown at all."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from analysis.charts.parts import (
    MOST_COLUMNS,
    grouped_places,
    head_groups,
    in_bands,
    name_columns,
    readable_on,
)
from analysis.charts.style import (
    INK,
    NO_RATINGS,
    NORMAL,
    PAGE_WIDTH_IN,
    QUIET,
    SMALL,
    message_figure,
    new_figure,
    scale_colours,
    tidy,
)
from analysis.descriptive.means import mean_ratings, rating_counts
from analysis.tables.ordering import distance_order, lod_order
from analysis.tables.reading import Tables
from analysis.tables.records import records
from analysis.words.wording import interval, number

DISTRIBUTION: Final = "Distribution of the ratings"
MATRIX: Final = "Mean realism per LoD and distance"


def rating_distribution(tables: Tables) -> Figure:
    """Draw how often each rating was given, per distance and LoD, centred on the middle one."""
    counts = rating_counts(tables.ratings, ["distance", "lod"], scale=tables.scale)
    if counts.empty:
        return message_figure(DISTRIBUTION, NO_RATINGS, is_simulated=tables.is_simulated)
    steps = [str(step) for step in range(tables.scale[0], tables.scale[1] + 1)]
    colours = scale_colours(len(steps))
    distances = [str(d) for d in counts["distance"]]
    places = grouped_places(distances)
    figure = new_figure(
        PAGE_WIDTH_IN, 1.5 + 0.33 * places[-1], DISTRIBUTION, is_simulated=tables.is_simulated
    )
    axes = figure.subplots()
    tidy(axes, grid="x")
    for y, row in zip(places, records(counts), strict=True):
        _draw_shares(axes, y, [row[step] for step in steps], colours)
        axes.text(
            1.01,
            y,
            f"n = {row['total']}",
            transform=axes.get_yaxis_transform(),
            va="center",
            ha="left",
            fontsize=SMALL,
            color=QUIET,
        )
    axes.set_yticks(places, [str(lod) for lod in counts["lod"]])
    head_groups(axes, places, distances, tables)
    axes.axvline(0, color="#999999", linewidth=0.8, zorder=0)
    axes.set_xlim(-1, 1)
    axes.set_xticks(np.linspace(-1, 1, 5), ["100 %", "50 %", "0", "50 %", "100 %"])
    axes.set_xlabel("share of ratings, below and above the middle of the scale", fontsize=SMALL)
    figure.legend(
        handles=[Patch(color=c, label=s) for s, c in zip(steps, colours, strict=True)],
        loc="outside lower center",
        ncols=len(steps),
        frameon=False,
        fontsize=SMALL,
        title="rating (number of answers in the bars)",
        title_fontsize=SMALL,
    )
    return figure


def _draw_shares(axes: Axes, y: float, counts: list[int], colours: list[str]) -> None:
    shares = np.array(counts) / sum(counts)
    middle = len(counts) // 2
    start = -shares[:middle].sum() - (shares[middle] / 2 if len(counts) % 2 else 0)
    for count, share, colour in zip(counts, shares, colours, strict=True):
        axes.barh(y, share, left=start, height=0.72, color=colour, edgecolor="white")
        if share > 0.045:
            axes.text(
                start + share / 2,
                y,
                f"{count}",
                ha="center",
                va="center",
                fontsize=7.5,
                color=readable_on(colour),
            )
        start += share


def realism_matrix(tables: Tables) -> Figure:
    """Draw mean realism per LoD and distance; combinations that nobody saw are hatched."""
    means = mean_ratings(tables.ratings, ["distance", "lod"])
    if means.empty:
        return message_figure(MATRIX, NO_RATINGS, is_simulated=tables.is_simulated)
    counted = tables.ratings[~tables.ratings["is_practice"]]
    distances, lods = distance_order(counted), lod_order(counted)[::-1]
    cells = {(row["lod"], row["distance"]): row for row in records(means)}
    shown = set(zip(counted["lod"], counted["distance"], strict=True))
    bands = in_bands(distances, MOST_COLUMNS)
    columns = len(bands[0])
    width = min(PAGE_WIDTH_IN, 1.9 + 1.3 * max(3, columns))
    figure = new_figure(
        width,
        0.8 + (0.45 + 0.62 * len(lods)) * len(bands),
        MATRIX,
        is_simulated=tables.is_simulated,
    )
    for axes, own in zip(figure.subplots(len(bands), squeeze=False)[:, 0], bands, strict=True):
        for j, distance in enumerate(own):
            for i, lod in enumerate(lods):
                cell = cells.get((lod, distance))
                reason = "no rating" if (lod, distance) in shown else "not shown"
                _draw_cell(axes, (j, i), cell or {"reason": reason}, tables.scale)
        tidy(axes, grid="")
        axes.set_xlim(-0.5, columns - 0.5)
        axes.set_ylim(len(lods) - 0.5, -0.5)
        name_columns(axes, own, tables, width_in=(width - 1.0) / columns)
        axes.set_yticks(range(len(lods)), lods)
        axes.tick_params(length=0)
        axes.spines[:].set_visible(False)
    return figure


def _draw_cell(
    axes: Axes, at: tuple[int, int], cell: dict[str, Any], scale: tuple[int, int]
) -> None:
    x, y = at
    box: dict[str, Any] = {"facecolor": "white", "hatch": "////", "edgecolor": "#d5d5d5"}
    if "mean" in cell:
        strength = (cell["mean"] - scale[0]) / (scale[1] - scale[0])
        box = {"facecolor": tuple(1 - strength * (1 - c) for c in (0.35, 0.55, 0.78))}
        people, ratings = cell["people"], cell["ratings"]
        axes.text(x, y - 0.24, number(cell["mean"]), ha="center", va="center", color=INK,
                  fontsize=NORMAL + 1)  # fmt: skip
        axes.text(x, y + 0.06, interval(cell["low"], cell["high"]), ha="center", va="center",
                  color=INK, fontsize=7)  # fmt: skip
        axes.text(x, y + 0.3, f"n = {people}, {ratings} ratings", ha="center", va="center",
                  color=INK, fontsize=6.5)  # fmt: skip
    else:
        axes.text(x, y, cell["reason"], ha="center", va="center", color=QUIET, fontsize=7,
                  bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5})  # fmt: skip
    axes.add_patch(Rectangle((x - 0.48, y - 0.46), 0.96, 0.92, linewidth=0, zorder=0.5, **box))
