"""From a fitted law to one LoD's curve: what every kind of curve has in common."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import pandas as pd

from analysis.curves.curve import Floats, SizeCurve, band, make_threshold
from analysis.curves.law import SizeLaw
from analysis.curves.sizes import along


@dataclass(frozen=True)
class Level:
    """A level that a curve may reach: ``value`` (n_x,) and ``draws`` (n_draws, n_x) come to it.

    ``levels`` is the level in every draw, where it is estimated itself.
    """

    name: str
    level: float
    value: Floats
    draws: Floats
    levels: Floats | float


def make_curve(
    kind: str,
    law: SizeLaw,
    lod: str,
    *,
    rows: pd.DataFrame,
    value: Floats,
    draws: Floats,
    base: tuple[float, float, float],
    points: pd.DataFrame,
    levels: Sequence[Level],
    confidence: float,
) -> SizeCurve:
    """Return the curve of one LoD at the sizes of ``along``; it rests on ``rows``."""
    x = along(law.sizes[lod])
    low, high = band(draws)
    return SizeCurve(
        kind=kind,
        measure=law.measure,
        lod=lod,
        best=law.best,
        sizes=2.0**x,
        value=value,
        low=low,
        high=high,
        base=base,
        points=points,
        thresholds=tuple(
            make_threshold(
                own.name,
                own.level,
                x,
                value=own.value,
                draws=own.draws,
                levels=own.levels,
                confidence=confidence,
            )
            for own in levels
        ),
        people=rows["participant"].nunique(),
        answers=len(rows),
    )
