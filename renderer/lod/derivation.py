"""From measured errors to a policy: the largest size at which each LoD is good enough. Pure.

A LoD's error grows with the size of the eye. Every case, an eye seen under one angle, has its own
size at which the error passes what people just notice; a policy takes the median of them and tells
their range.
"""

from __future__ import annotations

import itertools
import math
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from renderer.detail import Detail
from renderer.lod.choice import LodPolicy, LodStep
from renderer.lod.policy import Evidence, PolicyFile


@dataclass(frozen=True)
class LodError:
    """How visibly one LoD differs from the reference in one eye's rectangle.

    ``iris_px`` is the iris's diameter on the picture; ``case`` tells apart whose eye it is and from
    where it is seen.
    """

    lod: str
    case: str
    iris_px: float
    error: float


def limit_px(errors: Iterable[LodError], just_noticeable: float) -> float:
    """Return the size up to which the errors of one LoD and case stay below ``just_noticeable``.

    Between two measured sizes the error is linear in the logarithm of the size. It is the largest
    size measured where no error reaches the threshold, and 0 where the first one does already.
    """
    rows = sorted(errors, key=lambda row: row.iris_px)
    if rows[0].error >= just_noticeable:
        return 0.0
    for below, above in itertools.pairwise(rows):
        if above.error >= just_noticeable:
            way = (just_noticeable - below.error) / (above.error - below.error)
            return math.exp((1 - way) * math.log(below.iris_px) + way * math.log(above.iris_px))
    return rows[-1].iris_px


def limits_px(errors: Iterable[LodError], just_noticeable: float) -> dict[str, list[float]]:
    """Return every LoD's limits, one per case, in ascending order."""
    by_case: dict[tuple[str, str], list[LodError]] = defaultdict(list)
    for row in errors:
        by_case[row.lod, row.case].append(row)
    limits: dict[str, list[float]] = defaultdict(list)
    for (lod, _), rows in by_case.items():
        limits[lod].append(limit_px(rows, just_noticeable))
    return {lod: sorted(found) for lod, found in limits.items()}


def derive_policy(
    errors: Sequence[LodError],
    lods: Mapping[str, Detail],
    *,
    reference: tuple[str, Detail],
    just_noticeable: float,
    provenance: Mapping[str, Any],
) -> PolicyFile:
    """Return the policy of LoDs from coarse to fine, ``reference`` last.

    A LoD is left out where a coarser one serves as far: it would cost more and show nothing.
    """
    found = limits_px(errors, just_noticeable)
    steps: list[LodStep] = []
    evidence: list[Evidence] = []
    reached = 0.0
    for lod, detail in lods.items():
        limit = round(float(np.median(found[lod])), 1)
        if limit > reached:
            steps.append(LodStep(lod, detail, limit))
            evidence.append(Evidence((round(found[lod][0], 1), round(found[lod][-1], 1))))
            reached = limit
    return PolicyFile(
        policy=LodPolicy((*steps, LodStep(*reference, None))),
        evidence=(*evidence, Evidence()),
        measure=f"mean S-CIELAB difference of {just_noticeable:g} from {reference[0]}",
        provenance={
            **provenance,
            "just_noticeable": just_noticeable,
            "limits_px": {lod: [round(px, 1) for px in limits] for lod, limits in found.items()},
            "mean_error": mean_errors(errors),
        },
    )


def mean_errors(errors: Iterable[LodError]) -> dict[str, dict[str, float]]:
    """Return the mean error over the cases by LoD and nearest whole size in pixels."""
    groups: dict[str, dict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
    for row in errors:
        groups[row.lod][f"{row.iris_px:.0f}"].append(row.error)
    return {
        lod: {size: round(float(np.mean(found)), 3) for size, found in sizes.items()}
        for lod, sizes in groups.items()
    }
