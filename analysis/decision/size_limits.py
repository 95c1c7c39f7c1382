"""Up to which size of the iris each LoD is shown to be enough.

At the sizes shown the verdicts by distance speak; between the last one at which a LoD is equivalent
and the first at which it is not, the curves do, by their form. LoDs are taken from the highest
down, and none reaches further than a finer one: an engine needs limits that rise with the LoD.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.curves.along_sizes import Curves
from analysis.curves.curve import MARGIN, NOTICED, RATED, SizeCurve

QUESTIONS: Final = (RATED, NOTICED)
Verdicts = Mapping[float, bool]  # the size in pixels -> whether the LoD was found equivalent there


@dataclass(frozen=True)
class Limit:
    """One LoD's limit: enough up to ``safe`` pixels, shown not to be beyond ``upper``.

    ``safe`` is 0 where nothing is shown, and then ``why`` says so.
    """

    lod: str
    safe: float
    upper: float
    why: str = ""


def size_limits(
    lods: Iterable[str], curves: Curves, verdicts: Mapping[str, Verdicts]
) -> tuple[Limit, ...]:
    """Return the limit of each LoD, given from the highest down."""
    own = {kind: curves.of(kind) for kind in QUESTIONS}
    made: list[Limit] = []
    reach, stopped_at = np.inf, ""
    for lod in lods:
        found = {kind: own[kind][lod] for kind in QUESTIONS if lod in own[kind]}
        safe, upper = _one(found, verdicts.get(lod, {}))
        reach = min(reach, safe)
        if reach > 0.0:
            made.append(Limit(lod, reach, max(upper, reach)))
            continue
        missing = [kind for kind in QUESTIONS if kind not in found]
        made.append(Limit(lod, 0.0, upper, _why(missing, stopped_at)))
        stopped_at = stopped_at or lod
    return tuple(made)


def _one(curves: Mapping[str, SizeCurve], verdicts: Verdicts) -> tuple[float, float]:
    """Return the size up to which one LoD is enough, and the one from which it is not."""
    failed = min(
        (px for px, is_equivalent in verdicts.items() if not is_equivalent), default=np.inf
    )
    shown = max((px for px, is_equal in verdicts.items() if is_equal and px < failed), default=0.0)
    if len(curves) < len(QUESTIONS):
        return shown, min(failed, max(verdicts, default=0.0))
    found = [curve.threshold(MARGIN) for curve in curves.values()]
    largest = min(curve.shown[1] for curve in curves.values())
    safe = min(largest, *(one.safe for one in found))
    upper = min(largest, *(one.high for one in found))
    return (shown if safe >= failed else max(safe, shown)), float(upper)


def _why(missing: list[str], stopped_at: str) -> str:
    if stopped_at:
        return f"not tested after {stopped_at}, which is not shown to be enough"
    if missing:
        return f"along pixels it is not known how it is {' and '.join(missing)}"
    return "not shown to be enough at any size"
