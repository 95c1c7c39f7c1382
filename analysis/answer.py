"""The answer in sentences, one per distance: which LoD still looks as real as the best one shown.

Description, not proof of equality: a LoD without a demonstrated loss is named together with the
loss that the data do not rule out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from analysis.cost import Costs
from analysis.descriptive import differences_from_best, mean_ratings
from analysis.ordering import distance_order
from analysis.reading import Tables
from analysis.shares import pair_notice_shares
from analysis.wording import counted, interval, listed, milliseconds, number, people, percent


@dataclass(frozen=True)
class Finding:
    """What the data say at one distance; ``lod`` is the cheapest without a demonstrated loss."""

    distance: str
    sentence: str
    lod: str | None = None


def findings(tables: Tables, costs: Costs | None = None) -> list[Finding]:
    """Answer for each distance, closest first, in one sentence with its uncertainty."""
    means = mean_ratings(tables.ratings, ["distance", "lod"])
    gaps = differences_from_best(tables.ratings)
    noticed = pair_notice_shares(tables.comparisons)
    shown = tables.ratings[~tables.ratings["is_practice"]]
    return [
        _finding(
            distance,
            means[means["distance"] == distance],
            gaps[gaps["distance"] == distance],
            noticed[(noticed["distance"] == distance) & (noticed["answer"] == "yes")],
            costs,
        )
        for distance in distance_order(shown)
    ]


def _finding(
    distance: str,
    means: pd.DataFrame,
    gaps: pd.DataFrame,
    noticed: pd.DataFrame,
    costs: Costs | None,
) -> Finding:
    if means.empty:
        return Finding(distance, "no rating has been given, so nothing can be said.")
    if gaps.empty:
        return Finding(distance, _without_comparison(means))
    best = str(gaps["best"].iloc[0])
    measured = gaps[gaps["low"].notna()]
    if measured.empty:
        return Finding(distance, _without_interval(gaps, best))
    passed, failed = _split(measured)
    parts = [_verdict(best, passed, failed), *([_losses(best, failed)] if passed else [])]
    if passed:
        parts.append(_notice(str(passed[-1].lod), best, noticed))
    unmeasured = gaps.loc[gaps["low"].isna(), "lod"].tolist()
    if unmeasured:
        parts.append(f"for {listed(unmeasured)} the ratings give no interval")
    chosen = str(passed[-1].lod) if passed else best
    parts.append(_price(distance, chosen, best, costs))
    return Finding(distance, "; ".join(part for part in parts if part) + ".", chosen)


@dataclass(frozen=True)
class _Gap:
    lod: str
    people: int
    difference: float
    low: float
    high: float


def _split(gaps: pd.DataFrame) -> tuple[list[_Gap], list[_Gap]]:
    """Walk from the best LoD down; the first demonstrated loss ends the LoDs that pass."""
    passed: list[_Gap] = []
    failed: list[_Gap] = []
    for row in gaps.iloc[::-1].itertuples():
        gap = _Gap(
            str(row.lod),
            int(str(row.people)),
            *(float(str(getattr(row, name))) for name in ("difference", "low", "high")),
        )
        (failed if failed or gap.low > 0 else passed).append(gap)
    return passed, failed


def _verdict(best: str, passed: list[_Gap], failed: list[_Gap]) -> str:
    if not passed:
        lower = [_loss(gap) for gap in failed if gap.low > 0]
        every = "every lower LoD shown" if len(lower) == len(failed) else "the next LoD down"
        return (
            f"{every} was rated below {best}, {listed(lower)}, so among these only {best} will do"
        )
    last = passed[-1]
    risk = (
        f"but a loss of up to {number(last.high)} points is not ruled out"
        if last.high > 0
        else f"and {last.lod} was even rated higher"
    )
    return (
        f"{last.lod} is the least LoD not shown to be rated below {best} ({best} − {last.lod} = "
        f"{number(last.difference)} points, {_certainty(last)}), {risk}"
    )


def _losses(best: str, failed: list[_Gap]) -> str:
    """Say by how much the LoDs below the last one that passed were rated lower."""
    lower = [_loss(gap) for gap in failed if gap.low > 0]
    return f"rated below {best}: {listed(lower)}" if lower else ""


def _loss(gap: _Gap) -> str:
    return f"{gap.lod} by {number(gap.difference)} points ({_certainty(gap)})"


def _certainty(gap: _Gap) -> str:
    return f"95\N{NO-BREAK SPACE}% CI {interval(gap.low, gap.high)}, {people(gap.people)}"


def _notice(lod: str, best: str, noticed: pd.DataFrame) -> str:
    pair = noticed[(noticed["lesser"] == lod) & (noticed["greater"] == best)]
    if pair.empty:
        return ""
    row = pair.iloc[0]
    return (
        f"beside {best}, {percent(row['share'])} noticed a difference "
        f"({percent(row['low'])} to {percent(row['high'])}, {people(row['total'])})"
    )


def _price(distance: str, lod: str, best: str, costs: Costs | None) -> str:
    if costs is None:
        return ""
    own, full = costs.ms(distance, lod), costs.ms(distance, best)
    if own is None:
        return f"the cost of {lod} was not measured here"
    if lod == best or full is None:
        return f"{lod} costs {milliseconds(own)} per frame"
    saved = f", {percent(1 - own / full)} less" if full > own else ""
    return f"{lod} costs {milliseconds(own)} per frame, {best} {milliseconds(full)}{saved}"


def _without_comparison(means: pd.DataFrame) -> str:
    stated = _means_text(means)
    if len(means) == 1:
        return f"only one LoD was rated ({stated}), so nothing can be compared."
    return f"the LoDs have no rank, so none counts as the best; mean ratings: {stated}."


def _means_text(means: pd.DataFrame) -> str:
    columns = means[["lod", "mean", "low", "high", "people"]]
    return listed(
        [
            f"{lod} {number(mean)} ({interval(low, high)}, {people(count)})"
            for lod, mean, low, high, count in columns.itertuples(index=False, name=None)
        ]
    )


def _without_interval(gaps: pd.DataFrame, best: str) -> str:
    people = int(gaps["people"].max())
    if people == 0:
        return f"nobody rated both {best} and another LoD, so the two cannot be compared."
    stated = listed(
        [
            f"{best} − {lod} = {number(gap)}"
            for lod, gap in zip(gaps["lod"], gaps["difference"], strict=True)
            if np.isfinite(gap)
        ]
    )
    reason = "one person" if people == 1 else "people who all differ by the same amount"
    return (
        f"{stated} points, from {counted(people, 'person', 'people')}: with {reason} there is no "
        "interval, so nothing can be said about others."
    )
