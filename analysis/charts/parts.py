"""What several charts share: labels of distances, legends, rows in groups."""

from __future__ import annotations

import itertools
import math
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from analysis.charts.long_names import LONGEST
from analysis.charts.style import INK, SMALL, lod_colour, lod_marker
from analysis.tables.reading import Tables

MOST_COLUMNS: Final = 7
"""How many columns of cells with numbers a page is wide enough for."""
_LETTER_IN: Final = 0.065
_LARGE_LETTER_IN: Final = 0.08
_LEAST_WIDTH_IN: Final = 0.75  # of a column whose name lies


def distance_label(distance: str, tables: Tables, *, joint: str = ", ") -> str:
    """Name a distance together with the iris's diameter there, if it is known.

    Clips of several sizes have irises of several; then the smallest and the largest are named.
    """
    own = tables.ratings.loc[tables.ratings["distance"] == distance, "iris_px"].dropna()
    if own.empty:
        return distance
    low, high = own.min(), own.max()
    size = f"{low:.0f} to {high:.0f}" if high > 1.1 * low else f"{own.median():.0f}"
    return f"{distance}{joint}iris {size} px"


def clip_label(clip: str) -> str:
    """Name a clip: "clip 4" where its name is only a number."""
    return f"clip {clip}" if clip[:1].isdigit() else clip


def lod_legend(
    figure: Figure, shown: Sequence[str], lods: Sequence[str], *, is_beside: bool = False
) -> None:
    """Explain the LoDs' colours and markers below the panels, or beside them."""
    handles = [
        Line2D(
            [],
            [],
            marker=lod_marker(lod, lods),
            color=lod_colour(lod, lods),
            linestyle="",
            markeredgecolor=INK,
            markersize=7,
            label=lod,
        )
        for lod in shown
    ]
    if is_beside:
        figure.legend(
            handles=handles,
            loc="outside right center",
            frameon=False,
            fontsize=SMALL,
            title="LoD",
            title_fontsize=SMALL,
        )
    else:
        figure.legend(
            handles=handles,
            loc="outside lower center",
            ncols=legend_columns(shown, figure.get_figwidth()),
            frameon=False,
            fontsize=SMALL,
        )


def legend_columns(names: Sequence[str], width_in: float) -> int:
    """Return how many names with their symbols stand in a row of a legend of that width."""
    return max(1, min(len(names), int(width_in / (0.55 + upright_in(names)))))


def apart(places: Sequence[float], *, least: float, low: float, high: float) -> list[float]:
    """Move places, in any order, at least ``least`` apart, within ``low`` to ``high`` if they fit.

    They keep their order and move as little as that takes from below.
    """
    order = sorted(range(len(places)), key=lambda i: places[i])
    moved = list(places)
    for before, after in itertools.pairwise(order):
        moved[after] = max(moved[after], moved[before] + least)
    limit = high
    for i in reversed(order):
        moved[i] = max(low, min(moved[i], limit))
        limit = moved[i] - least
    return moved


def wrapped(name: str, width: int) -> str:
    """Break a name into lines of at most ``width`` characters, at spaces or behind hyphens."""
    return textwrap.fill(name, width, break_long_words=False)


def upright_in(labels: Iterable[str], *, names: int = 1) -> float:
    """Return about how many inches labels take that stand upright below an axis.

    Each has as many ``names`` in it, which are shortened where they are too long.
    """
    most = names * (LONGEST + 5)
    return _LETTER_IN * max((min(len(label), most) for label in labels), default=0)


def in_bands(names: Sequence[str], most: int) -> list[list[str]]:
    """Part names into rows of about equal length, of at most ``most`` each."""
    parts = np.array_split(np.array(names, dtype=object), max(1, -(-len(names) // most)))
    return [[str(name) for name in part] for part in parts]


def name_columns(axes: Axes, distances: Sequence[str], tables: Tables, *, width_in: float) -> None:
    """Name a panel's columns by distance: in lines as long as a column is wide, or upright."""
    is_narrow = width_in < _LEAST_WIDTH_IN
    joint = ", " if is_narrow else "\n"
    labels = [distance_label(distance, tables, joint=joint) for distance in distances]
    if not is_narrow:
        letters = int(width_in / _LARGE_LETTER_IN)
        labels = [
            "\n".join(textwrap.fill(line, letters) for line in label.split("\n"))
            for label in labels
        ]
    axes.set_xticks(range(len(labels)), labels, rotation=90 if is_narrow else 0)


def grouped_places(groups: Sequence[str]) -> list[float]:
    """Return one place per row, from 1, with a gap wherever the group changes."""
    places: list[float] = []
    at = 0.0
    for number, group in enumerate(groups):
        at += 1.0 if number == 0 or group == groups[number - 1] else 1.75
        places.append(at)
    return places


def head_groups(axes: Axes, places: Sequence[float], groups: Sequence[str], tables: Tables) -> None:
    """Write each distance above its first row and let the vertical axis run downwards."""
    axes.tick_params(axis="y", length=0)
    axes.set_ylim(places[-1] + 0.6, places[0] - 1.0)
    for number, (y, distance) in enumerate(zip(places, groups, strict=True)):
        if number == 0 or distance != groups[number - 1]:
            axes.text(
                0,
                y - 0.52,
                distance_label(distance, tables),
                transform=axes.get_yaxis_transform(),
                ha="left",
                va="bottom",
                fontsize=SMALL,
                fontweight="bold",
                color=INK,
            )


def draw_mean(
    axes: Axes, x: float, row: Mapping[str, Any], *, lods: Sequence[str], colour: str = INK
) -> None:
    """Draw one mean with its interval; ``row`` has lod, mean, low and high."""
    if math.isfinite(row["low"]):
        axes.plot([x, x], [row["low"], row["high"]], color=colour, linewidth=1.3, zorder=3)
    axes.plot(
        [x],
        [row["mean"]],
        marker=lod_marker(row["lod"], lods),
        color=lod_colour(row["lod"], lods),
        markeredgecolor=INK,
        markeredgewidth=0.9,
        markersize=7.5,
        zorder=4,
    )


def readable_on(colour: str) -> str:
    """Return dark or white, whichever is legible on a colour given as #rrggbb."""
    red, green, blue = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    return INK if 0.3 * red + 0.59 * green + 0.11 * blue > 140 else "white"


def head_columns(axes: Axes, distances: Sequence[str]) -> None:
    """Write each distance over its columns and part them by a line."""
    named = dict.fromkeys(distances)
    turn = 90 if len(named) > MOST_COLUMNS else 0
    for distance in named:
        own = [i for i, name in enumerate(distances) if name == distance]
        axes.text(float(np.mean(own)), -0.75, distance, ha="center", va="bottom", fontsize=SMALL,
                  fontweight="bold", color=INK, rotation=turn)  # fmt: skip
        if own[0]:
            axes.axvline(own[0] - 0.5, color="white", linewidth=3)
