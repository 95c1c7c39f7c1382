"""Realism against measured cost: which LoDs are dominated, with the uncertainty of both.

A LoD is dominated where another costs no more and looks as real or more, one of the two strictly.
Realism and cost are drawn together, so the answer is a share of draws; a LoD stands on the front
where that share is below one half.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.costs.cost import Costs
from analysis.costs.savings import cost_draws
from analysis.estimates.realism import Realism
from analysis.words.wording import listed, percent

Floats = NDArray[np.float64]
_CENTRAL: Final = (0.025, 0.975)


@dataclass(frozen=True)
class ParetoPoint:
    """One LoD at one distance: milliseconds per frame and mean rating, each with 95 % interval.

    ``dominated_by`` is the LoD that dominates it in most draws, "" where none ever does.
    """

    distance: str
    lod: str
    ms: tuple[float, float, float]
    rating: tuple[float, float, float]
    share_dominated: float
    dominated_by: str
    share_dominated_by: float

    @property
    def is_on_front(self) -> bool:
        """Whether it is dominated in less than half of the draws."""
        return self.share_dominated < 0.5


def pareto(realism: Realism, costs: Costs) -> tuple[ParetoPoint, ...]:
    """Return every LoD at every distance that was both rated and timed."""
    rating, draws = realism.expected()
    found: list[ParetoPoint] = []
    for distance in dict.fromkeys(cell[0] for cell in realism.cells):
        places = {lod: i for i, (where, lod) in enumerate(realism.cells) if where == distance}
        timed = {lod: cost_draws(costs, distance, lod) for lod in places}
        ms = {lod: own for lod, own in timed.items() if own is not None}
        real = {lod: draws[:, places[lod]] for lod in ms}
        for lod in ms:
            middle = (costs.ms(distance, lod) or 0.0, float(rating[places[lod]]))
            found.append(_point(distance, lod, middle, ms, real))
    return tuple(found)


def _point(
    distance: str,
    lod: str,
    middle: tuple[float, float],
    ms: Mapping[str, Floats],
    real: Mapping[str, Floats],
) -> ParetoPoint:
    over = {
        other: _dominates((ms[other], real[other]), (ms[lod], real[lod]))
        for other in ms
        if other != lod
    }
    shares = {other: float(own.mean()) for other, own in over.items()}
    most = max(shares, key=lambda other: shares[other], default="")
    is_any = np.any(list(over.values()), axis=0) if over else np.zeros(1)
    return ParetoPoint(
        distance=distance,
        lod=lod,
        ms=(middle[0], *_interval(ms[lod])),
        rating=(middle[1], *_interval(real[lod])),
        share_dominated=float(is_any.mean()),
        dominated_by=most if shares.get(most, 0.0) > 0 else "",
        share_dominated_by=shares.get(most, 0.0),
    )


def _dominates(one: tuple[Floats, Floats], other: tuple[Floats, Floats]) -> NDArray[np.bool_]:
    """Say in which draws (ms, realism) ``one`` is no worse than ``other``, and better in one."""
    no_worse = (one[0] <= other[0]) & (one[1] >= other[1])
    return np.asarray(no_worse & ((one[0] < other[0]) | (one[1] > other[1])))


def _interval(draws: Floats) -> tuple[float, float]:
    low, high = np.quantile(draws, _CENTRAL)
    return float(low), float(high)


COLUMNS: Final = (
    *("distance", "lod", "ms", "ms_low", "ms_high", "rating", "rating_low", "rating_high"),
    *("share_dominated", "dominated_by", "share_dominated_by", "is_on_front"),
)


def pareto_table(points: Sequence[ParetoPoint]) -> pd.DataFrame:
    """Return one row per point, as pareto.csv has them."""
    rows = [
        (
            *(own.distance, own.lod, *own.ms, *own.rating, own.share_dominated),
            *(own.dominated_by, own.share_dominated_by, own.is_on_front),
        )
        for own in points
    ]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def pareto_sentences(points: Sequence[ParetoPoint]) -> tuple[str, ...]:
    """Say of every distance which LoDs another one dominates, and with what share of draws."""
    made = []
    for distance in dict.fromkeys(own.distance for own in points):
        here = [own for own in points if own.distance == distance]
        beaten = [own for own in here if not own.is_on_front]
        if not beaten:
            made.append(f"{distance}: no LoD is dominated; what costs more looks more real.")
            continue
        told = [
            f"{own.lod} (in {percent(own.share_dominated)} of the draws, mostly by "
            f"{own.dominated_by})"
            for own in beaten
        ]
        made.append(f"{distance}: dominated in realism and cost: {listed(told)}.")
    return tuple(made)
