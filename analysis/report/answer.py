"""The answer in sentences, one per distance: which LoD still looks as real as the best one shown.

Description, not proof of equality: a LoD without a demonstrated loss is named together with the
loss that the data do not rule out, and where that is large nothing is named.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import pandas as pd

from analysis.costs.cost import Costs
from analysis.descriptive.means import differences_from_best, mean_ratings
from analysis.descriptive.shares import pair_notice_shares
from analysis.tables.ordering import distance_order
from analysis.tables.reading import Tables
from analysis.words.wording import interval, listed, milliseconds, number, people, percent

# Where a loss of half the scale is not ruled out, "not shown to be lower" would mislead.
_WORST_RISK: Final = 0.5


@dataclass(frozen=True)
class Finding:
    """What the data say at one distance; ``lod`` is the least without a demonstrated loss."""

    distance: str
    sentence: str
    lod: str | None = None


@dataclass(frozen=True)
class _Gap:
    """How far one LoD was rated below the best, within people."""

    lod: str
    is_ranked: bool
    people: int
    difference: float
    low: float
    high: float

    @property
    def certainty(self) -> str:
        known = interval(self.low, self.high)
        return f"95\N{NO-BREAK SPACE}% CI {known}, {people(self.people)}"

    @property
    def is_loss(self) -> bool:
        return self.low > 0


def findings(tables: Tables, costs: Costs | None = None) -> list[Finding]:
    """Answer for each distance, closest first, in one sentence with its uncertainty."""
    means = mean_ratings(tables.ratings, ["distance", "lod"])
    gaps = differences_from_best(tables.ratings)
    noticed = pair_notice_shares(tables.comparisons)
    shown = tables.ratings[~tables.ratings["is_practice"]]
    worst = _WORST_RISK * (tables.scale[1] - tables.scale[0])
    found = []
    for distance in distance_order(shown):
        own = gaps[gaps["distance"] == distance]
        yes = noticed[(noticed["distance"] == distance) & (noticed["answer"] == "yes")]
        if own.empty:
            found.append(_without_best(distance, means[means["distance"] == distance]))
        else:
            best = str(own["best"].iloc[0])
            found.append(_compare(distance, best, _gaps(own), worst, noticed=yes, costs=costs))
    return found


def _gaps(rows: pd.DataFrame) -> list[_Gap]:
    """Return the differences from the best LoD, from its neighbour downwards."""
    columns = ["lod", "is_ranked", "people", "difference", "low", "high"]
    cells = rows[columns].iloc[::-1].itertuples(index=False, name=None)
    return [_Gap(str(a), bool(b), int(c), *map(float, rest)) for a, b, c, *rest in cells]


def _compare(
    distance: str,
    best: str,
    gaps: Sequence[_Gap],
    worst: float,
    *,
    noticed: pd.DataFrame,
    costs: Costs | None,
) -> Finding:
    measured = [gap for gap in gaps if pd.notna(gap.low)]
    if not measured:
        return Finding(distance, _without_interval(best, gaps))
    ranked = [gap for gap in measured if gap.is_ranked]
    passed: list[_Gap] = []
    for gap in ranked:
        if gap.is_loss or gap.high > worst:
            break
        passed.append(gap)
    rest = ranked[len(passed) :]
    parts = [_verdict(best, passed, rest), _undecided(best, rest)]
    if passed:
        parts += [_losses(best, rest), _notice(passed[-1].lod, best, noticed)]
    parts.append(_unranked(best, [gap for gap in measured if not gap.is_ranked]))
    parts.append(_unmeasured([gap.lod for gap in gaps if pd.isna(gap.low)]))
    is_decided = bool(passed) or (bool(rest) and rest[0].is_loss)
    chosen = (passed[-1].lod if passed else best) if is_decided else None
    parts.append(_price(distance, chosen, best, costs))
    return Finding(distance, "; ".join(part for part in parts if part) + ".", chosen)


def _verdict(best: str, passed: Sequence[_Gap], rest: Sequence[_Gap]) -> str:
    if passed:
        last = passed[-1]
        risk = (
            f"but a loss of up to {number(last.high)} points is not ruled out"
            if last.high > 0
            else f"and {last.lod} was even rated higher"
        )
        return (
            f"{last.lod} is the least LoD not shown to be rated below {best} ({best} − {last.lod} "
            f"= {number(last.difference)} points, {last.certainty}), {risk}"
        )
    if rest and rest[0].is_loss:
        lower = [gap for gap in rest if gap.is_loss]
        every = "every lower LoD shown" if len(lower) == len(rest) else "the next LoD down"
        stated = listed([_loss(gap) for gap in lower])
        return (
            f"{every} was rated below {best}, {stated}, so by the means alone only {best} is left"
        )
    return _losses(best, rest)


def _undecided(best: str, rest: Sequence[_Gap]) -> str:
    """Name the LoDs that were neither shown to be lower nor known well enough to pass."""
    unsure = [gap for gap in rest if not gap.is_loss]
    return f"too little is known about {listed(_stated(best, unsure))}" if unsure else ""


def _stated(best: str, gaps: Sequence[_Gap]) -> list[str]:
    return [
        f"{gap.lod} ({best} − {gap.lod} = {number(gap.difference)} points, {gap.certainty})"
        for gap in gaps
    ]


def _losses(best: str, gaps: Sequence[_Gap]) -> str:
    lower = [_loss(gap) for gap in gaps if gap.is_loss]
    return f"rated below {best}: {listed(lower)}" if lower else ""


def _loss(gap: _Gap) -> str:
    return f"{gap.lod} by {number(gap.difference)} points ({gap.certainty})"


def _unranked(best: str, gaps: Sequence[_Gap]) -> str:
    return f"without a rank: {listed(_stated(best, gaps))}" if gaps else ""


def _unmeasured(lods: Sequence[str]) -> str:
    return f"for {listed(lods)} the ratings give no interval" if lods else ""


def _notice(lod: str, best: str, noticed: pd.DataFrame) -> str:
    pair = noticed[(noticed["lesser"] == lod) & (noticed["greater"] == best)]
    if pair.empty:
        return ""
    row = pair.iloc[0]
    return (
        f"beside {best}, {percent(row['share'])} noticed a difference "
        f"({percent(row['low'])} to {percent(row['high'])} of {row['total']} answers)"
    )


def _price(distance: str, lod: str | None, best: str, costs: Costs | None) -> str:
    if costs is None or lod is None:
        return ""
    own, full = costs.ms(distance, lod), costs.ms(distance, best)
    if own is None:
        return f"the cost of {lod} was not measured here"
    if lod == best or full is None:
        return f"{lod} costs {milliseconds(own)} per frame"
    saved = f", {percent(1 - own / full)} less" if full > own else ""
    return f"{lod} costs {milliseconds(own)} per frame, {best} {milliseconds(full)}{saved}"


def _without_best(distance: str, means: pd.DataFrame) -> Finding:
    if means.empty:
        return Finding(distance, "no rating has been given, so nothing can be said.")
    columns = means[["lod", "mean", "low", "high", "people"]]
    stated = listed(
        [
            f"{lod} {number(mean)} ({interval(low, high)}, {people(count)})"
            for lod, mean, low, high, count in columns.itertuples(index=False, name=None)
        ]
    )
    if len(means) == 1:
        return Finding(distance, f"only one LoD was rated: {stated}, so nothing can be compared.")
    return Finding(
        distance, f"the LoDs have no rank, so none counts as the best; mean ratings: {stated}."
    )


def _without_interval(best: str, gaps: Sequence[_Gap]) -> str:
    most = max(gap.people for gap in gaps)
    if most == 0:
        return f"nobody rated both {best} and another LoD, so they cannot be compared."
    known = [gap for gap in gaps if gap.people]
    stated = listed([f"{best} − {gap.lod} = {number(gap.difference)}" for gap in known])
    if most == 1:
        reason = "from one person, which says nothing about others"
    else:
        reason = f"the same for all {most} people, which gives no interval"
    return f"{stated} points, {reason}."
