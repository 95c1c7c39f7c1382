"""Charts of the people behind the ratings: how each uses the scale, by their answers and the model.

Above, what each person's own answers say; below, what the model of ratings makes of it, drawn
towards the population, the less a person answered the more.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from analysis.charts.material import Material
from analysis.charts.style import (
    ALARM,
    INK,
    PAGE_WIDTH_IN,
    QUIET,
    SMALL,
    message_figure,
    new_figure,
    tidy,
)
from analysis.estimates.each_person import COLUMNS, each_person
from analysis.models.ordinal import INCONSISTENCY, LENIENCY, STYLE
from analysis.screening.weights import observer_weights
from analysis.tables.records import records
from analysis.words.wording import number, people

OBSERVERS: Final = "Observers: leniency, inconsistency, style"
ALONE: Final = (
    "Leniency and inconsistency take two people who rated the same eyes; not so many yet."
)
_LIGHT: Final = 0.8  # weight below which a person counts for clearly less
_MOST_NAMED: Final = 12
_MOST_DRAWN: Final = 120  # people beside each other; of more, evenly spaced ones
_NAMES: Final = {
    LENIENCY: "leniency, sd of one person's ratings\n(above 0: lenient)",
    INCONSISTENCY: "inconsistency, × the usual scatter\n(above 1: scatters more)",
    STYLE: "style, × the usual thresholds\n(above 1: avoids the ends)",
}


def observers_table(material: Material) -> pd.DataFrame:
    """Return everyone who rated: bias, inconsistency, flags, weight, and the model's estimates."""
    signals, flags = material.signals, material.flags
    weights = observer_weights(signals) if len(signals) else {}
    names = [str(who) for who in signals["participant"]]
    table = signals[["participant", "ratings", "bias", "inconsistency"]].assign(
        flags=["; ".join(flags.get(who, ())) for who in names],
        weight=[weights.get(who, 1.0) for who in names],
    )
    realism = material.inference.realism
    own = pd.DataFrame(columns=list(COLUMNS)) if realism is None else each_person(realism)
    own = own.rename(columns=_model_name).set_index("participant")
    told = own.reindex([str(who) for who in table["participant"]]).set_index(table.index)
    table = pd.concat([table, told.astype(float)], axis=1)
    return table[table["ratings"] > 0].reset_index(drop=True)


def _model_name(column: str) -> str:
    return column if column == "participant" else f"model_{column}"


def observers(material: Material) -> Figure:
    """Draw everyone's leniency and inconsistency; below them the model's shrunken estimates."""
    table = observers_table(material).dropna(subset=["bias", "inconsistency"])
    if table.empty:
        return message_figure(OBSERVERS, ALONE, is_simulated=material.is_simulated)
    effects = [own for own in _NAMES if table[f"model_{own}"].notna().any()]
    height = 3.6 + (2.4 if effects else 0.0)
    figure = new_figure(PAGE_WIDTH_IN, height, OBSERVERS, is_simulated=material.is_simulated)
    bands = figure.subfigures(
        2 if effects else 1, 1, squeeze=False, height_ratios=(3.4, 2.5)[: 1 + bool(effects)]
    )[:, 0]
    for band in bands:
        band.patch.set_visible(False)  # lets the label of simulated data show through
    _draw_answers(bands[0].subplots(), table)
    if effects:
        panels = bands[1].subplots(1, len(effects), squeeze=False)[0]
        for axes, effect in zip(panels, effects, strict=True):
            _draw_effect(axes, table, effect)
    handles, names = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=2, frameon=False,
                  fontsize=SMALL)  # fmt: skip
    return figure


def _draw_answers(axes: Axes, table: pd.DataFrame) -> None:
    """Draw bias and inconsistency of each person's own ratings; flagged people are named."""
    tidy(axes)
    is_flagged = (table["flags"] != "").to_numpy()
    is_light = (table["weight"] < _LIGHT).to_numpy() & ~is_flagged
    for mask, marker, face, name in (
        (~is_flagged & ~is_light, "o", "#56B4E9", "weight 1 or nearly"),
        (
            is_light,
            "s",
            "white",
            f"below {number(_LIGHT, digits=1)}: inconsistent or seems not to have looked",
        ),
        (is_flagged, "X", ALARM, "flagged"),
    ):
        own = table[mask]
        if len(own):
            axes.scatter(own["bias"], own["inconsistency"], s=34, marker=marker, color=face,
                         edgecolors=INK, linewidths=0.7, zorder=3,
                         label=f"{name}, {people(len(own))}")  # fmt: skip
    middle = float(np.mean(axes.get_xlim()))
    for row in records(table[is_flagged].head(_MOST_NAMED)):
        is_left = row["bias"] <= middle
        axes.annotate(
            f"{row['participant']}: {row['flags']}",
            (row["bias"], row["inconsistency"]),
            xytext=(6 if is_left else -6, 3),
            textcoords="offset points",
            ha="left" if is_left else "right",
            fontsize=SMALL,
            color=INK,
        )
    axes.axvline(0, color="#999999", linewidth=0.8, zorder=0)
    axes.margins(x=0.12, y=0.12)
    axes.set_ylim(bottom=0)
    axes.set_xlabel("leniency (bias), rating points: severe to lenient", fontsize=SMALL)
    axes.set_ylabel("inconsistency, rating points", fontsize=SMALL)


def _draw_effect(axes: Axes, table: pd.DataFrame, effect: str) -> None:
    """Draw one effect of everyone by the model with 95 % intervals, in its order."""
    tidy(axes)
    name = f"model_{effect}"
    rows = table.dropna(subset=[name]).sort_values(name, kind="stable")
    place = np.unique(np.linspace(0, len(rows) - 1, min(len(rows), _MOST_DRAWN)).round())
    rows = rows.iloc[place.astype(int)]
    x, size = place + 1, 4.5 if len(rows) < 40 else 2.5
    axes.vlines(x, rows[f"{name}_low"], rows[f"{name}_high"], colors=QUIET,
                linewidth=1.4 if len(rows) < 40 else 0.7, zorder=2)  # fmt: skip
    is_flagged = (rows["flags"] != "").to_numpy()
    for own, colour, marker in ((~is_flagged, "#56B4E9", "o"), (is_flagged, ALARM, "X")):
        axes.plot(x[own], rows[name][own], marker=marker, linestyle="", color=colour,
                  markeredgecolor=INK, markeredgewidth=0.5, markersize=size, zorder=3)  # fmt: skip
    axes.axhline(0.0 if effect == LENIENCY else 1.0, color="#999999", linewidth=0.8, zorder=0)
    axes.set_title(_NAMES[effect], fontsize=SMALL, color=INK)
    axes.set_xlabel(f"people in this order, {people(len(table))}", fontsize=SMALL - 0.5)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=6, integer=True))
