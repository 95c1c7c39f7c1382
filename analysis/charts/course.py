"""How answers change while a session lasts: warming up, tiring, hurrying."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from analysis.charts.material import Material
from analysis.charts.style import (
    INK,
    PAGE_WIDTH_IN,
    QUIET,
    SMALL,
    message_figure,
    new_figure,
    tidy,
)
from analysis.descriptive.means import answered, t_interval
from analysis.tables.records import records
from analysis.words.wording import people

COURSE: Final = "Over the session"
NO_POSITIONS: Final = (
    "The table does not say in which order people answered, or nobody has answered yet."
)
_COLUMNS: Final = ("first", "last", "people", "change", "low", "high", "response_s")
_MOST_POINTS: Final = 20


def course_table(material: Material) -> pd.DataFrame:
    """Return, per place in the session, how ratings differ from what the same eyes were given.

    Columns: first and last (positions of trials, from 1), people, change (rating minus the mean of
    the same eye in the same clip, minus the person's mean of that; mean over people), low and high
    (its 95 % t interval), response_s (median over people of their median). Long sessions are cut
    into at most 20 parts.
    """
    rows = answered(material.tables.ratings)
    rows = rows[rows["position"].notna()]
    if rows.empty:
        return pd.DataFrame(columns=list(_COLUMNS))
    what = rows.groupby(["clip", "eye", "lod"], dropna=False)["rating"].transform("mean")
    away = rows["rating"] - what
    change = away - away.groupby(rows["participant"]).transform("mean")
    position = rows["position"].astype(int)
    step = -(-int(position.max()) // _MOST_POINTS)
    seconds = rows["response_ms"].astype("Float64").to_numpy(dtype=float, na_value=np.nan) / 1000
    cells = pd.DataFrame(
        {
            "participant": rows["participant"],
            "part": (position - 1) // step,
            "change": change,
            "seconds": seconds,
        }
    )
    own = cells.groupby(["part", "participant"]).agg(
        change=("change", "mean"), seconds=("seconds", "median")
    )
    table = []
    for part in sorted(set(cells["part"])):
        group = own.loc[part]
        low, high = t_interval(group["change"])
        first = part * step + 1
        last = min(first + step - 1, int(position.max()))
        table.append((first, last, len(group), group["change"].mean(), low, high,
                      group["seconds"].median()))  # fmt: skip
    return pd.DataFrame(table, columns=list(_COLUMNS))


def over_the_session(material: Material) -> Figure:
    """Draw the drift of ratings and the time that answers take, by position in the session."""
    table = course_table(material)
    if table.empty:
        return message_figure(COURSE, NO_POSITIONS, is_simulated=material.is_simulated)
    figure = new_figure(PAGE_WIDTH_IN, 2.7, COURSE, is_simulated=material.is_simulated)
    drift, time = figure.subplots(1, 2)
    x = (table["first"] + table["last"]).to_numpy(dtype=float) / 2
    for at, row in zip(x, records(table), strict=True):
        drift.plot([at, at], [row["low"], row["high"]], color=INK, linewidth=1.3)
    drift.plot(x, table["change"], color=QUIET, linewidth=1.0, marker="o", markersize=4.5,
               markerfacecolor="#0072B2", markeredgecolor=INK)  # fmt: skip
    drift.axhline(0, color="#999999", linewidth=0.8, zorder=0)
    top = max(0.5, 1.15 * float(np.nanmax(np.abs(table[["change", "low", "high"]].to_numpy()))))
    drift.set_ylim(-top, top)
    drift.set_ylabel("rating minus that of the same eye,\npoints", fontsize=SMALL)
    if table["response_s"].notna().any():
        time.plot(x, table["response_s"], color=QUIET, linewidth=1.0, marker="o", markersize=4.5,
                  markerfacecolor="#0072B2", markeredgecolor=INK)  # fmt: skip
        time.set_ylim(0, 1.15 * float(table["response_s"].max()))
        time.set_ylabel("median response, s", fontsize=SMALL)
    else:
        time.set_visible(False)
    least, most = int(table["people"].min()), int(table["people"].max())
    count = people(most) if least == most else f"n from {least} to {most}"
    for axes in (drift, time):
        tidy(axes)
        axes.set_xlabel(f"position of the trial ({count})", fontsize=SMALL)
        axes.xaxis.get_major_locator().set_params(integer=True)
    return figure
