"""The report's tables around the verdicts: single effects, thresholds in size, policy, joint scale.

The numbers are those of ``Inference``; this puts them into words.
"""

from __future__ import annotations

from typing import Any

import pandas as pd

from analysis.curves.curve import SizeCurve, Threshold
from analysis.decision.verdict_tables import effect_table
from analysis.inference.inferring import Inference
from analysis.report.tables import ReportTable
from analysis.tables.records import records
from analysis.words.wording import interval, number, percent

_QUESTIONS = {"noticed": "noticed", "preferred": "best LoD preferred", "rated": "rated lower"}
_LEVELS = {
    "margin": "at the margin",
    "d_prime_1": "d′ = 1",
    "halfway": "halfway between false alarms and all",
    "one_jod": "1 JOD",
}


def effects_table(inference: Inference) -> ReportTable:
    """Return the verdicts on LoDs without a rank, with what they lack."""
    rows = tuple(
        (
            str(row["distance"]),
            str(row["change"]),
            str(row["verdict"]),
            number(row["realism_loss"]),
            interval(row["realism_loss_low"], row["realism_loss_high"]),
            percent(row["noticed_excess"]),
            _shares(row["noticed_excess_low"], row["noticed_excess_high"]),
        )
        for row in records(effect_table(inference.effects))
    )
    head = ("distance", "LoD", "verdict", "points below the best", "bounds", "noticed beyond")
    return ReportTable(
        "Verdict on each LoD without a rank against the best.",
        (*head, "bounds of it"),
        rows,
        text_columns=3,
        note="P values are adjusted over each LoD's distances after Holm; bounds are not.",
    )


def thresholds_table(inference: Inference) -> ReportTable:
    """Return the sizes of the iris at which curves reach their levels."""
    rows = tuple(
        _threshold(curve, threshold)
        for curve in inference.curves.curves
        for threshold in curve.thresholds
    )
    return ReportTable(
        "Sizes of the iris at which a LoD is told from the best.",
        ("question", "LoD", "level", "size, with 95 % interval", "people", "answers"),
        rows,
        text_columns=4,
        note="Nothing is said beyond the sizes shown: a threshold there is only known to lie below "
        "the smallest or above the largest.",
    )


def policy_table(inference: Inference) -> ReportTable:
    """Return up to which size each LoD is enough, as lod_policy.json has it."""
    policy = inference.policy
    if policy is None:
        return ReportTable("", (), ())
    rows = tuple(
        (
            step.lod,
            "all larger" if step.up_to_px is None else f"{number(step.up_to_px, digits=1)} px",
            "–" if step.interval_px is None else f"{interval(*step.interval_px, digits=1)} px",
            "–" if step.ms is None else f"{number(step.ms[0])} ms",
        )
        for step in policy.steps
    )
    left_out = "; ".join(f"{lod}: {reason}" for lod, reason in policy.left_out.items())
    note = f"Enough: {policy.measure}. Interval: from that size to the one from which the LoD is "
    note += "shown not to be enough, or the largest shown."
    return ReportTable(
        "Up to which diameter of the iris each LoD is enough (lod_policy.json).",
        ("LoD", "up to", "interval", "per eye and frame"),
        rows,
        note=f"{note} Left out: {left_out}." if left_out else note,
    )


def joint_table(inference: Inference) -> ReportTable:
    """Return the scale of ratings and comparisons together beside that of ratings alone."""
    joint = inference.joint
    found = pd.DataFrame() if joint is None else joint.table(inference.best)
    rows = tuple(
        (
            str(row["distance"]),
            str(row["lod"]),
            number(row["rating"]),
            interval(row["rating_low"], row["rating_high"]),
            number(row.get("loss", float("nan"))),
            _span(row, "loss"),
            _span(row, "loss_alone"),
        )
        for row in records(found)
    )
    head = ("distance", "LoD", "mean rating", "95 % CI", "below the best", "95 % CI")
    return ReportTable(
        "Ratings and comparisons on one scale.",
        (*head, "95 % CI by ratings alone"),
        rows,
        text_columns=2,
        note=" ".join(inference.linkage.sentences()) if inference.linkage else "",
    )


def _threshold(curve: SizeCurve, threshold: Threshold) -> tuple[str, ...]:
    return (
        f"{_QUESTIONS.get(curve.kind, curve.kind)}, {curve.measure.name}",
        curve.lod,
        _LEVELS.get(threshold.name, threshold.name),
        curve.say(threshold),
        f"{curve.people}",
        f"{curve.answers}",
    )


def _shares(low: float, high: float) -> str:
    return "–" if pd.isna(low) else f"{percent(low)} to {percent(high)}"


def _span(row: dict[str, Any], name: str) -> str:
    low, high = (row.get(f"{name}_{end}", float("nan")) for end in ("low", "high"))
    return "–" if pd.isna(low) else interval(low, high)
