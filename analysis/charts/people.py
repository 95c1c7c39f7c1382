"""Charts of the people behind the ratings: how each uses the scale, and whom a verdict hangs on."""

from __future__ import annotations

from typing import Final

import pandas as pd
from matplotlib.figure import Figure

from analysis.charts.material import Material
from analysis.charts.parts import records
from analysis.charts.style import (
    ALARM,
    INK,
    SMALL,
    message_figure,
    new_figure,
    tidy,
)
from analysis.screening.weights import observer_weights
from analysis.words.wording import people

OBSERVERS: Final = "Observers: leniency and inconsistency"
ALONE: Final = (
    "Leniency and inconsistency take two people who rated the same eyes; not so many yet."
)
_MOST_NAMED: Final = 12


def observers_table(material: Material) -> pd.DataFrame:
    """Return bias, inconsistency, flags and weight of everyone who rated."""
    signals, flags = material.signals, material.flags
    weights = observer_weights(signals) if len(signals) else {}
    names = [str(who) for who in signals["participant"]]
    table = signals[["participant", "ratings", "bias", "inconsistency"]].assign(
        flags=["; ".join(flags.get(who, ())) for who in names],
        weight=[weights.get(who, 1.0) for who in names],
    )
    return table[table["ratings"] > 0].reset_index(drop=True)


def observers(material: Material) -> Figure:
    """Draw everyone's leniency and inconsistency; flagged people are named."""
    table = observers_table(material).dropna(subset=["bias", "inconsistency"])
    if table.empty:
        return message_figure(OBSERVERS, ALONE, is_simulated=material.is_simulated)
    figure = new_figure(5.2, 3.6, OBSERVERS, is_simulated=material.is_simulated)
    axes = figure.subplots()
    tidy(axes)
    is_flagged = (table["flags"] != "").to_numpy()
    is_light = (table["weight"] < 1).to_numpy() & ~is_flagged
    for mask, marker, face, name in (
        (~is_flagged & ~is_light, "o", "#56B4E9", "counts fully"),
        (is_light, "s", "white", "weighs less: inconsistent"),
        (is_flagged, "X", ALARM, "weighs less: flagged"),
    ):
        own = table[mask]
        if len(own):
            axes.scatter(own["bias"], own["inconsistency"], s=34, marker=marker, color=face,
                         edgecolors=INK, linewidths=0.7, zorder=3,
                         label=f"{name}, {people(len(own))}")  # fmt: skip
    for row in records(table[is_flagged].head(_MOST_NAMED)):
        axes.annotate(
            f"{row['participant']}: {row['flags']}",
            (row["bias"], row["inconsistency"]),
            xytext=(6, 3),
            textcoords="offset points",
            fontsize=SMALL,
            color=INK,
        )
    axes.axvline(0, color="#999999", linewidth=0.8, zorder=0)
    axes.set_ylim(bottom=0)
    axes.margins(x=0.12)
    axes.set_xlabel("leniency (bias), rating points: severe to lenient", fontsize=SMALL)
    axes.set_ylabel("inconsistency, rating points", fontsize=SMALL)
    figure.legend(loc="outside lower center", ncols=2, frameon=False, fontsize=SMALL)
    return figure
