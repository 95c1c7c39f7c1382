"""Psychometric curves: what is noticed, preferred and lost along the size of the iris."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator

from analysis.charts.material import Material
from analysis.charts.parts import records
from analysis.charts.style import (
    ALARM,
    INK,
    PAGE_WIDTH_IN,
    QUIET,
    SMALL,
    lod_colour,
    lod_marker,
    message_figure,
    new_figure,
    tidy,
)
from analysis.curves.curve import MARGIN, NOTICED, PREFERRED, RATED, SizeCurve, curve_table
from analysis.ordering import distance_order, lod_order
from analysis.reading import Tables
from analysis.wording import percent

_HEIGHT_IN: Final = 3.4
_SIZES: Final = 2.0 ** np.arange(-8.0, 12.0)  # marks of the axis, px or degrees


@dataclass(frozen=True)
class _Look:
    title: str
    axis: str
    is_share: bool
    base: str


_LOOKS: Final = {
    NOTICED: _Look("Noticed, by the size of the iris", "share who notice", True, "false alarms"),
    PREFERRED: _Look(
        "Best LoD preferred, by the size of the iris", "share who prefer the best LoD", True,
        "no difference",
    ),
    RATED: _Look(
        "Loss of realism, by the size of the iris", "points below the best LoD", False, ""
    ),
}  # fmt: skip


def title(kind: str) -> str:
    """Return what the chart of one kind of curve is called."""
    return _LOOKS[kind].title


def curves_table(material: Material, kind: str) -> pd.DataFrame:
    """Return the curves of one kind with their bands, a row per size; points stand elsewhere."""
    own = [curve for curve in material.inference.curves.curves if curve.kind == kind]
    if not own:
        return pd.DataFrame(columns=["kind", "measure", "lod", "best", "size", "value"])
    return curve_table(own)


def curves_along_sizes(material: Material, kind: str) -> Figure:
    """Draw one kind of curve over pixels, and over degrees where these are known."""
    look = _LOOKS[kind]
    own = [curve for curve in material.inference.curves.curves if curve.kind == kind]
    if not own:
        notes = " ".join(material.inference.curves.notes)
        reason = f"No curve along sizes can be told yet. {notes}".strip()
        return message_figure(look.title, reason, is_simulated=material.is_simulated)
    measures = list(dict.fromkeys(curve.measure for curve in own))
    figure = new_figure(
        PAGE_WIDTH_IN if len(measures) > 1 else 5.2,
        _HEIGHT_IN,
        look.title,
        is_simulated=material.is_simulated,
    )
    panels = figure.subplots(1, len(measures), squeeze=False, sharey=True)[0]
    lods = lod_order(material.tables.ratings)
    for place, (axes, measure) in enumerate(zip(panels, measures, strict=True)):
        curves = [curve for curve in own if curve.measure == measure]
        _draw_panel(axes, curves, lods, look)
        unit = "degrees at the eye" if measure.unit == "°" else "pixels"
        axes.set_xlabel(f"diameter of the iris, {unit}", fontsize=SMALL)
        if place == 0:
            axes.set_ylabel(look.axis, fontsize=SMALL)
        if measure.column == "iris_px":
            _name_distances(axes, material.tables)
    return figure


def _draw_panel(axes: Axes, curves: Sequence[SizeCurve], lods: Sequence[str], look: _Look) -> None:
    tidy(axes)
    axes.set_xscale("log", base=2)
    shift = np.linspace(-0.045, 0.045, len(curves)) if len(curves) > 1 else np.zeros(1)
    for curve, aside in zip(curves, shift, strict=True):
        colour, marker = lod_colour(curve.lod, lods), lod_marker(curve.lod, lods)
        axes.fill_between(curve.sizes, curve.low, curve.high, color=colour, alpha=0.18, linewidth=0)
        axes.plot(curve.sizes, curve.value, color=colour, linewidth=1.8, zorder=3)
        for point in records(curve.points):
            x = point["size"] * 2.0**aside
            axes.plot([x, x], [point["low"], point["high"]], color=colour, linewidth=1.0, zorder=2)
            axes.plot([x], [point["value"]], marker=marker, color=colour, markersize=5,
                      markeredgecolor=INK, markeredgewidth=0.6, zorder=4)  # fmt: skip
    _name_curves(axes, curves, lods, look)
    _draw_base(axes, curves[0], look)
    _draw_margins(axes, curves, lods)
    smallest = min(curve.shown[0] for curve in curves)
    largest = max(curve.shown[1] for curve in curves)
    axes.set_xlim(smallest / 1.15, largest * 1.15)
    marks = _SIZES[(smallest / 1.15 <= _SIZES) & (largest * 1.15 >= _SIZES)]
    axes.xaxis.set_major_locator(FixedLocator(marks.tolist()))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    if look.is_share:
        axes.set_ylim(-0.02, 1.02)
        axes.yaxis.set_major_formatter(lambda value, _: f"{100 * value:.0f} %")


def _name_curves(axes: Axes, curves: Sequence[SizeCurve], lods: Sequence[str], look: _Look) -> None:
    """Write each LoD and its n at the curve's end, moved apart where they would overlap."""
    low, high = (0.0, 1.0) if look.is_share else axes.get_ylim()
    least = 0.07 * (high - low)
    at = -np.inf
    for curve in sorted(curves, key=lambda own: float(own.value[-1])):
        at = max(float(curve.value[-1]), at + least)
        axes.annotate(
            f"{curve.lod}, n = {curve.people}",
            (1.01, at),
            xycoords=axes.get_yaxis_transform(),
            ha="left",
            va="center",
            fontsize=SMALL,
            color=INK,
            annotation_clip=False,
        )
        axes.plot(
            [1.0],
            [at],
            marker=lod_marker(curve.lod, lods),
            color=lod_colour(curve.lod, lods),
            transform=axes.get_yaxis_transform(),
            clip_on=False,
            markersize=4,
        )


