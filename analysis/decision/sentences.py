"""The designer's answer in one sentence per distance, with its uncertainty and what it saves."""

from __future__ import annotations

import math

from analysis.costs.cost import Costs
from analysis.costs.savings import Saving, lod_saving
from analysis.decision.verdicts import DIFFERENT, Decision, Verdict
from analysis.words.wording import listed, milliseconds, number, percent


def answer(decision: Decision, costs: Costs | None = None) -> str:
    """Say which LoD is enough at one distance, by how much it may fall short, and what failed.

    With ``costs`` also what it saves against the best.
    """
    passed = [v for v in decision.verdicts if v.lod == decision.lod]
    if not passed:
        return f"only {decision.best} was shown to be enough: {_failures(decision)}."
    last = passed[0]
    parts = [f"{last.lod} is enough: {_bounds(last)}"]
    if (share := last.share_cheapest) < 0.995:
        parts.append(f"with a probability of {percent(share)} it is the cheapest that is")
    if costs is not None:
        saved = lod_saving(costs, decision.distance, last.lod, best=last.best)
        parts.append(price(saved) if saved else "what it saves was not measured here")
    if failures := _failures(decision, beyond=last.lod):
        parts.append(failures)
    return "; ".join(parts) + "."


def _bounds(verdict: Verdict) -> str:
    text = (
        f"rated at most {number(max(verdict.realism.high, 0.0))} points below {verdict.best} "
        f"(margin {number(verdict.realism.margin)})"
    )
    if verdict.noticed is None:
        return text
    return (
        f"{text} and noticed by at most {percent(max(verdict.noticed.high, 0.0))} of people beyond "
        f"false alarms (margin {percent(verdict.noticed.margin)})"
    )


def price(saving: Saving) -> str:
    """Write what a LoD saves: milliseconds per eye, and the share of the frame if known."""
    if saving.high <= 0:
        return f"it saves nothing: {_milliseconds(-saving.ms)} per eye are added"
    text = (
        f"it saves {_milliseconds(saving.ms)} per eye ({_milliseconds(saving.low)} to "
        f"{_milliseconds(saving.high)})"
    )
    if saving.low <= 0:
        text += ", not told apart from nothing"
    if not math.isfinite(saving.share):
        return text
    return (
        f"{text}, {percent(saving.share)} of the frame ({percent(saving.share_low)} to "
        f"{percent(saving.share_high)})"
    )


def _milliseconds(value: float) -> str:
    return milliseconds(abs(value)) if value >= 0 else f"−{milliseconds(-value)}"


def _failures(decision: Decision, *, beyond: str | None = None) -> str:
    names = [verdict.lod for verdict in decision.verdicts]
    rest = decision.verdicts[names.index(beyond) + 1 if beyond else 0 :]
    return listed([_failure(verdict) for verdict in rest])


def _failure(verdict: Verdict) -> str:
    if verdict.outcome == DIFFERENT:
        reasons = []
        if verdict.realism.fails:
            reasons.append(f"rated {number(verdict.realism.value)} points lower")
        if verdict.noticed is not None and verdict.noticed.fails:
            reasons.append(f"noticed by {percent(verdict.noticed.value)} beyond false alarms")
            if verdict.realism.passes:
                reasons.append("different but not rated lower")
        return f"{verdict.lod} is not ({listed(reasons)})"
    if not verdict.is_reached:
        return f"{verdict.lod} was not tested after that"
    return f"for {verdict.lod} it was not shown ({_doubt(verdict)})"


def _doubt(verdict: Verdict) -> str:
    doubts = []
    if not verdict.realism.passes:
        doubts.append(f"a loss of up to {number(verdict.realism.high)} points is not ruled out")
    if verdict.noticed is None:
        doubts.append("whether it is noticed beyond false alarms was not measured")
    elif not verdict.noticed.passes:
        doubts.append(f"up to {percent(verdict.noticed.high)} may notice it")
    return " and ".join(doubts)
