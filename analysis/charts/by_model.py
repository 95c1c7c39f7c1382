"""Perceived against actual LoD by the ordinal model: the latent scale, and each rating's share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from analysis.charts.by_model_table import by_model_table
from analysis.charts.material import Material
from analysis.charts.parts import apart, distance_label, readable_on, wrapped
from analysis.charts.scales import NO_MODEL
from analysis.charts.style import (
    INK,
    PAGE_WIDTH_IN,
    SMALL,
    lod_colour,
    lod_marker,
    message_figure,
    new_figure,
    scale_colours,
    tidy,
)
from analysis.charts.trends import NO_ORDER, tau_sentence
from analysis.correlation import rank_correlations
from analysis.tables.records import records
from analysis.words.wording import number

BY_MODEL: Final = "Perceived against actual LoD, by the model"
_TOP_IN: Final = 2.6
_PANEL_IN: Final = 2.1
_MOST_COLUMNS: Final = 4
_DASHES: Final[tuple[Any, ...]] = ("-", (0, (5, 1.5)), (0, (3, 1.2, 1, 1.2)), (0, (1, 1.2)))


def perceived_by_model(material: Material) -> Figure:
    """Draw the latent scale, a line per distance, and under it the ratings' shares per LoD."""
    table = by_model_table(material)
    if table.empty:
        reason = NO_MODEL if material.inference.realism is None else NO_ORDER
        return message_figure(BY_MODEL, reason, is_simulated=material.is_simulated)
    distances = list(dict.fromkeys(table["distance"]))
    lods = list(table.drop_duplicates("lod").sort_values("lod_rank")["lod"])
    columns = min(_MOST_COLUMNS, len(distances))
    bands = -(-len(distances) // columns)
    figure = new_figure(
        PAGE_WIDTH_IN,
        0.9 + _TOP_IN + _PANEL_IN * bands,
        BY_MODEL,
        is_simulated=material.is_simulated,
    )
    parts = figure.subfigures(2, 1, squeeze=False, height_ratios=(_TOP_IN, _PANEL_IN * bands + 0.2))
    _draw_latent(parts[0, 0], material, table, lods=lods)
    _draw_shares(parts[1, 0], material, table, lods=lods)
    return figure


def _draw_latent(
    part: FigureBase, material: Material, table: pd.DataFrame, *, lods: Sequence[str]
) -> None:
    axes, beside = part.subplots(1, 2, width_ratios=(1.35, 1.0), sharey=True)
    beside.set_axis_off()
    tidy(axes)
    distances = list(dict.fromkeys(table["distance"]))
    table = table[table["rating"] == table["rating"].min()]  # places stand beside each rating
    place = {lod: float(i) for i, lod in enumerate(lods)}
    aside = np.linspace(-0.12, 0.12, len(distances)) if len(distances) > 1 else np.zeros(1)
    for k, distance in enumerate(distances):
        own = records(table[table["distance"] == distance])
        x = [place[row["lod"]] + aside[k] for row in own]
        axes.plot(x, [row["latent"] for row in own], color=INK, linewidth=1.2,
                  linestyle=_DASHES[k % len(_DASHES)], zorder=2)  # fmt: skip
        for at, row in zip(x, own, strict=True):
            is_zero = row["latent_low"] == row["latent_high"]
            ends = [] if is_zero else [row["latent_low"], row["latent_high"]]
            axes.plot([at] * len(ends), ends, color=lod_colour(row["lod"], lods), zorder=3)
            axes.plot([at], [row["latent"]], marker=lod_marker(row["lod"], lods), zorder=4,
                      color=lod_colour(row["lod"], lods), markeredgecolor=INK,
                      markeredgewidth=0.8, markersize=6.5)  # fmt: skip
    axes.set_xticks(range(len(lods)), [wrapped(lod, 14) for lod in lods])
    axes.set_xlim(-0.35, len(lods) - 0.65)
    axes.set_ylabel("latent realism,\nsd of one person's ratings", fontsize=SMALL)
    _name_lines(beside, material, table)


def _name_lines(axes: Axes, material: Material, table: pd.DataFrame) -> None:
    """Write each distance at its line's end, with how steep the line is and how sure that is."""
    found = {row["distance"]: row for row in records(rank_correlations(material.tables.ratings))}
    low, high = axes.get_ylim()
    last = table.drop_duplicates("distance", keep="last").reset_index(drop=True)
    rows = records(last)
    places = apart([row["latent"] for row in rows], least=0.21 * (high - low), low=low, high=high)
    for k, (row, y) in enumerate(zip(rows, places, strict=True)):
        slope = f"{number(row['slope'])} per LoD [{number(row['slope_low'])}, "
        text = f"{row['distance']}: {slope}{number(row['slope_high'])}]"
        if row["distance"] in found:
            text += f"\n{tau_sentence(found[row['distance']])}"
        across = axes.get_yaxis_transform()
        axes.text(0.1, y, text, transform=across, va="center", fontsize=SMALL - 0.5, color=INK)
        axes.plot([0.0, 0.08], [y, y], transform=across, color=INK, linewidth=1.2,
                  linestyle=_DASHES[k % len(_DASHES)])  # fmt: skip


def _draw_shares(
    part: FigureBase, material: Material, table: pd.DataFrame, *, lods: Sequence[str]
) -> None:
    low, high = material.tables.scale
    steps = range(low, high + 1)
    colours = scale_colours(len(steps))
    distances = list(dict.fromkeys(table["distance"]))
    columns = min(_MOST_COLUMNS, len(distances))
    bands = -(-len(distances) // columns)
    panels = part.subplots(bands, columns, squeeze=False, sharey=True).ravel()
    for axes, distance in zip(panels, distances, strict=False):
        tidy(axes, grid="")
        own = table[table["distance"] == distance]
        model, given = (
            own.pivot(index="lod", columns="rating", values=name).loc[own["lod"].unique()]
            for name in ("predicted", "share")
        )
        x = np.array([lods.index(lod) for lod in model.index], dtype=float)
        bottom = np.zeros(len(model))
        for step, colour in zip(steps, colours, strict=True):
            share = model[step].to_numpy(dtype=float)
            axes.bar(x, share, bottom=bottom, width=0.78, color=colour, edgecolor="white",
                     linewidth=0.6)  # fmt: skip
            for at, under, part_of in zip(x, bottom, share, strict=True):
                if part_of > 0.085:
                    axes.text(at, under + part_of / 2, f"{100 * part_of:.0f}", ha="center",
                              va="center", fontsize=6.5, color=readable_on(colour))  # fmt: skip
            bottom += share
        told = given[list(steps[:-1])].to_numpy(dtype=float).cumsum(axis=1)
        start = np.repeat(x + 0.17, told.shape[1])
        axes.hlines(told.ravel(), start, start + 0.26, color=INK, linewidth=1.1, zorder=3)
        _finish(axes, distance, material, lods=lods)
    for axes in panels[len(distances) :]:
        axes.set_visible(False)
    for axes in panels[::columns]:
        axes.set_ylabel("share of ratings", fontsize=SMALL)
    part.legend(
        handles=[
            *(Patch(color=c, label=str(k)) for k, c in zip(steps, colours, strict=True)),
            Line2D([], [], color=INK, linewidth=1.1, label="as given, added up"),
        ],
        loc="outside lower center",
        ncols=min(7, len(steps) + 1),
        frameon=False,
        fontsize=SMALL,
    )


def _finish(axes: Axes, distance: str, material: Material, *, lods: Sequence[str]) -> None:
    is_long = max(map(len, lods)) > 7 or len(lods) > 4
    axes.set_xticks(range(len(lods)), lods, rotation=90 if is_long else 0)
    axes.tick_params(axis="x", length=0, labelsize=SMALL - 1)
    axes.set_xlim(-0.6, len(lods) - 0.4)
    axes.set_ylim(0, 1)
    axes.yaxis.set_major_formatter(lambda value, _: f"{100 * value:.0f} %")
    label = distance_label(distance, material.tables, joint="\n")
    axes.set_title(label, fontsize=SMALL, color=INK)
