"""Does the scatter between people look like that of a rating scale? Variance against mean rating.

On a bounded scale the variance of a stimulus follows a (m - low) (high - m); the SOS hypothesis
(Hossfeld, Schatz and Egger 2011) says one a fits a whole experiment. Points far above it are eyes
that split people.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from analysis.charts.material import Material
from analysis.charts.parts import lod_legend
from analysis.charts.style import (
    INK,
    QUIET,
    SMALL,
    lod_colour,
    lod_marker,
    message_figure,
    new_figure,
    tidy,
)
from analysis.descriptive.means import mean_ratings
from analysis.descriptive.shares import clips_or_pairings
from analysis.tables.ordering import lod_order
from analysis.tables.records import records
from analysis.words.wording import number

SPREAD: Final = "Where people disagree"
TOO_FEW: Final = "It takes two people who rated the same eye; there are not so many yet."


def spread_table(material: Material) -> pd.DataFrame:
    """Return mean and variance over people of every eye as it was shown, and the curve's ``a``.

    Of many clips those of one pairing of LoDs are taken together.
    """
    keys = ["distance", "clip", "eye", "lod"]
    means = mean_ratings(clips_or_pairings(material.tables.ratings), keys)
    table = means[means["people"] > 1].assign(variance=lambda t: t["sd"] ** 2)
    table = table[[*keys, "people", "mean", "variance"]].reset_index(drop=True)
    low, high = material.tables.scale
    bound = ((table["mean"] - low) * (high - table["mean"])).to_numpy(dtype=float)
    norm = float(bound @ bound)
    a = float(bound @ table["variance"].to_numpy(dtype=float)) / norm if norm else np.nan
    return table.assign(a=a)


def spread_of_ratings(material: Material) -> Figure:
    """Draw the variance between people against the mean rating, with the fitted curve."""
    table = spread_table(material)
    if table.empty:
        return message_figure(SPREAD, TOO_FEW, is_simulated=material.is_simulated)
    lods = lod_order(material.tables.ratings)
    figure = new_figure(4.8, 3.4, SPREAD, is_simulated=material.is_simulated)
    axes = figure.subplots()
    tidy(axes)
    low, high = material.tables.scale
    m, a = np.linspace(low, high, 101), float(table["a"].iloc[0])
    if np.isfinite(a):
        axes.plot(m, a * (m - low) * (high - m), color=QUIET, linewidth=1.2, zorder=1)
        axes.text(0.99, 0.99, f"a = {number(a)}", transform=axes.transAxes, ha="right", va="top",
                  fontsize=SMALL, color=INK)  # fmt: skip
    for row in records(table):
        axes.plot([row["mean"]], [row["variance"]], marker=lod_marker(row["lod"], lods),
                  color=lod_colour(row["lod"], lods), markeredgecolor=INK, markeredgewidth=0.7,
                  markersize=5.5, linestyle="")  # fmt: skip
    least, most = int(table["people"].min()), int(table["people"].max())
    count = f"n = {most}" if least == most else f"n = {least} to {most}"
    axes.set_xlim(low - 0.1, high + 0.1)
    axes.set_ylim(0, 1.12 * float(max(table["variance"].max(), a * (high - low) ** 2 / 4, 0.1)))
    axes.set_xticks(range(low, high + 1))
    axes.set_xlabel(f"mean rating of an eye in a clip ({count} each)", fontsize=SMALL)
    axes.set_ylabel("variance between people, points²", fontsize=SMALL)
    shown = [lod for lod in lods if lod in set(table["lod"])]
    lod_legend(figure, shown, lods, is_beside=True)
    return figure
