"""The raw ratings at a glance: a row per person, a column per eye that was shown."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import pandas as pd
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from analysis.charts.material import Material
from analysis.charts.parts import clip_label, head_columns, upright_in
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
from analysis.descriptive.means import person_means
from analysis.tables.ordering import in_order
from analysis.tables.records import records
from analysis.words.wording import people

HEAT_MAP: Final = "What each person gave to what"
_MOST_ROWS_NAMED: Final = 45
_MOST_COLUMNS: Final = 40
_KEYS: Final = ("distance", "lod", "clip", "eye")


def heat_table(material: Material) -> pd.DataFrame:
    """Return everyone's rating of each eye as it was shown; of many, per distance and LoD alone.

    Columns: distance, lod, clip and eye (empty where taken together), participant, rating (mean of
    repeated ones).
    """
    ratings = material.tables.ratings
    counted = ratings[~ratings["is_practice"]]
    keys = list(
        _KEYS if len(counted[list(_KEYS)].drop_duplicates()) <= _MOST_COLUMNS else _KEYS[:2]
    )
    means = in_order(person_means(ratings, keys), ratings)
    names = [*_KEYS, "participant", "rating"]
    return means.reindex(columns=names).astype({"clip": "string", "eye": "string"})


def ratings_heat_map(material: Material) -> Figure:
    """Draw each person as a row and each eye shown as a column, severe people on top."""
    table = heat_table(material)
    if table.empty:
        return message_figure(HEAT_MAP, NO_RATINGS, is_simulated=material.is_simulated)
    place = table.groupby(list(_KEYS), dropna=False, sort=False).ngroup()
    first = records(table[~place.duplicated()])
    wide = table.assign(place=place).pivot(index="participant", columns="place", values="rating")
    wide = wide.loc[wide.mean(axis=1).sort_values(kind="stable").index, range(len(first))]
    columns = [(str(row["distance"]), _name(row)) for row in first]
    is_named = len(wide) <= _MOST_ROWS_NAMED
    names, has_eyes = [name for _, name in columns], bool(table["clip"].notna().any())
    height = min(
        9.0, 1.6 + upright_in(names, names=3) + (0.17 * max(4, len(wide)) if is_named else 4.5)
    )
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
        title="rating" if has_eyes else "mean rating, to the nearest",
        title_fontsize=SMALL,
    )
    return figure


def _name(row: Mapping[str, Any]) -> str:
    """Name an eye: "clip 4, left: low", or its LoD alone where clips say no more."""
    lod = str(row["lod"])
    if pd.isna(row["clip"]) or pd.isna(row["eye"]):
        return lod
    return f"{clip_label(str(row['clip']))}, {row['eye']}: {lod}"
