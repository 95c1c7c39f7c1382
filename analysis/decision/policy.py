"""``lod_policy.json``: up to which size of the iris each LoD is enough, for an engine to load.

A LoD's limit is the size up to which it is shown, with the margins' confidence, to be neither rated
lower nor noticed. LoDs are taken from the highest down, and none reaches further than a finer one:
limits rise with the LoD, as an engine needs them. A curve also speaks of sizes between those shown,
by its form; so no limit reaches a size at which the verdict by distance is another than
"equivalent", nor beyond the largest size shown. docs/lod-by-pixels.md describes the file's form.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from analysis.cost import Costs
from analysis.curves.along_sizes import Curves
from analysis.curves.curve import MARGIN, NOTICED, RATED, Threshold
from analysis.curves.sizes import best_lod
from analysis.decision.effects import Levels, levels_of
from analysis.decision.margins import Margins
from analysis.decision.verdicts import EQUIVALENT, Decision
from analysis.descriptive import answered
from analysis.ordering import lod_ranks
from analysis.reading import Tables
from analysis.savings import cost_draws
from analysis.table import EFFECTS, STANDARD_LODS
from analysis.versions import own_version
from analysis.wording import percent

SCHEMA: Final = 1
HYSTERESIS, BAND = 0.1, 0.25  # as in the policy that comes with the renderer
_QUESTIONS: Final = (RATED, NOTICED)


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
    verdicts: Mapping[str, Mapping[float, bool]],
) -> Policy:
    """Derive the policy from the curves over pixels; with nothing shown, ``best`` alone remains.

    ``ranks`` order the LoDs, those below ``best`` with a rank are considered. ``verdicts`` say of
    each LoD at which sizes in pixels it was found equivalent, and at which not.
    """
    below = [lod for lod, rank in ranks.items() if 0 <= rank < ranks[best]]
    own = {kind: curves.of(kind) for kind in _QUESTIONS}
    shown = [lod for lod in below if any(lod in found for found in own.values())]
    steps: list[PolicyStep] = []
    left_out: dict[str, str] = {}
    reach, stopped_at = np.inf, ""
    for lod in sorted(shown, key=lambda name: -ranks[name]):
        limits = {kind: own[kind][lod] for kind in _QUESTIONS if lod in own[kind]}
        if missing := [kind for kind in _QUESTIONS if kind not in limits]:
            left_out[lod] = f"along pixels it is not known how it is {' and '.join(missing)}"
            reach, stopped_at = 0.0, stopped_at or lod
            continue
        found = [curve.threshold(MARGIN) for curve in limits.values()]
        largest = min(curve.shown[1] for curve in limits.values())
        reach = min(reach, largest, *(one.safe for one in found))
        reach = _confirmed(reach, verdicts.get(lod, {}))
        if reach == 0.0:
            left_out[lod] = _failure(stopped_at)
            stopped_at = stopped_at or lod
            continue
        steps = [step for step in steps if (step.up_to_px or 0.0) > _tenth(reach)]
        interval = (_tenth(reach), _tenth(_upper(found, largest)))
        steps.append(_step(lod, _tenth(reach), interval, levels=levels, costs=costs))
    kept = {step.lod for step in steps}
    left_out |= {
        lod: "a coarser one is enough up to the same size"
        for lod in shown
        if lod not in kept and lod not in left_out
    }
    last = _step(best, None, None, levels=levels, costs=costs)
    return Policy(
        steps=(*reversed(steps), last),
        left_out=left_out,
        measure=_measure(best, margins),
        provenance={**provenance, **_evidence(curves, margins)},
    )


def policy_for(
    tables: Tables,
    curves: Curves,
    *,
    decisions: Sequence[Decision],
    margins: Margins,
    costs: Costs | None,
) -> Policy | None:
    """Derive a study's policy; None where no LoD with a rank has a curve over pixels."""
    ranks = margins.order(lod_ranks(tables.ratings))
    best = best_lod(tables.ratings, tables.comparisons, ranks)
    ranked = {lod for kind in _QUESTIONS for lod in curves.of(kind) if ranks.get(lod, -1.0) >= 0}
    if best is None or not ranked:
        return None
    return policy_of(
        curves,
        best,
        ranks,
        levels=levels_of(tables.ratings),
        margins=margins,
        costs=costs,
        provenance=_origin(tables, costs),
        verdicts=_by_size(decisions, tables),
    )


