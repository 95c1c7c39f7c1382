"""Charts that read like a table: one row per LoD or pair, grouped by distance, panels beside it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis.charts.parts import grouped_places, head_groups
from analysis.charts.style import INK, PAGE_WIDTH_IN, QUIET, SMALL, new_figure, tidy
from analysis.tables.reading import Tables

_ROW_IN: Final = 0.29
_HEIGHT_IN: Final = 1.15  # title, axis and legend


@dataclass(frozen=True)
class Rows:
    """A figure of rows: its panels, which share the rows, and where each row stands."""

    figure: Figure
    panels: tuple[Axes, ...]
    places: tuple[float, ...]


def row_chart(
    title: str,
    tables: Tables,
    *,
    groups: Sequence[str],
    names: Sequence[str],
    widths: Sequence[float] = (1.0,),
    footer_in: float = 0.0,
) -> Rows:
    """Begin a chart with one row per name, under the heading of its distance.

    ``widths`` are those of the panels in parts; ``footer_in`` is room for a legend.
    """
    places = grouped_places(groups)
    height = _HEIGHT_IN + footer_in + _ROW_IN * (places[-1] + 1)
    figure = new_figure(PAGE_WIDTH_IN, height, title, is_simulated=tables.is_simulated)
    panels = figure.subplots(1, len(widths), squeeze=False, sharey=True, width_ratios=widths)[0]
    for axes in panels:
        tidy(axes, grid="x")
        axes.tick_params(axis="y", length=0)
    panels[0].set_yticks(places, names)
    head_groups(panels[0], places, groups, tables)
    return Rows(figure, tuple(panels), tuple(places))


def draw_span(
    axes: Axes,
    y: float,
    span: tuple[float, float, float],
    *,
    colour: str,
    marker: str = "o",
    is_open: bool = False,
    edge: str = INK,
) -> None:
    """Draw an estimate with its interval in a row; ``span`` is (value, low, high)."""
    value, low, high = span
    if math.isfinite(low) and math.isfinite(high):
        axes.plot([low, high], [y, y], color=colour, linewidth=1.8, zorder=3,
                  solid_capstyle="butt")  # fmt: skip
    axes.plot(
        [value],
        [y],
        marker=marker,
        color=colour,
        markerfacecolor="white" if is_open else colour,
        markeredgecolor=colour if is_open else edge,
        markeredgewidth=1.2 if is_open else 0.8,
        markersize=6.5,
        zorder=4,
    )


def write_beside(axes: Axes, y: float, text: str, *, colour: str = QUIET) -> None:
    """Write to the right of a row."""
    axes.text(
        1.015,
        y,
        text,
        transform=axes.get_yaxis_transform(),
        ha="left",
        va="center",
        fontsize=SMALL,
        color=colour,
    )


def span_of(row: Mapping[str, Any], name: str) -> tuple[float, float, float]:
    """Return a row's estimate with its interval, from columns like x, x_low and x_high."""
    value, low, high = (row[f"{name}{end}"] for end in ("", "_low", "_high"))
    return (value, low, high)
