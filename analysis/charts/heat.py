"""The raw ratings at a glance: a row per person, a column per LoD and distance."""

from __future__ import annotations

from typing import Final

import pandas as pd
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from analysis.charts.material import Material
from analysis.charts.parts import head_columns, upright_in
from analysis.charts.style import (
    ALARM,
    NO_RATINGS,
    PAGE_WIDTH_IN,
    SMALL,
    message_figure,
    new_figure,
    scale_colours,
    tidy,
)
from analysis.descriptive import person_means
from analysis.tables.ordering import in_order
from analysis.wording import people

HEAT_MAP: Final = "What each person gave to what"
_MOST_ROWS_NAMED: Final = 45


def heat_table(material: Material) -> pd.DataFrame:
    """Return everyone's mean rating per distance and LoD: participant, distance, lod, rating."""
    means = person_means(material.tables.ratings, ["distance", "lod"])
    return in_order(means, material.tables.ratings)


def ratings_heat_map(material: Material) -> Figure:
    """Draw each person as a row and each LoD at each distance as a column, severe people on top."""
    table = heat_table(material)
    if table.empty:
        return message_figure(HEAT_MAP, NO_RATINGS, is_simulated=material.is_simulated)
    columns = list(dict.fromkeys(zip(table["distance"], table["lod"], strict=True)))
    wide = table.pivot(index="participant", columns=["distance", "lod"], values="rating")[columns]
    wide = wide.loc[wide.mean(axis=1).sort_values(kind="stable").index]
    is_named = len(wide) <= _MOST_ROWS_NAMED
    names = [lod for _, lod in columns]
    height = min(9.0, 1.6 + upright_in(names) + (0.17 * max(4, len(wide)) if is_named else 4.5))
    width = min(PAGE_WIDTH_IN, 2.2 + 0.42 * len(columns))
    figure = new_figure(max(width, 4.6), height, HEAT_MAP, is_simulated=material.is_simulated)
    axes = figure.subplots()
    tidy(axes, grid="")
    axes.spines[:].set_visible(False)
    axes.patch.set(visible=True, facecolor="white", edgecolor="#bbbbbb", hatch="/////", linewidth=0)
    low, high = material.tables.scale
    steps = scale_colours(high - low + 1)
    axes.imshow(
        wide.to_numpy(dtype=float),
        cmap=ListedColormap(steps),
        vmin=low - 0.5,
        vmax=high + 0.5,
        aspect="auto",
        interpolation="nearest",
    )
    axes.set_xticks(range(len(columns)), names, rotation=90)
    axes.set_yticks(range(len(wide)) if is_named else [], list(wide.index) if is_named else [])
    axes.tick_params(length=0)
    head_columns(axes, [distance for distance, _ in columns])
    flagged = {str(who) for who in material.flags}
    for label in axes.get_yticklabels():
        if label.get_text() in flagged:
            label.set_color(ALARM)
            label.set_fontweight("bold")
    axes.set_ylabel(f"people, severe to lenient, {people(len(wide))}", fontsize=SMALL)
    figure.legend(
        handles=[
            *(Patch(color=c, label=str(k)) for k, c in enumerate(steps, start=low)),
            Patch(facecolor="white", edgecolor="#bbbbbb", hatch="/////", label="not rated"),
        ],
        loc="outside lower center",
        ncols=len(steps) + 1,
        frameon=False,
        fontsize=SMALL,
        title="mean rating, to the nearest",
        title_fontsize=SMALL,
    )
    return figure
