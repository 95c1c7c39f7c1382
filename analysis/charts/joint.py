"""The joint scale: ratings and comparisons on one axis, and what the comparisons add."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from analysis.charts.material import Material
from analysis.charts.rows import draw_span, row_chart, span_of, write_beside
from analysis.charts.style import (
    QUIET,
    SMALL,
    lod_colour,
    lod_marker,
    message_figure,
)
from analysis.estimates.joint import Joint
from analysis.tables.ordering import lod_order
from analysis.tables.records import records
from analysis.words.wording import number, people, percent

JOINT: Final = "Ratings and comparisons on one scale"
NOT_FITTED: Final = (
    "No compared pair has been rated by two people or more yet. Until then no comparison has a "
    "place on the ratings' scale."
)
_COLUMNS: Final = ("distance", "lod", "latent", "alone", "loss", "width_ratio", "jod_per_unit")


def joint_table(material: Material) -> pd.DataFrame:
    """Return the joint scale beside the ratings alone, also where the design does not link it.

    Columns: those of joint-scale.csv, then alone with interval (the latent place by the ratings
    alone), compared (comparisons that took part) and jod_per_unit with interval.
    """
    joint = material.inference.joint
    if joint is None:
        return pd.DataFrame(columns=list(_COLUMNS))
    table = joint.table(material.inference.best)
    latent, draws = joint.latent_alone()
    low, high = np.quantile(draws, (0.025, 0.975), axis=0)
    unit, units = joint.jod_per_unit()
    least, most = np.quantile(units, (0.025, 0.975))
    return table.assign(
        alone=latent,
        alone_low=low,
        alone_high=high,
        compared=joint.compared,
        jod_per_unit=unit,
        jod_per_unit_low=least,
        jod_per_unit_high=most,
    )


def why_not(material: Material) -> str:
    """Say why there is no joint scale to draw; empty where there is one."""
    linkage = material.inference.linkage
    if material.inference.joint is None or linkage is None:
        return NOT_FITTED
    return "" if linkage.is_one else " ".join(linkage.sentences())


def joint_scale(material: Material) -> Figure:
    """Draw every LoD's place on the joint scale, and its loss with and without comparisons."""
    table, joint = joint_table(material), material.inference.joint
    if joint is None or why_not(material):
        return message_figure(JOINT, why_not(material), is_simulated=material.is_simulated)
    rows, lods = records(table), lod_order(material.tables.ratings)
    has_loss = "loss" in table and bool(table["loss"].notna().any())
    chart = row_chart(
        JOINT,
        material.tables,
        groups=[str(row["distance"]) for row in rows],
        names=[str(row["lod"]) for row in rows],
        widths=(1.2, 1.0) if has_loss else (1.0,),
        footer_in=0.6,
    )
    for i, (y, row) in enumerate(zip(chart.places, rows, strict=True)):
        colour, marker = lod_colour(row["lod"], lods), lod_marker(row["lod"], lods)
        nowhere = (np.nan, np.nan)
        own = span_of(row, "latent") if i else (row["latent"], *nowhere)
        alone = span_of(row, "alone") if i else (row["alone"], *nowhere)
        draw_span(chart.panels[0], y, own, colour=colour, marker=marker)
        draw_span(chart.panels[0], y + 0.27, alone, colour=QUIET, marker=".", edge=QUIET)
        if has_loss and np.isfinite(row["loss"]):
            draw_span(chart.panels[1], y, span_of(row, "loss"), colour=colour, marker=marker)
            _draw_alone(chart.panels[1], y + 0.27, row["loss_alone_low"], row["loss_alone_high"])
            write_beside(chart.panels[1], y, f"interval {percent(row['width_ratio'])}")
    first = f"{rows[0]['lod']} at {rows[0]['distance']} = 0"
    chart.panels[0].set_xlabel(
        f"latent realism, sd of one person's ratings\n({first};\ngrey: by the ratings alone)",
        fontsize=SMALL,
    )
    _in_jod(chart.panels[0], joint)
    if has_loss:
        chart.panels[1].axvline(0, color="#999999", linewidth=0.8, zorder=0)
        chart.panels[1].set_xlabel(
            "loss to the highest LoD,\nrating points (beside: width of its\n"
            "interval, ratings alone = 100 %)",
            fontsize=SMALL,
        )
    least, most = (number(table[f"jod_per_unit_{end}"].iloc[0]) for end in ("low", "high"))
    note = (
        f"{people(joint.fit.model.people)}, {joint.alone.counts.total:.0f} ratings and "
        f"{joint.compared} comparisons; one unit of the latent scale is "
        f"{number(joint.jod_per_unit()[0])} JOD [{least}, {most}]"
    )
    chart.figure.supxlabel(note, fontsize=SMALL, color=QUIET)
    return chart.figure


def _draw_alone(axes: Axes, y: float, low: float, high: float) -> None:
    axes.plot([low, high], [y, y], color=QUIET, linewidth=1.8, zorder=3, solid_capstyle="butt")


def _in_jod(axes: Axes, joint: Joint) -> None:
    """Let a second axis on top read the same places in JOD."""
    unit = joint.jod_per_unit()[0]

    def to_jod(x: ArrayLike) -> ArrayLike:
        return unit * np.asarray(x, dtype=float)

    def from_jod(x: ArrayLike) -> ArrayLike:
        return np.asarray(x, dtype=float) / unit

    top = axes.secondary_xaxis("top", functions=(to_jod, from_jod))
    top.tick_params(labelsize=SMALL, length=3, color="#999999")
    top.spines["top"].set_color("#999999")
    top.set_xlabel("the same in JOD", fontsize=SMALL)
