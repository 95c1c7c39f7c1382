"""The designer's answer along the size of the iris, in words."""

from __future__ import annotations

from analysis.costs.cost import Costs
from analysis.decision.policy import Policy, PolicyStep
from analysis.words.wording import listed, milliseconds, number


def policy_answer(policy: Policy, costs: Costs | None = None) -> str:
    """Say up to which size each LoD is enough, and what a frame costs per eye where known."""
    *lower, best = policy.steps
    if not lower:
        return (
            f"at no size is a LoD below {best.lod} shown to be enough "
            f"({_reasons(policy) or 'none was shown'})."
        )
    parts = [_up_to(step, timed=costs is not None) for step in lower]
    text = f"{listed(parts)}; {best.lod} above{_price(best) if costs else ''}"
    reasons = _reasons(policy)
    return f"{text}; {reasons}." if reasons else f"{text}."


def _up_to(step: PolicyStep, *, timed: bool) -> str:
    text = f"{step.lod} is enough up to an iris of {_px(step.up_to_px or 0.0)}"
    if step.interval_px and step.interval_px[1] > step.interval_px[0]:
        text += f" (undecided from there to {_px(step.interval_px[1])})"
    return text + (_price(step) if timed else "")


def _price(step: PolicyStep) -> str:
    if step.ms is None:
        return ", cost not measured"
    middle, low, high = map(milliseconds, step.ms)
    return f", {middle} of a frame per eye ({low} to {high})"


def _reasons(policy: Policy) -> str:
    return "; ".join(f"{lod}: {why}" for lod, why in policy.left_out.items())


def _px(size: float) -> str:
    return f"{number(size, digits=0 if size >= 20 else 1)}\N{NO-BREAK SPACE}px"
