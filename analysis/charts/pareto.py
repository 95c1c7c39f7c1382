"""Realism against measured cost, both with their intervals: what is worth its milliseconds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis.charts.material import Material
from analysis.charts.parts import distance_label
from analysis.charts.scales import NO_MODEL
from analysis.charts.style import (
    INK,
    NORMAL,
    PAGE_WIDTH_IN,
    QUIET,
    SMALL,
    lod_colour,
    lod_marker,
    message_figure,
    new_figure,
    tidy,
)
from analysis.decision.pareto import ParetoPoint, pareto_table
from analysis.tables.ordering import lod_order

TITLE: Final = "Realism against measured cost"
NO_COST: Final = (
    "What each LoD costs is not known here: give the file that ocularist bench writes (--bench)."
)
NO_BOTH: Final = "No LoD was both rated by two people or more and timed at the same distance."
_GREY: Final = "#b5b5b5"
_NEAR: Final = 0.16  # of the axis: names of crosses so close are stacked
_LINE: Final = 0.085  # of the axis: height of a name


def points_table(material: Material) -> pd.DataFrame:
    """Return cost and realism of every LoD that has both, as pareto.csv has them."""
    return pareto_table(material.inference.pareto)


def realism_against_cost(material: Material) -> Figure:
    """Draw cost and realism of every LoD, one panel per distance, with the front."""
    points = material.inference.pareto
    if not points:
        reason = NO_COST if material.costs is None else NO_BOTH
        reason = NO_MODEL if material.inference.realism is None else reason
        return message_figure(TITLE, reason, is_simulated=material.is_simulated)
    distances = list(dict.fromkeys(point.distance for point in points))
    columns = min(2, len(distances))
    rows = -(-len(distances) // columns)
    figure = new_figure(
        PAGE_WIDTH_IN if columns > 1 else 4.6,
        0.7 + 2.6 * rows,
        TITLE,
        is_simulated=material.is_simulated,
    )
    grid = figure.subplots(rows, columns, squeeze=False, sharey=True).ravel().tolist()
    lods = lod_order(material.tables.ratings)
    low, high = material.tables.scale
    ends = [end for point in points for end in point.rating[1:]]
    room = 0.3 * (max(ends) - min(ends)) + 0.1  # for names above the crosses
    grid[0].set_ylim(min(ends) - 0.15, max(ends) + room)
    for place, axes in enumerate(grid):
        if place >= len(distances):
            axes.set_visible(False)
            continue
        own = [point for point in points if point.distance == distances[place]]
        _draw_panel(axes, own, lods)
        if place % columns == 0:
            axes.set_ylabel(f"mean rating, {low} to {high}", fontsize=SMALL, color=INK)
        axes.set_title(
            distance_label(distances[place], material.tables), fontsize=NORMAL, color=INK
        )
    eyes = material.costs.condition if material.costs is not None else ""
    figure.supxlabel(f"milliseconds per frame ({eyes})", fontsize=SMALL, color=INK)
    return figure


def _draw_panel(axes: Axes, points: Sequence[ParetoPoint], lods: Sequence[str]) -> None:
    tidy(axes, grid="")
    axes.grid(color="#ececec", linewidth=0.8)
    front = sorted((p for p in points if p.is_on_front), key=lambda point: point.ms[0])
    axes.plot([p.ms[0] for p in front], [p.rating[0] for p in front], color=QUIET, linewidth=1.1,
              zorder=1)  # fmt: skip
    for point in points:
        colour = lod_colour(point.lod, lods) if point.is_on_front else _GREY
        (ms, ms_low, ms_high), (rating, low, high) = point.ms, point.rating
        axes.plot([ms_low, ms_high], [rating, rating], color=colour, linewidth=1.5, zorder=2)
        axes.plot([ms, ms], [low, high], color=colour, linewidth=1.5, zorder=2)
        axes.plot([ms], [rating], marker=lod_marker(point.lod, lods), color=colour, markersize=7,
                  markeredgecolor=INK if point.is_on_front else QUIET, zorder=3)  # fmt: skip
    axes.set_xlim(0, 1.12 * max(point.ms[2] for point in points))
    _name(axes, points)


def _name(axes: Axes, points: Sequence[ParetoPoint]) -> None:
    """Write each LoD above its cross; names of crosses that lie close together are stacked."""
    low, high = axes.get_ylim()
    near, step = _NEAR * axes.get_xlim()[1], _LINE * (high - low)
    groups: list[list[ParetoPoint]] = []
    for point in sorted(points, key=lambda own: own.ms[0]):
        if groups and point.ms[0] - groups[-1][-1].ms[0] < near:
            groups[-1].append(point)
        else:
            groups.append([point])
    for own in groups:
        top = max(point.rating[2] for point in own)
        for place, point in enumerate(own):
            # The leftmost stands highest, so that no leader crosses a name.
            y = top + step * (len(own) - 1 - place) + 0.2 * step
            axes.text(point.ms[0], y, point.lod, ha="center", va="bottom", fontsize=SMALL,
                      color=INK if point.is_on_front else QUIET, zorder=4)  # fmt: skip
            axes.plot([point.ms[0]] * 2, [point.rating[2], y], color=_GREY, linewidth=0.6,
                      zorder=1)  # fmt: skip
