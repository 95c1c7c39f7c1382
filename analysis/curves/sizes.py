"""The size at which an eye was seen: in pixels of the clip, or in degrees at the observer's eye.

Sizes that lie within a small part of an octave are taken together: an iris's pixels differ a little
from clip to clip, its degrees from screen to screen, and a model's cost grows with how many sizes
there are.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

Floats = NDArray[np.float64]
GRID: Final = 61  # sizes at which a curve is evaluated


@dataclass(frozen=True)
class Measure:
    """A column that holds the size of the iris.

    ``per_octave`` is into how many parts an octave is cut. ``middle`` is the prior of the size at
    which half of a difference shows: mean and standard deviation of its log2.
    """

    column: str
    unit: str
    name: str
    per_octave: int
    middle: tuple[float, float]


PIXELS: Final = Measure("iris_px", "px", "pixels", 8, (6.5, 2.0))
# 90 px, the prior's middle, are 2 degrees on a monitor that shows 45 pixels per degree.
DEGREES: Final = Measure("iris_deg", "°", "degrees", 4, (1.0, 2.0))
MEASURES: Final = (PIXELS, DEGREES)


def with_size(rows: pd.DataFrame, measure: Measure) -> pd.DataFrame:
    """Return the rows whose size is known, with its log2 as ``size``, alike within a bin."""
    if measure.column not in rows:
        return rows.iloc[:0].assign(size=np.zeros(0))
    given = pd.to_numeric(rows[measure.column], errors="coerce").to_numpy(dtype=float)
    known = np.isfinite(given) & (given > 0)
    exact = np.log2(given[known])
    part = np.round(exact * measure.per_octave).astype(int)
    if exact.size and np.ptp(exact) * measure.per_octave < 1.0:  # one size, beside a bin's edge
        part[:] = 0
    kept = rows[known].assign(size=exact)
    together: pd.DataFrame = kept.assign(size=kept.groupby(part)["size"].transform("mean"))
    return together


def best_lod(
    ratings: pd.DataFrame, comparisons: pd.DataFrame, ranks: Mapping[str, float]
) -> str | None:
    """Return the highest LoD that was shown and counts; None where none has a rank."""
    shown = {
        str(lod)
        for rows, columns in ((ratings, ("lod",)), (comparisons, ("left_lod", "right_lod")))
        for column in columns
        for lod in rows.loc[~rows["is_practice"], column].dropna().unique()
    }
    known = [lod for lod in shown if ranks.get(lod, -1.0) >= 0]
    return max(known, key=lambda lod: ranks[lod]) if known else None


def along(sizes: Floats) -> Floats:
    """Return evenly spaced log2 sizes from the smallest shown to the largest."""
    return np.linspace(sizes.min(), sizes.max(), GRID)


def crossing(x: Floats, values: Floats, level: Floats | float) -> Floats:
    """Return the log2 size at which each row of rising ``values`` (n, n_x) reaches ``level``.

    -inf where it is above the level at the smallest size, inf where it stays below at the largest.
    """
    levels = np.broadcast_to(np.asarray(level, dtype=float), len(values))
    is_above = values >= levels[:, None]
    first = is_above.argmax(axis=1)
    rows = np.arange(len(values))
    before = np.maximum(first - 1, 0)
    low, high = values[rows, before], values[rows, first]
    with np.errstate(divide="ignore", invalid="ignore"):
        way = np.where(high > low, (levels - low) / (high - low), 0.0)
    found = x[before] + way * (x[first] - x[before])
    found = np.where(first == 0, -np.inf, found)
    return np.where(is_above.any(axis=1), found, np.inf)