def _draw_base(axes: Axes, curve: SizeCurve, look: _Look) -> None:
    """Draw what there would be without any difference, with its interval."""
    value, low, high = curve.base
    if not np.isfinite(value):
        return
    colour = ALARM if look.base == "false alarms" else QUIET
    axes.axhline(value, color=colour, linewidth=1.0, linestyle=(0, (1, 2)), zorder=1)
    if look.base:
        axes.axhspan(low, high, color=colour, alpha=0.08, linewidth=0, zorder=0)
        axes.annotate(
            f"{look.base} {percent(value)}",
            (0.015, value),
            xycoords=axes.get_yaxis_transform(),
            xytext=(0, 2),
            textcoords="offset points",
            fontsize=SMALL - 1,
            color=colour,
        )


def _draw_margins(axes: Axes, curves: Sequence[SizeCurve], lods: Sequence[str]) -> None:
    """Mark on each curve the size up to which it stays within its margin."""
    for curve in curves:
        named = [own for own in curve.thresholds if own.name == MARGIN]
        for own in named:
            if own.where(own.size) == "shown":
                axes.plot([own.size], [float(np.interp(np.log2(own.size), np.log2(curve.sizes),
                          curve.value))], marker="|", markersize=13, markeredgewidth=2,
                          color=lod_colour(curve.lod, lods), zorder=5)  # fmt: skip


def _name_distances(axes: Axes, tables: Tables) -> None:
    """Name above the panel at which sizes the study's distances lie."""
    low, high = axes.get_xlim()
    medians = tables.ratings.groupby("distance")["iris_px"].median()
    for distance in distance_order(tables.ratings):
        size = float(medians[distance])
        if low <= size <= high:
            axes.annotate(distance, (size, 1), xycoords=axes.get_xaxis_transform(),
                          xytext=(0, 2), textcoords="offset points", ha="center", va="bottom",
                          fontsize=SMALL - 1, color=QUIET)  # fmt: skip
