"""``lod_policy.json``: up to which size of the iris each LoD is enough, for an engine to load.

A LoD's limit is the size up to which it is shown, with the margins' confidence, to be neither rated
lower nor noticed. Nothing is said of sizes that were not shown: no limit lies beyond the largest.
docs/lod-by-pixels.md describes the file's form, which the renderer reads.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from analysis.costs.cost import Costs
from analysis.costs.savings import frame_ms
from analysis.curves.along_sizes import Curves
from analysis.curves.curve import MARGIN, SHOWN
from analysis.decision.effects import Levels
from analysis.decision.margins import Margins
from analysis.decision.size_limits import QUESTIONS, Verdicts, size_limits
from analysis.tables.columns import EFFECTS, STANDARD_LODS
from analysis.words.wording import percent

SCHEMA: Final = 1
HYSTERESIS, BAND = 0.1, 0.25  # as in the policy that comes with the renderer


@dataclass(frozen=True)
class PolicyStep:
    """One LoD and the largest iris in pixels that it is shown to be enough for.

    ``up_to_px`` is None for the best, which is used for everything larger. ``interval_px`` goes
    from that size to the one from which the LoD is shown not to be enough, or to the largest shown.
    ``ms`` are milliseconds of a frame per eye with their 95 % interval, None where not measured.
    """

    lod: str
    levels: Mapping[str, str] | None
    up_to_px: float | None
    interval_px: tuple[float, float] | None
    ms: tuple[float, float, float] | None


@dataclass(frozen=True)
class Policy:
    """LoDs from coarse to fine; ``left_out`` says of the others why they are not among them."""

    steps: tuple[PolicyStep, ...]
    left_out: Mapping[str, str]
    measure: str
    provenance: Mapping[str, Any] = field(default_factory=dict)

    def text(self) -> str:
        """Return the file's content."""
        rows = [
            {
                "lod": step.lod,
                **({"levels": dict(step.levels)} if step.levels else {}),
                "up_to_iris_px": step.up_to_px,
                "interval_px": list(step.interval_px) if step.interval_px else None,
                "ms": step.ms[0] if step.ms else None,
            }
            for step in self.steps
        ]
        content = {
            "schema": SCHEMA,
            "measure": self.measure,
            "hysteresis": HYSTERESIS,
            "band": BAND,
            "steps": rows,
            "provenance": {
                **self.provenance,
                "ms_interval": {step.lod: list(step.ms[1:]) for step in self.steps if step.ms},
                "left_out": dict(self.left_out),
            },
        }
        return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def policy_of(
    curves: Curves,
    best: str,
    ranks: Mapping[str, float],
    *,
    levels: Levels,
    margins: Margins,
    costs: Costs | None,
    provenance: Mapping[str, Any],
    verdicts: Mapping[str, Verdicts],
) -> Policy:
    """Derive the policy from the curves over pixels; with nothing shown, ``best`` alone remains.

    ``ranks`` order the LoDs, those below ``best`` with a rank are considered. ``verdicts`` say of
    each LoD at which sizes in pixels it was found equivalent, and at which not.
    """
    below = [lod for lod, rank in ranks.items() if 0 <= rank < ranks[best]]
    shown = [lod for lod in below if lod in verdicts or lod in with_curves(curves)]
    limits = size_limits(sorted(shown, key=lambda lod: -ranks[lod]), curves, verdicts)
    steps: list[PolicyStep] = []
    left_out: dict[str, str] = {}
    for limit in limits:
        reach = tenth(limit.safe)
        if reach == 0.0:
            left_out[limit.lod] = limit.why
            continue
        overtaken = [step.lod for step in steps if (step.up_to_px or 0.0) <= reach]
        left_out |= dict.fromkeys(overtaken, "a coarser one is enough up to the same size")
        steps = [step for step in steps if step.lod not in overtaken]
        interval = (reach, tenth(limit.upper))
        steps.append(_step(limit.lod, reach, interval, levels=levels, costs=costs))
    last = _step(best, None, None, levels=levels, costs=costs)
    return Policy(
        steps=(*reversed(steps), last),
        left_out=left_out,
        measure=_measure(best, margins),
        provenance={**provenance, **_evidence(curves, margins)},
    )


def with_curves(curves: Curves) -> set[str]:
    """Return the LoDs that have a curve over pixels."""
    return {lod for kind in QUESTIONS for lod in curves.of(kind)}


def _step(
    lod: str,
    up_to: float | None,
    interval: tuple[float, float] | None,
    *,
    levels: Levels,
    costs: Costs | None,
) -> PolicyStep:
    ms = frame_ms(costs, lod, px=up_to) if costs else None
    return PolicyStep(lod, _own_levels(lod, levels), up_to, interval, ms)


def _own_levels(lod: str, levels: Levels) -> dict[str, str] | None:
    """Return the seven levels where the name alone does not say them."""
    own = {effect: levels.get(lod, {}).get(effect, "") for effect in EFFECTS}
    is_known = all(own.values())
    if lod in STANDARD_LODS and (not is_known or set(own.values()) == {lod}):
        return None
    return own if is_known else None


def _measure(best: str, margins: Margins) -> str:
    return (
        f"rated at most {margins.realism_points:g} points below {best} and noticed beside it by at "
        f"most {percent(margins.noticed_share)} of people beyond false alarms, both shown with "
        f"{percent(margins.confidence)} confidence"
    )


def _evidence(curves: Curves, margins: Margins) -> dict[str, Any]:
    """Return the margins, the sizes shown, and each LoD's own limits with their intervals."""
    limits: dict[str, dict[str, Any]] = {}
    own = [curve for kind in QUESTIONS for curve in curves.of(kind).values()]
    for curve in own:
        found = curve.threshold(MARGIN)
        sizes = {"estimate": found.size, "low": found.low, "high": found.high, "safe": found.safe}
        limits.setdefault(curve.lod, {})[curve.kind] = {
            name: tenth(size) if found.where(size) == SHOWN else found.where(size)
            for name, size in sizes.items()
        }
    shown = [size for curve in own for size in curve.shown]
    return {
        "margins": {
            "realism_points": margins.realism_points,
            "noticed_share": margins.noticed_share,
            "confidence": margins.confidence,
            "origin": margins.origins,
        },
        "sizes_shown_px": [tenth(min(shown)), tenth(max(shown))] if shown else None,
        "limits_px": limits,
    }


def tenth(size: float) -> float:
    """Round down to a tenth of a pixel: never beyond what was shown."""
    return float(np.floor(size * 10 + 1e-6) / 10)  # logarithms do not come back exactly
