"""Does a verdict on an effect hang on one person? Each verdict without each person.

As with verdicts on LoDs with a rank: estimates move with the person left out, draws move with them
and keep their width. P values are adjusted over the LoD's distances anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pandas as pd

from analysis.decision.effects import EffectVerdict, decided
from analysis.decision.verdicts import Test, against, excess_of
from analysis.estimates.noticing import Noticing
from analysis.estimates.realism import Realism
from analysis.inference.leaving_out import COLUMNS, Floats, WithoutEach, without_each


def effects_without_each(
    effects: Sequence[EffectVerdict],
    realism: Realism | None,
    noticing: Noticing | None,
    *,
    comparisons: pd.DataFrame,
) -> pd.DataFrame:
    """Return every verdict on a LoD without a rank without each person; columns are COLUMNS.

    Empty where ``verdicts_without_each`` is: for fewer than 3 or more than 400 people.
    """
    each = without_each(realism, noticing, comparisons=comparisons) if effects else None
    if realism is None or each is None:
        return pd.DataFrame(columns=list(COLUMNS))
    found: list[list[EffectVerdict]] = [[] for _ in each.people]
    ratings, lods = realism.expected(), list(dict.fromkeys(own.lod for own in effects))
    usual = sorted(effects, key=lambda own: lods.index(own.lod))
    for lod in lods:
        moved = [_each(own, ratings, noticing, each) for own in usual if own.lod == lod]
        for person, own in enumerate(zip(*moved, strict=True)):
            found[person] += decided(own)
    rows = [
        (who, verdict.distance, verdict.lod, verdict.outcome, known.outcome,
         verdict.outcome != known.outcome)
        for who, verdicts in zip(each.people, found, strict=True)
        for verdict, known in zip(verdicts, usual, strict=True)
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _each(
    own: EffectVerdict,
    ratings: tuple[Floats, Floats],
    noticing: Noticing | None,
    each: WithoutEach,
) -> list[EffectVerdict]:
    """Return one verdict without each person, its p values not adjusted yet."""
    place = (own.distance, own.lod, own.best)
    rating, draws = ratings
    top, low = (each.cells.index((own.distance, lod)) for lod in (own.best, own.lod))
    loss = _around(own.realism, (rating[top] - rating[low], draws[:, top] - draws[:, low]),
                   each.loss(*place), level=own.level)  # fmt: skip
    seen, excess = excess_of(noticing, place), each.excess(*place)
    noticed: list[Test | None] = [own.noticed] * len(loss)
    if own.noticed is not None and seen is not None and excess is not None:
        noticed = list(_around(own.noticed, seen, excess, level=own.level))
    return [replace(own, realism=a, noticed=b) for a, b in zip(loss, noticed, strict=True)]


def _around(test: Test, usual: tuple[float, Floats], moved: Floats, *, level: float) -> list[Test]:
    value, draws = usual
    return [
        against(float(to), draws + (to - value), test.margin, confidence=1.0 - level)
        for to in moved
    ]
