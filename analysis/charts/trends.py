"""How realism follows the actual LoD, and how it changes with viewing distance."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis.charts.parts import distance_label, draw_mean, lod_legend, name_columns, upright_in
from analysis.charts.style import (
    FAINT,
    INK,
    NO_RATINGS,
    NORMAL,
    PAGE_WIDTH_IN,
    SMALL,
    lod_colour,
    message_figure,
    new_figure,
    rating_axis,
    tidy,
)
from analysis.correlation import rank_correlations
from analysis.descriptive.means import answered, mean_ratings, person_means
from analysis.tables.ordering import distance_order, lod_order
from analysis.tables.reading import Tables
from analysis.tables.records import records
from analysis.words.wording import number, p_value

AGAINST_LOD: Final = "Perceived against actual level of detail"
BY_DISTANCE: Final = "Perceived realism by viewing distance"
NO_ORDER: Final = "At no distance were two ranked LoDs rated, so there is no order to compare with."
_PANELS_PER_ROW: Final = 3
_MOST_LINES: Final = 100


def perceived_against_actual(tables: Tables) -> Figure:
    """Draw mean realism against the actual LoD, one panel per distance, each person as a line."""
    rated = answered(tables.ratings)
    ranked = rated[rated["lod_rank"].notna()]
    is_ordered = ranked.groupby("distance")["lod"].transform("nunique") > 1
    ranked = ranked[is_ordered.astype(bool)]
    if ranked.empty:
        reason = NO_RATINGS if rated.empty else NO_ORDER
        return message_figure(AGAINST_LOD, reason, is_simulated=tables.is_simulated)
    means = mean_ratings(ranked, ["distance", "lod"])
    people = person_means(ranked, ["distance", "lod"])
    correlations = {row["distance"]: row for row in records(rank_correlations(ranked))}
    distances, lods = distance_order(ranked), lod_order(ranked)
    place = {lod: float(i) for i, lod in enumerate(lods)}
    figure, panels = _panels(AGAINST_LOD, len(distances), tables)
    for number_of_panel, (axes, distance) in enumerate(zip(panels, distances, strict=True)):
        tidy(axes)
        own = people[people["distance"] == distance]
        if own["participant"].nunique() > _MOST_LINES:
            own = own.iloc[:0]
        for _, line in own.groupby("participant", sort=False):
            at = line["lod"].map(place).sort_values()
            axes.plot(at, line.loc[at.index, "rating"], color=FAINT, linewidth=0.9, zorder=1)
        rows = records(means[means["distance"] == distance])
        at_means = [place[row["lod"]] for row in rows]
        axes.plot(at_means, [row["mean"] for row in rows], color=INK, linewidth=1.2, zorder=2)
        for x, row in zip(at_means, rows, strict=True):
            draw_mean(axes, x, row, lods=lods)
        axes.set_xticks(range(len(lods)), lods)
        axes.set_xlim(-0.5, len(lods) - 0.5)
        axes.set_title(distance_label(distance, tables), fontsize=NORMAL, color=INK)
        axes.set_xlabel("actual LoD", fontsize=SMALL)
        rating_axis(
            axes, tables.scale, is_labelled=number_of_panel % _panel_columns(len(distances)) == 0
        )
        if distance in correlations:
            _note_correlation(axes, correlations[distance])
    return figure


def _panels(title: str, count: int, tables: Tables) -> tuple[Figure, list[Axes]]:
    columns = _panel_columns(count)
    rows = -(-count // columns)
    width = min(PAGE_WIDTH_IN, max(5.0, 0.9 + 2.6 * columns))
    figure = new_figure(width, 0.8 + 2.8 * rows, title, is_simulated=tables.is_simulated)
    grid = figure.subplots(rows, columns, squeeze=False, sharey=True).ravel().tolist()
    for axes in grid[count:]:
        axes.set_visible(False)
    return figure, list(grid[:count])


def _panel_columns(count: int) -> int:
    """Return how many panels stand in a row: two by two for four, else at most three."""
    return 2 if count == 4 else min(count, _PANELS_PER_ROW)


def tau_sentence(row: Mapping[str, Any]) -> str:
    """Write a distance's tau-b with its interval, p value and n."""
    text = f"τ = {number(row['tau_b'])}"
    if np.isfinite(row["tau_low"]):
        text += f" [{number(row['tau_low'])}, {number(row['tau_high'])}], {p_value(row['tau_p'])}"
    used = row["people"] - row["without_spread"]
    return text + (f", n = {used}" if used == row["people"] else f", n = {used} of {row['people']}")


def _note_correlation(axes: Axes, row: Mapping[str, Any]) -> None:
    axes.text(0.03, 0.99, tau_sentence(row), transform=axes.transAxes, ha="left", va="top",
              fontsize=7, color=INK, zorder=5)  # fmt: skip


def realism_by_distance(tables: Tables) -> Figure:
    """Draw mean realism against viewing distance, one line per LoD; cells not shown stay empty."""
    means = mean_ratings(tables.ratings, ["distance", "lod"])
    if means.empty:
        return message_figure(BY_DISTANCE, NO_RATINGS, is_simulated=tables.is_simulated)
    rated = answered(tables.ratings)
    distances, lods = distance_order(rated), lod_order(rated)
    width = min(PAGE_WIDTH_IN, 2.4 + 1.3 * max(3, len(distances)))
    figure = new_figure(
        width,
        3.7,
        BY_DISTANCE,
        is_simulated=tables.is_simulated,
    )
    axes = figure.subplots()
    tidy(axes)
    step = min(0.09, 0.6 / len(lods))
    for k, lod in enumerate(lods):
        colour = lod_colour(lod, lods)
        own = means[means["lod"] == lod].set_index("distance", drop=False).reindex(distances)
        x = np.arange(len(distances)) + (k - (len(lods) - 1) / 2) * step
        axes.plot(x, own["mean"].to_numpy(dtype=float), color=colour, linewidth=1.4, zorder=2)
        for at, row in zip(x, records(own), strict=True):
            if np.isfinite(row["mean"]):
                draw_mean(axes, at, row, lods=lods, colour=colour)
    room = width - 1.1 - upright_in(lods)  # beside the axis and the legend
    name_columns(axes, distances, tables, width_in=room / len(distances))
    axes.set_xlim(-0.4, len(distances) - 0.6)
    rating_axis(axes, tables.scale)
    lod_legend(figure, lods[::-1], lods, is_beside=True)
    return figure