def _by_size(decisions: Sequence[Decision], tables: Tables) -> dict[str, dict[float, bool]]:
    """Return whether each LoD was found equivalent, by the median size at the distance."""
    size = tables.ratings.groupby("distance")["iris_px"].median().to_dict()
    found: dict[str, dict[float, bool]] = {}
    for decision in decisions:
        px = float(size.get(decision.distance, np.nan))
        for verdict in decision.verdicts if np.isfinite(px) else ():
            found.setdefault(verdict.lod, {})[px] = verdict.outcome == EQUIVALENT
    return found


def _origin(tables: Tables, costs: Costs | None) -> dict[str, Any]:
    named = tables.ratings[["study", "study_version"]].dropna(how="all").drop_duplicates()
    return {
        "command": "ocularist analyse",
        "version": own_version(),
        "study": [" ".join(map(str, row.dropna())) for _, row in named.iterrows()],
        "simulated": tables.is_simulated,
        "people": int(answered(tables.ratings)["participant"].nunique()),
        "ratings": len(answered(tables.ratings)),
        "comparisons": int((~tables.comparisons["is_practice"]).sum()),
        "costs": f"milliseconds of a frame per eye: {costs.condition}" if costs else None,
    }


def _failure(stopped_at: str) -> str:
    if stopped_at:
        return f"not tested after {stopped_at}, which is not shown to be enough"
    return "not shown to be enough at any size"


def _step(
    lod: str,
    up_to: float | None,
    interval: tuple[float, float] | None,
    *,
    levels: Levels,
    costs: Costs | None,
) -> PolicyStep:
    return PolicyStep(lod, _own_levels(lod, levels), up_to, interval, _ms(lod, up_to, costs))


def _own_levels(lod: str, levels: Levels) -> dict[str, str] | None:
    """Return the seven levels where the name alone does not say them."""
    own = {effect: levels.get(lod, {}).get(effect, "") for effect in EFFECTS}
    is_known = all(own.values())
    if lod in STANDARD_LODS and (not is_known or set(own.values()) == {lod}):
        return None
    return own if is_known else None


def _confirmed(reach: float, verdicts: Mapping[float, bool]) -> float:
    """Shorten a curve's limit to the sizes before the first one that was not found equivalent."""
    first = min((px for px, is_equivalent in verdicts.items() if not is_equivalent), default=np.inf)
    if reach < first:
        return reach
    return max((px for px, is_equivalent in verdicts.items() if px < first), default=0.0)


def _upper(found: list[Threshold], largest: float) -> float:
    """Return the size from which one of the questions shows that the LoD is not enough."""
    return float(min(largest, *(one.high for one in found)))


def _ms(lod: str, up_to: float | None, costs: Costs | None) -> tuple[float, float, float] | None:
    """Return the frame's milliseconds per eye, measured nearest to the size up to which it is used.

    The finest is taken at its largest.
    """
    if costs is None:
        return None
    rows = costs.table[costs.table["lod"] == lod]
    if rows.empty:
        return None
    px = rows["iris_px"].to_numpy(dtype=float)
    away = -px if up_to is None else np.abs(np.log(np.maximum(px, 1e-3) / up_to))
    distance = str(rows["distance"].iloc[int(np.argmin(away))])
    draws, middle = cost_draws(costs, distance, lod), costs.ms(distance, lod)
    if draws is None or middle is None:
        return None
    low, high = np.quantile(draws, (0.025, 0.975))
    numbers = (round(float(ms) / costs.eyes, 3) for ms in (middle, low, high))
    return next(numbers), next(numbers), next(numbers)


def _measure(best: str, margins: Margins) -> str:
    return (
        f"rated at most {margins.realism_points:g} points below {best} and noticed beside it by at "
        f"most {percent(margins.noticed_share)} of people beyond false alarms, both shown with "
        f"{percent(margins.confidence)} confidence"
    )


def _evidence(curves: Curves, margins: Margins) -> dict[str, Any]:
    """Return the margins, the sizes shown, and each LoD's own limits with their intervals."""
    limits: dict[str, dict[str, Any]] = {}
    own = [curve for kind in _QUESTIONS for curve in curves.of(kind).values()]
    for curve in own:
        found = curve.threshold(MARGIN)
        sizes = {"estimate": found.size, "low": found.low, "high": found.high, "safe": found.safe}
        limits.setdefault(curve.lod, {})[curve.kind] = {
            name: _tenth(size) if found.where(size) == "shown" else found.where(size)
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
        "sizes_shown_px": [_tenth(min(shown)), _tenth(max(shown))] if shown else None,
        "limits_px": limits,
    }


def _tenth(size: float) -> float:
    """Round down to a tenth of a pixel: never beyond what was shown."""
    return float(np.floor(size * 10) / 10)
