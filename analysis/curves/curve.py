"""A psychometric curve and its thresholds, ready to be drawn and written.

Nothing is said beyond the sizes shown: a threshold there is only known to lie above or below.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.curves.sizes import Measure, crossing
from analysis.words.wording import number

Floats = NDArray[np.float64]
NOTICED, PREFERRED, RATED = "noticed", "preferred", "rated"
MARGIN, D_PRIME_1, HALFWAY, ONE_JOD = "margin", "d_prime_1", "halfway", "one_jod"
BELOW, SHOWN, ABOVE = "below", "shown", "above"  # where a size lies, against those shown
_CENTRAL: Final = (0.025, 0.975)


@dataclass(frozen=True)
class Threshold:
    """The size at which a curve reaches a level, with its 95 % interval, in the measure's unit.

    0 stands for "below the smallest size shown" and infinity for "above the largest". ``safe`` is
    the lower one-sided bound at the margins' confidence.
    """

    name: str
    level: float
    size: float
    low: float
    high: float
    safe: float

    def where(self, value: float) -> str:
        """Return where one of the threshold's sizes lies against the sizes shown."""
        return BELOW if value == 0 else ABOVE if np.isinf(value) else SHOWN


@dataclass(frozen=True)
class SizeCurve:
    """One LoD against the best along the iris's size.

    ``kind``: noticed (share of yes), preferred (share that finds the best LoD more realistic) or
    rated (points of the rating scale below the best). ``sizes``, ``value`` and the 95 % band
    ``low``, ``high`` are (n,); ``base`` is what the value would be without any difference, with its
    interval. ``points`` are what was observed: size, value, low, high, answers.
    """

    kind: str
    measure: Measure
    lod: str
    best: str
    sizes: Floats
    value: Floats
    low: Floats
    high: Floats
    base: tuple[float, float, float]
    points: pd.DataFrame
    thresholds: tuple[Threshold, ...]
    people: int
    answers: int

    @property
    def shown(self) -> tuple[float, float]:
        """The smallest and the largest size shown."""
        return float(self.sizes[0]), float(self.sizes[-1])

    def threshold(self, name: str) -> Threshold:
        """Return a threshold by its name; raises KeyError."""
        for own in self.thresholds:
            if own.name == name:
                return own
        raise KeyError(f"no threshold {name} of what was {self.kind}")

    def say(self, threshold: Threshold) -> str:
        """Write a threshold: "64 px (48 to 90 px)", or what is known of it."""
        return f"{self._size(threshold.size)} ({self._interval(threshold)})"

    def _interval(self, threshold: Threshold) -> str:
        low, high = threshold.low, threshold.high
        if low == high:  # all draws on one side
            return "nearly all draws"
        return f"{self._size(low)} to {self._size(high)}"

    def _size(self, size: float) -> str:
        smallest, largest = self.shown
        if size == 0:
            return f"below {self._unit(smallest)}"
        return f"above {self._unit(largest)}" if np.isinf(size) else self._unit(size)

    def _unit(self, size: float) -> str:
        digits = 0 if size >= 20 else 1 if size >= 2 else 2
        gap = "" if self.measure.unit == "°" else "\N{NO-BREAK SPACE}"
        return f"{number(size, digits=digits)}{gap}{self.measure.unit}"


def make_threshold(
    name: str,
    level: float,
    x: Floats,
    *,
    value: Floats,
    draws: Floats,
    levels: Floats | float,
    confidence: float,
) -> Threshold:
    """Find where a curve reaches a level: ``value`` (n_x,), ``draws`` (n_draws, n_x).

    ``levels`` is the level in every draw, where it is estimated itself.
    """
    found = np.sort(crossing(x, draws, levels))

    def at(share: float) -> float:  # a draw itself: between -inf and a number is no number
        return float(2.0 ** found[round(share * (len(found) - 1))])

    size = float(2.0 ** crossing(x, value[None], level)[0])
    return Threshold(name, level, size, at(_CENTRAL[0]), at(_CENTRAL[1]), at(1.0 - confidence))


def band(draws: Floats) -> tuple[Floats, Floats]:
    """Return the central 95 % of draws (n_draws, n_x) at every size."""
    low, high = np.quantile(draws, _CENTRAL, axis=0)
    return low, high


def with_interval(value: float, draws: Floats) -> tuple[float, float, float]:
    """Return a number with the central 95 % of its draws (n_draws,)."""
    low, high = np.quantile(draws, _CENTRAL)
    return value, float(low), float(high)


def curve_table(curves: Sequence[SizeCurve]) -> pd.DataFrame:
    """Return the curves' values and bands, a row per size, as curves.csv has them."""
    parts = [
        pd.DataFrame(
            {
                **_named(curve),
                "size": curve.sizes,
                "value": curve.value,
                "low": curve.low,
                "high": curve.high,
                "without_difference": curve.base[0],
            }
        )
        for curve in curves
    ]
    return pd.concat(parts, ignore_index=True)


def point_table(curves: Sequence[SizeCurve]) -> pd.DataFrame:
    """Return what was observed at each size, as curve-points.csv has it."""
    parts = [curve.points.assign(**_named(curve)) for curve in curves if len(curve.points)]
    names = ["kind", "measure", "lod", "best"]
    if not parts:
        return pd.DataFrame(columns=names)
    table = pd.concat(parts, ignore_index=True)
    return table[[*names, *(name for name in table if name not in names)]]


def threshold_table(curves: Sequence[SizeCurve]) -> pd.DataFrame:
    """Return the curves' thresholds, as thresholds.csv has them.

    A size beyond those shown is empty, and ``size_is``, ``low_is``, ``high_is`` say on which side.
    """
    rows = []
    for curve in curves:
        for own in curve.thresholds:
            row: dict[str, object] = {**_named(curve), "threshold": own.name, "level": own.level}
            for name in ("size", "low", "high", "safe"):
                value = getattr(own, name)
                row |= {name: value if own.where(value) == SHOWN else np.nan}
                row |= {f"{name}_is": own.where(value)}
            row |= {"smallest_shown": curve.shown[0], "largest_shown": curve.shown[1]}
            rows.append(row | {"people": curve.people, "answers": curve.answers})
    return pd.DataFrame(rows)


def _named(curve: SizeCurve) -> dict[str, str]:
    return {
        "kind": curve.kind,
        "measure": curve.measure.column,
        "lod": curve.lod,
        "best": curve.best,
    }
