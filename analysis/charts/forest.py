"""The contrasts behind the verdicts: loss of realism and noticing beside the highest LoD.

Each against its margin, in the order in which the LoDs are tested.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from analysis.charts.material import Material
from analysis.charts.rows import draw_span, row_chart, write_beside
from analysis.charts.style import INK, SMALL, VERDICT_COLOURS, VERDICT_MARKERS, message_figure
from analysis.decision.verdict_tables import effect_table, verdict_table
from analysis.decision.verdicts import NOT_SHOWN
from analysis.tables.records import records
from analysis.words.wording import number, people, percent

TITLE: Final = "What is lost against the highest LoD, and who notices"
_COLUMNS: Final = (
    *("distance", "lod", "best", "change", "verdict", "is_tested", "chosen"),
    *("realism_loss", "realism_loss_low", "realism_loss_high", "realism_margin"),
    *("noticed_excess", "noticed_excess_low", "noticed_excess_high", "noticed_margin"),
)
NO_VERDICT: Final = "No LoD can be compared with the highest one yet."


def contrasts(material: Material) -> pd.DataFrame:
    """Return verdicts on LoDs with a rank in their order of testing, then on those without one.

    Columns are those of decision.csv that are drawn, change (what a LoD without a rank lacks) and
    people (who rated the LoD there).
    """
    inference = material.inference
    ranked = verdict_table(list(inference.decisions))
    others = effect_table(inference.effects).assign(is_tested=True, chosen=False)
    parts = [part for part in (ranked, others) if len(part)]
    if not parts or inference.realism is None:
        return pd.DataFrame(columns=["distance", "lod", "verdict"])
    table = pd.concat(parts, ignore_index=True)
    table["order"] = table["distance"].map(_places(inference.realism.cells))
    table = table.sort_values("order", kind="stable", ignore_index=True).drop(columns="order")
    counts = inference.realism.table().set_index(["distance", "lod"])["people"]
    cells = zip(table["distance"], table["lod"], strict=True)
    names = [name for name in _COLUMNS if name in table]
    return table[names].assign(people=[int(counts[cell]) for cell in cells])


def _places(cells: Sequence[tuple[str, str]]) -> dict[str, int]:
    return {distance: i for i, distance in enumerate(dict.fromkeys(cell[0] for cell in cells))}


def contrasts_against_margins(material: Material) -> Figure:
    """Draw every LoD's loss of realism and excess of noticing with their margins."""
    table = contrasts(material)
    if table.empty:
        return message_figure(TITLE, NO_VERDICT, is_simulated=material.is_simulated)
    rows = records(table)
    has_notices = bool(table["noticed_excess"].notna().any())
    chart = row_chart(
        TITLE,
        material.tables,
        groups=[str(row["distance"]) for row in rows],
        names=[_name(row) for row in rows],
        widths=(1.25, 1.0) if has_notices else (1.0,),
        footer_in=0.25,
    )
    loss = chart.panels[0]
    for y, row in zip(chart.places, rows, strict=True):
        _draw(loss, y, row, "realism_loss")
        if has_notices and np.isfinite(row["noticed_excess"]):
            _draw(chart.panels[1], y, row, "noticed_excess")
        write_beside(chart.panels[-1], y, _verdict(row), colour=INK)
    margins = material.inference.margins
    _margin(loss, margins.realism_points, f"margin {number(margins.realism_points)}")
    loss.set_xlabel("loss of realism, points of the rating scale", fontsize=SMALL)
    if has_notices:
        share = margins.noticed_share
        _margin(chart.panels[1], share, f"margin {percent(share)}")
        chart.panels[1].set_xlabel("noticed by, beyond false alarms", fontsize=SMALL)
        chart.panels[1].xaxis.set_major_formatter(lambda value, _: f"{100 * value:.0f} %")
        low, high = chart.panels[1].get_xlim()
        chart.panels[1].set_xlim(min(low, -0.1), max(high, 0.5))
    _legend(chart.figure, [str(name) for name in table["verdict"]])
    return chart.figure


def _name(row: dict[str, object]) -> str:
    change = row.get("change")
    lacks = str(change) if isinstance(change, str) and change else str(row["lod"])
    return lacks if " " in lacks else f"{row['best']} − {lacks}"


def _verdict(row: dict[str, object]) -> str:
    name = str(row["verdict"])
    if name == NOT_SHOWN and not row["is_tested"]:
        name = "not tested"
    return f"{name}, {people(int(str(row['people'])))}"


def _draw(axes: Axes, y: float, row: dict[str, object], name: str) -> None:
    value, low, high = (float(str(row[f"{name}{end}"])) for end in ("", "_low", "_high"))
    verdict = str(row["verdict"])
    draw_span(
        axes,
        y,
        (value, low, high),
        colour=VERDICT_COLOURS[verdict],
        marker=VERDICT_MARKERS[verdict],
        is_open=verdict == NOT_SHOWN,
    )


def _margin(axes: Axes, margin: float, text: str) -> None:
    axes.axvline(0, color="#999999", linewidth=0.8, zorder=1)
    axes.axvline(margin, color=INK, linewidth=1.2, linestyle=(0, (4, 2)), zorder=2)
    axes.annotate(
        text,
        (margin, 1),
        xycoords=("data", "axes fraction"),
        xytext=(3, 0),
        textcoords="offset points",
        ha="left",
        va="bottom",
        fontsize=SMALL,
        color=INK,
    )
    low, high = axes.get_xlim()
    axes.set_xlim(low, max(high, margin * 1.3))


def _legend(figure: Figure, shown: Sequence[str]) -> None:
    handles = [
        Line2D(
            [],
            [],
            color=colour,
            marker=VERDICT_MARKERS[name],
            markerfacecolor="white" if name == NOT_SHOWN else colour,
            markeredgecolor=colour if name == NOT_SHOWN else INK,
            linewidth=1.8,
            label=name,
        )
        for name, colour in VERDICT_COLOURS.items()
        if name in shown
    ]
    figure.legend(
        handles=handles, loc="outside lower center", ncols=3, frameon=False, fontsize=SMALL
    )
