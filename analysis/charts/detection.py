"""How well differences are detected: d' per pair, and yes beside the false alarms."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from analysis.charts.material import Material
from analysis.charts.rows import draw_span, row_chart, span_of
from analysis.charts.style import ALARM, INK, SMALL, message_figure
from analysis.tables.records import records
from analysis.words.wording import percent

DETECTION: Final = "How well differences are detected"
NO_CATCH: Final = (
    "No pair of equal LoDs has been answered beside unequal ones yet. How often people notice what "
    "is not there is therefore unknown, and with it d′."
)


def detection_table(material: Material) -> pd.DataFrame:
    """Return d', the share of yes and its excess per pair, with the false alarms beside."""
    noticing = material.inference.noticing
    if noticing is None:
        return pd.DataFrame(columns=["distance", "lesser", "greater", "d_prime"])
    alarm, draws = noticing.false_alarms()
    low, high = np.quantile(draws, (0.025, 0.975))
    return noticing.table().assign(
        false_alarms=alarm,
        false_alarms_low=low,
        false_alarms_high=high,
        catch_answers=noticing.catch_answers,
    )


def detection(material: Material) -> Figure:
    """Draw d' per pair, and the share of yes beside the false alarms."""
    table = detection_table(material)
    if table.empty:
        return message_figure(DETECTION, NO_CATCH, is_simulated=material.is_simulated)
    rows = records(table)
    chart = row_chart(
        DETECTION,
        material.tables,
        groups=[str(row["distance"]) for row in rows],
        names=[f"{row['lesser']} – {row['greater']}" for row in rows],
        widths=(1.0, 1.0),
    )
    sensitivity, yes = chart.panels
    for y, row in zip(chart.places, rows, strict=True):
        draw_span(sensitivity, y, span_of(row, "d_prime"), colour="#1F3A5F")
        draw_span(yes, y, span_of(row, "yes"), colour="#1F3A5F")
    first = rows[0]
    sensitivity.axvline(0, color="#999999", linewidth=0.8, zorder=0)
    yes.axvspan(first["false_alarms_low"], first["false_alarms_high"], color=ALARM, alpha=0.15,
                linewidth=0, zorder=0)  # fmt: skip
    yes.axvline(first["false_alarms"], color=ALARM, linewidth=1.2, zorder=1)
    yes.annotate(
        f"false alarms {percent(first['false_alarms'])}, {first['catch_answers']} answers",
        (first["false_alarms"], 1),
        xycoords=("data", "axes fraction"),
        xytext=(-2, 0),
        textcoords="offset points",
        ha="left",
        va="bottom",
        fontsize=SMALL,
        color=INK,
    )
    sensitivity.set_xlabel("sensitivity d′, sd of the percept", fontsize=SMALL)
    yes.set_xlabel("share of people who say yes", fontsize=SMALL)
    yes.set_xlim(-0.02, 1.02)  # symbols at the ends stand whole
    yes.xaxis.set_major_formatter(lambda value, _: f"{100 * value:.0f} %")
    return chart.figure
