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
from analysis.charts.parts import apart
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
from analysis.curves.curve import (
    MARGIN,
    NOTICED,
    ONE_JOD,
    PREFERRED,
    RATED,
    SHOWN,
    SizeCurve,
    curve_table,
)
from analysis.tables.ordering import distance_order, lod_order
from analysis.tables.reading import Tables
from analysis.tables.records import records
from analysis.words.wording import people, percent

_PANEL_IN: Final = 2.7
_MOST_TOLD: Final = 3  # curves beside which there is room for their thresholds
_MARKED: Final = {MARGIN: "margin", ONE_JOD: "1 JOD"}  # marked on the curves
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
        PAGE_WIDTH_IN,
        0.7 + _PANEL_IN * len(measures),
        look.title,
        is_simulated=material.is_simulated,
    )
    panels = figure.subplots(len(measures), 1, squeeze=False, sharey=True)[:, 0]
    lods = lod_order(material.tables.ratings)
    for axes, measure in zip(panels, measures, strict=True):
        _draw_panel(axes, [curve for curve in own if curve.measure == measure], lods, look)
        unit = "degrees at the eye" if measure.unit == "°" else "pixels"
        axes.set_xlabel(f"diameter of the iris, {unit}", fontsize=SMALL)
        axes.set_ylabel(look.axis, fontsize=SMALL)
        if measure.column == "iris_px":
            _name_distances(axes, material.tables)
    for axes, measure in zip(panels, measures, strict=True):  # once all share their vertical axis
        _name_curves(axes, [curve for curve in own if curve.measure == measure], lods, look)
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
    _draw_base(axes, curves[0], look)
    _draw_margins(axes, curves, lods)
    _scale_axes(axes, curves, look)


def _scale_axes(axes: Axes, curves: Sequence[SizeCurve], look: _Look) -> None:
    """Let the axes show the sizes shown and every curve and point; long intervals may leave."""
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
        return
    shown = [np.concatenate([curve.low, curve.high, curve.points["value"]]) for curve in curves]
    low, high = float(np.nanmin(np.concatenate(shown))), float(np.nanmax(np.concatenate(shown)))
    axes.set_ylim(min(low, 0.0) - 0.1 * (high - low), high + 0.1 * (high - low))


def _name_curves(axes: Axes, curves: Sequence[SizeCurve], lods: Sequence[str], look: _Look) -> None:
    """Write each LoD and its n at the curve's end, moved apart where they would overlap."""
    low, high = axes.get_ylim()
    base, is_told = curves[0].base[0], bool(look.base) and np.isfinite(curves[0].base[0])
    ends = [float(curve.value[-1]) for curve in curves] + ([base] if is_told else [])
    has_room = len(curves) <= _MOST_TOLD
    least = (0.19 if has_room else 0.085) * (high - low)
    places = apart(ends, least=least, low=low + 0.4 * least, high=high)
    across = axes.get_yaxis_transform()
    names = [f"{own.lod}, {people(own.people)}{_told(own) if has_room else ''}" for own in curves]
    names += [f"{look.base}, {percent(base)}"] if is_told else []
    for i, (y, name) in enumerate(zip(places, names, strict=True)):
        colour = INK if i < len(curves) else _base_colour(look)
        axes.annotate(name, (1.035, y), xycoords=across, ha="left", va="center", fontsize=SMALL,
                      color=colour, annotation_clip=False)  # fmt: skip
        if i < len(curves):
            lod = curves[i].lod
            axes.plot([1.018], [y], marker=lod_marker(lod, lods), color=lod_colour(lod, lods),
                      transform=across, clip_on=False, markersize=4.5)  # fmt: skip


def _told(curve: SizeCurve) -> str:
    """Say at which size the curve reaches its threshold, with the interval, in two lines more."""
    found = [own for own in curve.thresholds if own.name in _MARKED]
    if not found:
        return ""
    size, interval = curve.say(found[0]).split(" (", maxsplit=1)
    return f"\n{_MARKED[found[0].name]}: {size}\n({interval}"


def _base_colour(look: _Look) -> str:
    return ALARM if look.base == "false alarms" else QUIET


def _draw_base(axes: Axes, curve: SizeCurve, look: _Look) -> None:
    """Draw what there would be without any difference, with its interval."""
    value, low, high = curve.base
    if np.isfinite(value):
        colour = _base_colour(look)
        axes.axhline(value, color=colour, linewidth=1.0, linestyle=(0, (1, 2)), zorder=1)
        if look.base:
            axes.axhspan(low, high, color=colour, alpha=0.08, linewidth=0, zorder=0)


def _draw_margins(axes: Axes, curves: Sequence[SizeCurve], lods: Sequence[str]) -> None:
    """Mark on each curve the size at which it reaches its margin, or 1 JOD."""
    for curve in curves:
        for own in curve.thresholds:
            if own.name in _MARKED and own.where(own.size) == SHOWN:
                y = float(np.interp(np.log2(own.size), np.log2(curve.sizes), curve.value))
                axes.plot([own.size], [y], marker="|", markersize=13, markeredgewidth=2,
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
