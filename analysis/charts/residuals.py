"""Does the model of ratings fit? Its quantile residuals against the normal law."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.special import betaincinv, ndtri

from analysis.charts.material import Material
from analysis.charts.scales import NO_MODEL
from analysis.charts.style import (
    INK,
    PAGE_WIDTH_IN,
    QUIET,
    SMALL,
    message_figure,
    new_figure,
    tidy,
)
from analysis.words.wording import counted

RESIDUALS: Final = "Does the model of ratings fit? Its residuals"
_MOST_POINTS: Final = 400
_COLUMNS: Final = ("rank", "residuals", "normal", "residual", "low", "high", "is_within")


def residual_quantiles(material: Material) -> pd.DataFrame:
    """Return the residuals in order beside those of a normal law.

    Columns: rank (from 1), residuals (how many there are), normal (the expected one), residual, low
    and high (where the one of that rank lies in 95 % of normal samples: quantiles of its beta law),
    is_within. Of more than 400 residuals evenly spaced ranks, and all at the ends, are kept.
    """
    if material.residuals.empty:
        return pd.DataFrame(columns=list(_COLUMNS))
    values = np.sort(material.residuals["residual"].to_numpy(dtype=float))
    n = values.size
    rank = np.arange(1, n + 1)
    if n > _MOST_POINTS:
        tail = _MOST_POINTS // 8
        inner = np.linspace(tail + 1, n - tail, _MOST_POINTS - 2 * tail).round().astype(int)
        rank = np.unique(np.concatenate([rank[:tail], inner, rank[-tail:]]))
    low, high = (ndtri(betaincinv(rank, n + 1 - rank, p)) for p in (0.025, 0.975))
    residual = values[rank - 1]
    return pd.DataFrame(
        {
            "rank": rank,
            "residuals": n,
            "normal": ndtri(rank / (n + 1)),
            "residual": residual,
            "low": low,
            "high": high,
            "is_within": (low <= residual) & (residual <= high),
        }
    )


def residual_chart(material: Material) -> Figure:
    """Draw the residuals against the normal law, and how far they stray from it."""
    table = residual_quantiles(material)
    if table.empty:
        return message_figure(RESIDUALS, NO_MODEL, is_simulated=material.is_simulated)
    figure = new_figure(PAGE_WIDTH_IN, 3.3, RESIDUALS, is_simulated=material.is_simulated)
    whole, away = figure.subplots(1, 2)
    x = table["normal"].to_numpy()
    is_within = table["is_within"].to_numpy(dtype=bool)
    for axes, base in ((whole, np.zeros_like(x)), (away, x)):
        tidy(axes)
        axes.fill_between(x, table["low"] - base, table["high"] - base, color=QUIET, alpha=0.22,
                          linewidth=0, zorder=1)  # fmt: skip
        axes.plot(x, x - base, color="#999999", linewidth=0.9, zorder=2)
        for own, colour, marker in ((is_within, "#0072B2", "o"), (~is_within, "#D55E00", "D")):
            axes.plot(x[own], (table["residual"] - base)[own], marker=marker, markersize=3.2,
                      linestyle="", color=colour, markeredgecolor=INK, markeredgewidth=0.3,
                      zorder=3)  # fmt: skip
        axes.set_xlabel("expected of a normal law, sd", fontsize=SMALL)
    count = counted(int(table["residuals"].iloc[0]), "rating", "ratings")
    whole.set_ylabel(f"quantile residual, sd ({count})", fontsize=SMALL)
    away.set_ylabel("residual minus expected, sd", fontsize=SMALL)
    top = 1.15 * float(np.abs(np.concatenate([table["residual"] - x, [0.3]])).max())
    away.set_ylim(-top, top)
    return figure
