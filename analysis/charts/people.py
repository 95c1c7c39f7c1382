"""Charts of the people behind the ratings: how each uses the scale, and whom a verdict hangs on."""

from __future__ import annotations

from typing import Final

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from analysis.charts.material import Material
from analysis.charts.parts import head_columns, records, upright_in
from analysis.charts.style import (
    ALARM,
    INK,
    PAGE_WIDTH_IN,
    SMALL,
    VERDICT_COLOURS,
    message_figure,
    new_figure,
    tidy,
)
from analysis.screening.weights import observer_weights
from analysis.wording import people

OBSERVERS: Final = "Observers: leniency and inconsistency"
HEAT_MAP: Final = "What each person gave to what"
STABILITY: Final = "Does a verdict hang on one person?"
ALONE: Final = (
    "Leniency and inconsistency take two people who rated the same eyes; not so many yet."
)
NOBODY: Final = "Nobody was flagged, so no verdict had to be worked out again without anyone."
UNTRIED: Final = "Verdicts without flagged people were not worked out for these data yet."
_MOST_NAMED: Final = 12
_MOST_ROWS_NAMED: Final = 45


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


def stability_table(material: Material) -> pd.DataFrame:
    """Return the verdicts with and without flagged people."""
    if material.sensitivity is None:
        return pd.DataFrame(columns=["people", "distance", "lod", "verdict", "is_moved"])
    return material.sensitivity


def verdict_stability(material: Material) -> Figure:
    """Draw every verdict as a square: as usual, unweighted, and without each flagged person."""
    table = stability_table(material)
    if table.empty:
        reason = UNTRIED if material.flags else NOBODY
        if not material.inference.decisions:
            reason = "No verdict could hang on anyone yet."
        return message_figure(STABILITY, reason, is_simulated=material.is_simulated)
    cells = list(dict.fromkeys(zip(table["distance"], table["lod"], strict=True)))
    counted = list(dict.fromkeys(table["people"]))
    figure = new_figure(
        PAGE_WIDTH_IN,
        1.6 + upright_in([lod for _, lod in cells]) + 0.26 * len(counted),
        STABILITY,
        is_simulated=material.is_simulated,
    )
    axes = figure.subplots()
    tidy(axes, grid="")
    for row in records(table):
        x, y = cells.index((row["distance"], row["lod"])), counted.index(row["people"])
        colour = VERDICT_COLOURS.get(str(row["verdict"]), "white")
        width = 2.2 if row["is_moved"] else 0
        axes.add_patch(Rectangle((x - 0.44, y - 0.4), 0.88, 0.8, facecolor=colour, alpha=0.75,
                                 linewidth=width, edgecolor=INK))  # fmt: skip
        axes.text(x, y, _LETTERS.get(str(row["verdict"]), "–"), ha="center", va="center",
                  color="white", fontsize=SMALL, fontweight="bold")  # fmt: skip
    axes.set_xlim(-0.55, len(cells) - 0.45)
    axes.set_ylim(len(counted) - 0.5, -1.0)
    axes.set_yticks(range(len(counted)), counted)
    axes.set_xticks(range(len(cells)), [lod for _, lod in cells], rotation=90)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    head_columns(axes, [distance for distance, _ in cells])
    figure.legend(
        handles=[
            *(
                Patch(color=colour, alpha=0.75, label=f"{_LETTERS[name]} = {name}")
                for name, colour in VERDICT_COLOURS.items()
            ),
            Patch(facecolor="white", edgecolor=INK, linewidth=2.2, label="differs from the first"),
        ],
        loc="outside lower center",
        ncols=4,
        frameon=False,
        fontsize=SMALL,
    )
    return figure


_LETTERS: Final = {"equivalent": "E", "different": "D", "not shown": "?"}
