"""What a cheaper LoD saves, with the uncertainty of the benchmark's medians.

The standard error of a median is taken from its median absolute deviation: 1.4826 MAD estimates the
standard deviation, and a median of n scatters 1.2533 times as much as their mean. Both LoDs were
timed over the same cameras, so what they share is counted twice: intervals are rather too wide.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final
from zlib import crc32

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.costs.cost import Costs, eyes_in_words
from analysis.models.draws import DRAWS

Floats = NDArray[np.float64]
_SD_OF_MAD: Final = 1.4826
_MEDIAN_OF_MEAN: Final = 1.2533  # sqrt(pi / 2)
_Z: Final = 1.959964


@dataclass(frozen=True)
class Saving:
    """Milliseconds per eye saved, with 95 % interval, and the share of the whole frame, if known.

    ``condition`` says where it was measured.
    """

    ms: float
    low: float
    high: float
    condition: str
    share: float = np.nan
    share_low: float = np.nan
    share_high: float = np.nan


def saving_columns(saving: Saving | None) -> dict[str, object]:
    """Return the columns that the tables of verdicts have of a saving, empty without one."""
    names = ("ms", "low", "high", "share", "share_low", "share_high")
    numbers = [getattr(saving, name) if saving else np.nan for name in names]
    columns = ("ms_saved", "ms_saved_low", "ms_saved_high")
    shares = ("share_saved", "share_saved_low", "share_saved_high")
    told: dict[str, object] = dict(zip((*columns, *shares), numbers, strict=True))
    return told | {"measured_at": saving.condition if saving else ""}


def cost_draws(costs: Costs, distance: str, lod: str) -> Floats | None:
    """Return draws (n_draws,) of a LoD's milliseconds per frame; None where not measured."""
    rows = costs.table[(costs.table["distance"] == distance) & (costs.table["lod"] == lod)]
    if rows.empty:
        return None
    row = rows.iloc[0]
    rng = np.random.default_rng(crc32(f"{distance} {lod}".encode()))
    drawn = float(row["ms_median"]) + _error(row) * rng.standard_normal(DRAWS)
    return np.asarray(np.maximum(drawn, 0.0))


def lod_saving(costs: Costs, distance: str, lod: str, *, best: str) -> Saving | None:
    """Return what ``lod`` saves against ``best`` at a distance; None where one was not measured."""
    own, full = (cost_draws(costs, distance, name) for name in (lod, best))
    own_ms, full_ms = costs.ms(distance, lod), costs.ms(distance, best)
    if own is None or full is None or own_ms is None or full_ms is None or full_ms <= 0:
        return None
    low, high = np.quantile(full - own, (0.025, 0.975)) / costs.eyes
    shares = 1.0 - own / np.maximum(full, 1e-9)
    share_low, share_high = np.quantile(shares, (0.025, 0.975))
    return Saving(
        ms=(full_ms - own_ms) / costs.eyes,
        low=float(low),
        high=float(high),
        condition=costs.condition,
        share=1.0 - own_ms / full_ms,
        share_low=float(share_low),
        share_high=float(share_high),
    )


def effect_saving(
    costs: Costs, effect: str, *, kept: str, left: str, distance: str
) -> Saving | None:
    """Return what lowering one effect from level ``kept`` to ``left`` saves, all others at ultra.

    Taken at the distance if it was measured there, else where it was, which ``condition`` names.
    """
    table = costs.effects[(costs.effects["effect"] == effect) & (costs.effects["base"] == "ultra")]
    places = [distance, *(place for place in table["distance"].unique() if place != distance)]
    for place in places:
        here = table[table["distance"] == place].set_index("level")
        wanted = [kept] if left == "off" else [kept, left]
        if not set(wanted) <= set(here.index):
            continue
        rows = [here.loc[level] for level in wanted]
        eyes = float(rows[0]["eyes"])
        values = [float(row["ms_median"]) for row in rows]
        saved = (values[0] - sum(values[1:])) / eyes
        half = _Z * float(np.hypot.reduce([_error(row) for row in rows])) / eyes
        where = f"{place}, {eyes_in_words(eyes)}, {rows[0]['size']} pixels, {rows[0]['renderer']}"
        return Saving(saved, saved - half, saved + half, where)
    return None


def _error(row: pd.Series) -> float:
    """Return the standard error of a row's median."""
    spread = _SD_OF_MAD * float(row["ms_mad"])
    return _MEDIAN_OF_MEAN * spread / float(np.sqrt(max(float(row["n"]), 1.0)))


def frame_ms(costs: Costs, lod: str, *, px: float | None) -> tuple[float, float, float] | None:
    """Return a frame's milliseconds per eye with 95 % interval, measured nearest to a size.

    Without a size at the largest; None where the LoD was not timed.
    """
    rows = costs.table[costs.table["lod"] == lod]
    if rows.empty:
        return None
    sizes = rows["iris_px"].to_numpy(dtype=float)
    away = -sizes if px is None else np.abs(np.log(np.maximum(sizes, 1e-3) / px))
    distance = str(rows["distance"].iloc[int(np.argmin(away))])
    draws, middle = cost_draws(costs, distance, lod), costs.ms(distance, lod)
    if draws is None or middle is None:
        return None
    low, high = np.quantile(draws, (0.025, 0.975))
    told = [round(float(ms) / costs.eyes, 3) for ms in (middle, low, high)]
    return told[0], told[1], told[2]
