"""The scales that the models find: latent realism, and preference in JOD."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from analysis.charts.material import Material
from analysis.charts.rows import draw_span, row_chart, span_of, write_beside
from analysis.charts.style import (
    QUIET,
    SMALL,
    lod_colour,
    lod_marker,
    message_figure,
)
from analysis.descriptive.means import mean_ratings
from analysis.estimates.preference import Preference
from analysis.tables.ordering import lod_order
from analysis.tables.records import records
from analysis.words.wording import people

LATENT: Final = "Realism by the ordinal mixed model"
PREFERENCE: Final = "Preference scale per distance"
NO_MODEL: Final = "It takes ratings of two people or more; there are not so many yet."
NO_SCALE: Final = "Two people or more have to compare different LoDs; there are not so many yet."


def latent_table(material: Material) -> pd.DataFrame:
    """Return the model's table with the plain means of ratings beside it (columns mean_...)."""
    realism = material.inference.realism
    if realism is None:
        return pd.DataFrame(columns=["distance", "lod"])
    means = mean_ratings(material.tables.ratings, ["distance", "lod"])
    plain = means.rename(columns={"low": "mean_low", "high": "mean_high"})
    keys = ["distance", "lod"]
    return realism.table().merge(plain[[*keys, "mean", "mean_low", "mean_high"]], on=keys)


def latent_realism(material: Material) -> Figure:
    """Draw the LoDs' places on the latent scale, and the mean ratings that follow from them."""
    table = latent_table(material)
    if table.empty:
        return message_figure(LATENT, NO_MODEL, is_simulated=material.is_simulated)
    rows, lods = records(table), lod_order(material.tables.ratings)
    chart = row_chart(
        LATENT,
        material.tables,
        groups=[str(row["distance"]) for row in rows],
        names=[str(row["lod"]) for row in rows],
        widths=(1.0, 1.0),
    )
    latent, rating = chart.panels
    for i, (y, row) in enumerate(zip(chart.places, rows, strict=True)):
        colour, marker = lod_colour(row["lod"], lods), lod_marker(row["lod"], lods)
        ends = (row["latent_low"], row["latent_high"]) if i else (np.nan, np.nan)
        draw_span(latent, y, (row["latent"], *ends), colour=colour, marker=marker)
        draw_span(rating, y, span_of(row, "rating"), colour=colour, marker=marker)
        draw_span(rating, y + 0.27, span_of(row, "mean"), colour=QUIET, marker=".", edge=QUIET)
        write_beside(rating, y, people(row["people"]))
    low, high = material.tables.scale
    first = f"{rows[0]['lod']} at {rows[0]['distance']} = 0"
    latent.set_xlabel(f"latent realism, sd of one person's ratings\n({first})", fontsize=SMALL)
    rating.set_xlabel(f"mean rating, {low} to {high}\n(grey: plain mean of people)", fontsize=SMALL)
    rating.set_xlim(low - 0.1, high + 0.1)
    rating.set_xticks(range(low, high + 1))
    return chart.figure


def preference_table(material: Material) -> pd.DataFrame:
    """Return the preference scale, each LoD with its step to the next higher one (``step_...``).

    Empty steps: there is no higher LoD that comparisons link it to. ``is_step_clear`` says whether
    the 95 % interval of the step leaves 0 out.
    """
    preference = material.inference.preference
    if preference is None:
        return pd.DataFrame(columns=["distance", "lod", "reference", "jod"])
    table = preference.table()
    steps = [_step(preference, i) for i in range(len(table))]
    names = ("step_low", "step_high")
    made = table.assign(**{name: [s[k] for s in steps] for k, name in enumerate(names)})
    made["is_step_clear"] = (made["step_low"] > 0) | (made["step_high"] < 0)
    order = made.groupby(["distance", "reference"], sort=False).ngroup()
    return made.assign(scale=order + 1).sort_values("scale", kind="stable", ignore_index=True)


def preference_scale(material: Material) -> Figure:
    """Draw the LoDs' places in JOD; scales that no comparison links stand apart."""
    table = preference_table(material)
    preference = material.inference.preference
    if table.empty or preference is None:
        return message_figure(PREFERENCE, NO_SCALE, is_simulated=material.is_simulated)
    rows, lods = records(table), lod_order(material.tables.ratings)
    chart = row_chart(
        PREFERENCE,
        material.tables,
        groups=[str(row["distance"]) for row in rows],
        names=[_place(row) for row in rows],
        footer_in=0.2,
    )
    (axes,) = chart.panels
    for i, (y, row) in enumerate(zip(chart.places, rows, strict=True)):
        higher = rows[i + 1] if i + 1 < len(rows) else None
        if higher is not None and higher["scale"] == row["scale"]:
            style = "-" if row["is_step_clear"] else (0, (2, 2))
            axes.plot([row["jod"], higher["jod"]], [y, chart.places[i + 1]], color="#999999",
                      linewidth=1.0, linestyle=style, zorder=1)  # fmt: skip
        draw_span(
            axes,
            y,
            span_of(row, "jod"),
            colour=lod_colour(row["lod"], lods),
            marker=lod_marker(row["lod"], lods),
            is_open=row["lod"] == row["reference"],
        )
    axes.axvline(0, color="#999999", linewidth=0.8, zorder=0)
    axes.set_xlabel(
        "JOD from the highest LoD of each scale (open); "
        f"{people(preference.people)}, {preference.answers} comparisons",
        fontsize=SMALL,
    )
    return chart.figure


def _step(preference: Preference, place: int) -> tuple[float, float]:
    """Return the 95 % interval of the step to the next higher LoD of the same scale."""
    _, draws = preference.jod()
    cell, reference = preference.cells[place], preference.references[place]
    for other in range(place + 1, len(preference.cells)):
        if preference.cells[other][0] == cell[0] and preference.references[other] == reference:
            low, high = np.quantile(draws[:, other] - draws[:, place], (0.025, 0.975))
            return (float(low), float(high))
    return (np.nan, np.nan)


def _place(row: dict[str, Any]) -> str:
    return f"{row['lod']}" if row["lod"] != row["reference"] else f"{row['lod']} = 0"
