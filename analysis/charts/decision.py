"""The decision chart: which LoD is the cheapest that is enough, at each distance.

Shade and number are how sure that is; the word is the verdict by margins; a frame marks the answer.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from analysis.charts.forest import NO_VERDICT
from analysis.charts.material import Material
from analysis.charts.parts import MOST_COLUMNS, in_bands, name_columns, readable_on, wrapped
from analysis.charts.stability import stability_sentence
from analysis.charts.style import (
    INK,
    NORMAL,
    PAGE_WIDTH_IN,
    QUIET,
    SMALL,
    message_figure,
    new_figure,
    shade,
    tidy,
)
from analysis.decision.verdicts import NOT_SHOWN
from analysis.tables.ordering import distance_order, lod_order
from analysis.tables.records import records
from analysis.words.wording import milliseconds, percent

NO_ORDER: Final = (
    "The LoDs beside the best one have no rank, so none is the cheapest of a sequence. Each has a "
    "verdict of its own: the sentences above, and the chart of what is lost."
)
TITLE: Final = "Which LoD is enough, and how sure that is"
REFERENCE: Final = "reference"
_COLUMNS: Final = ("distance", "lod", "verdict", "is_tested", "share_cheapest", "chosen", "ms")
_ROW_IN: Final = 0.62


def decision_cells(material: Material) -> pd.DataFrame:
    """Return one row per distance and LoD that takes part in a decision, the highest too.

    Columns: distance, lod, verdict (``REFERENCE`` for the highest LoD), is_tested, share_cheapest,
    chosen, ms (per frame; empty where it was not measured).
    """
    rows: list[tuple[object, ...]] = []
    for decision in material.inference.decisions:
        where, best = decision.distance, decision.best
        rows.append((where, best, REFERENCE, True, decision.best_share, decision.lod == best,
                     _ms(material, where, best)))  # fmt: skip
        rows += [
            (where, v.lod, v.outcome, v.is_reached, v.share_cheapest, decision.lod == v.lod,
             _ms(material, where, v.lod))
            for v in decision.verdicts
        ]  # fmt: skip
    return pd.DataFrame(rows, columns=list(_COLUMNS))


def decision_chart(material: Material) -> Figure:
    """Draw, per distance and LoD, the share of draws in which it is the cheapest that is enough."""
    table = decision_cells(material)
    if table.empty:
        reason = NO_ORDER if material.inference.effects else NO_VERDICT
        return message_figure(TITLE, reason, is_simulated=material.is_simulated)
    tables = material.tables
    distances = [d for d in distance_order(tables.ratings) if d in set(table["distance"])]
    lods = [lod for lod in lod_order(tables.ratings) if lod in set(table["lod"])][::-1]
    bands = in_bands(distances, MOST_COLUMNS)
    columns = len(bands[0])
    width = min(PAGE_WIDTH_IN, 1.4 + 1.4 * max(2, columns))
    figure = new_figure(
        width,
        0.85 + (0.45 + _ROW_IN * len(lods)) * len(bands),
        TITLE,
        is_simulated=tables.is_simulated,
    )
    cells = {(row["distance"], row["lod"]): row for row in records(table)}
    for axes, own in zip(figure.subplots(len(bands), squeeze=False)[:, 0], bands, strict=True):
        tidy(axes, grid="")
        for x, distance in enumerate(own):
            for y, lod in enumerate(lods):
                _draw_cell(axes, x, y, cells.get((distance, lod)))
        axes.set_xlim(-0.5, columns - 0.5)
        axes.set_ylim(len(lods) - 0.5, -0.5)
        name_columns(axes, own, tables, width_in=(width - 1.2) / columns)
        axes.set_yticks(range(len(lods)), lods)
        axes.tick_params(length=0, labelsize=NORMAL)
        axes.spines[:].set_visible(False)
    told = stability_sentence(material)
    if told:
        chars = int(15 * figure.get_figwidth())
        figure.supxlabel(wrapped(told, chars), fontsize=SMALL, color=INK)
    return figure


def _draw_cell(axes: Axes, x: int, y: int, cell: dict[str, Any] | None) -> None:
    place, size = (x - 0.47, y - 0.45), (0.94, 0.90)
    if cell is None:
        axes.add_patch(Rectangle(place, *size, facecolor="white", edgecolor="#d5d5d5",
                                 hatch="////", linewidth=0, zorder=0.5))  # fmt: skip
        axes.text(x, y, "not rated", ha="center", va="center", fontsize=SMALL, color=QUIET,
                  bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5})  # fmt: skip
        return
    colour = shade(cell["share_cheapest"])
    ink = readable_on(colour)
    axes.add_patch(Rectangle(place, *size, facecolor=colour, linewidth=0, zorder=0.5))
    if cell["chosen"]:
        axes.add_patch(Rectangle(place, *size, facecolor="none", edgecolor=INK, linewidth=2.4,
                                 zorder=3))  # fmt: skip
    verdict = str(cell["verdict"])
    if verdict == NOT_SHOWN and not cell["is_tested"]:
        verdict = "not tested"
    price = f", {milliseconds(cell['ms'])}" if np.isfinite(cell["ms"]) else ""
    axes.text(x, y - 0.17, percent(cell["share_cheapest"]), ha="center", va="center", color=ink,
              fontsize=NORMAL + 2, fontweight="bold" if cell["chosen"] else "normal")  # fmt: skip
    axes.text(x, y + 0.2, f"{verdict}{price}", ha="center", va="center", color=ink,
              fontsize=SMALL)  # fmt: skip


def _ms(material: Material, distance: str, lod: str) -> float:
    found = material.costs.ms(distance, lod) if material.costs is not None else None
    return np.nan if found is None else found
