"""Does a verdict hang on one person? Every verdict with and without everyone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from analysis.charts.material import Material
from analysis.charts.parts import head_columns, upright_in
from analysis.charts.style import (
    INK,
    PAGE_WIDTH_IN,
    SMALL,
    VERDICT_COLOURS,
    message_figure,
    new_figure,
    tidy,
)
from analysis.decision.effects import EffectVerdict
from analysis.decision.verdicts import Verdict
from analysis.screening.sensitivity import COLUMNS
from analysis.tables.records import records
from analysis.words.wording import counted, listed, place

STABILITY: Final = "Does a verdict hang on one person?"
NO_VERDICT: Final = "No verdict could hang on anyone yet."
USUAL: Final = "everyone"
_ALONE: Final = "without "
_UNMOVED: Final = "stays without, of {}"
_MOST_NAMED: Final = 16
_LETTERS: Final = {"equivalent": "E", "different": "D", "not shown": "?"}


def stability_table(material: Material) -> pd.DataFrame:
    """Return every verdict as usual, without flagged people, and without each single person.

    Columns as in verdict-sensitivity.csv. Who was flagged is left out with all weights worked out
    anew; everybody else with those of the whole.
    """
    own = material.inference
    flagged = material.sensitivity
    parts = []
    if flagged is not None and len(flagged):
        parts.append(flagged)
    elif own.decisions:
        parts.append(_usual([v for d in own.decisions for v in d.verdicts], USUAL))
    if own.effects:
        parts.append(_usual(own.effects, parts[0]["people"].iloc[0] if parts else USUAL))
    alone = material.left_out
    if len(alone):
        alone = alone.assign(people=_ALONE + alone["people"].astype(str), flags="")
        keys = ["people", "distance", "lod"]
        told = {key for part in parts for key in part[keys].itertuples(index=False, name=None)}
        is_new = [key not in told for key in alone[keys].itertuples(index=False, name=None)]
        parts.append(alone[is_new][list(COLUMNS)])
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=list(COLUMNS))


def _usual(verdicts: Sequence[Verdict | EffectVerdict], who: str) -> pd.DataFrame:
    rows = [(who, "", v.distance, v.lod, v.outcome, v.outcome, False) for v in verdicts]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def stability_sentence(material: Material) -> str:
    """Say which verdicts leaving out one person changes; empty where that is not known."""
    alone = material.left_out
    if alone.empty:
        return ""
    count = alone["people"].nunique()
    moved = alone[alone["is_moved"]]
    if moved.empty:
        return f"Leaving out any one of the {count} people changes no verdict."
    lods = set(alone["lod"])
    named = [
        f"{lod} at {place(str(distance), lods)} ({own['people'].nunique()} of {count})"
        for (distance, lod), own in moved.groupby(["distance", "lod"], sort=False)
    ]
    most = f"{listed(named[:4])}{' and others' if len(named) > 4 else ''}"
    return f"Leaving out one person changes {most}."


def verdict_stability(material: Material) -> Figure:
    """Draw every verdict as a square: as usual, without flagged people, without who moves any.

    The last row says for each verdict without how many of all people it stays.
    """
    table = stability_table(material)
    if table.empty:
        return message_figure(STABILITY, NO_VERDICT, is_simulated=material.is_simulated)
    distances = list(dict.fromkeys(table["distance"]))
    cells = sorted(
        dict.fromkeys(zip(table["distance"], table["lod"], strict=True)),
        key=lambda cell: distances.index(cell[0]),
    )
    is_alone = table["people"].str.startswith(_ALONE) & (table["flags"] == "")
    moving = table[is_alone & table["is_moved"]]
    named = list(dict.fromkeys(moving["people"]))
    counted_rows = [*dict.fromkeys(table[~is_alone]["people"]), *named[:_MOST_NAMED]]
    unmoved, count = _unmoved(material), material.left_out["people"].nunique()
    height = 0.26 * (len(counted_rows) + bool(unmoved))
    figure = new_figure(
        PAGE_WIDTH_IN,
        1.75 + upright_in([lod for _, lod in cells]) + height,
        STABILITY,
        is_simulated=material.is_simulated,
    )
    axes = figure.subplots()
    tidy(axes, grid="")
    for row in records(table[table["people"].isin(counted_rows)]):
        x, y = cells.index((row["distance"], row["lod"])), counted_rows.index(row["people"])
        colour = VERDICT_COLOURS.get(str(row["verdict"]), "white")
        width = 2.2 if row["is_moved"] else 0
        axes.add_patch(Rectangle((x - 0.44, y - 0.4), 0.88, 0.8, facecolor=colour,
                                 linewidth=width, edgecolor=INK))  # fmt: skip
        axes.text(x, y, _LETTERS.get(str(row["verdict"]), "–"), ha="center", va="center",
                  color="white", fontsize=SMALL, fontweight="bold")  # fmt: skip
    names = [*counted_rows, *([_UNMOVED.format(count)] if unmoved else [])]

    for cell, text in unmoved.items():
        axes.text(cells.index(cell), len(counted_rows), text, ha="center", va="center",
                  fontsize=SMALL, color=INK)  # fmt: skip
    axes.set_xlim(-0.55, len(cells) - 0.45)
    axes.set_ylim(len(names) - 0.5, -1.0)
    axes.set_yticks(range(len(names)), names)
    axes.set_xticks(range(len(cells)), [lod for _, lod in cells], rotation=90)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    head_columns(axes, [distance for distance, _ in cells])
    if len(named) > _MOST_NAMED:
        more = counted(len(named) - _MOST_NAMED, "person", "people")
        axes.set_xlabel(f"{more} more who move a verdict: verdict-stability.csv", fontsize=SMALL)
    _explain(figure)
    return figure


def _unmoved(material: Material) -> dict[tuple[str, str], str]:
    alone = material.left_out
    groups = alone.groupby(["distance", "lod"], sort=False)["is_moved"]
    return {
        (str(distance), str(lod)): f"{len(own) - int(own.sum())}" for (distance, lod), own in groups
    }


def _explain(figure: Figure) -> None:
    handles = [
        *(Patch(color=VERDICT_COLOURS[name], label=f"{_LETTERS[name]} = {name}")
          for name in VERDICT_COLOURS),
        Patch(facecolor="white", edgecolor=INK, linewidth=2.2, label="differs from the first row"),
    ]  # fmt: skip
    figure.legend(
        handles=handles, loc="outside lower center", ncols=4, frameon=False, fontsize=SMALL
    )
