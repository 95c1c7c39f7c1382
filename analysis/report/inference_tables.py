"""The report's tables of verdicts and of the models behind them."""

from __future__ import annotations

import numpy as np

from analysis.decision.verdicts import Verdict
from analysis.inference.inferring import Inference
from analysis.report.tables import ReportTable
from analysis.tables.records import records
from analysis.words.wording import interval, number, percent


def inference_tables(inference: Inference) -> list[ReportTable]:
    """Return verdicts, latent realism, preference and detection; those without rows left out."""
    made = [_verdicts(inference), _realism(inference), _preference(inference), _noticing(inference)]
    return [table for table in made if table.rows]


def _verdicts(inference: Inference) -> ReportTable:
    rows = tuple(
        _verdict_row(verdict, chosen=decision.lod == verdict.lod)
        for decision in inference.decisions
        for verdict in decision.verdicts
    )
    own = inference.margins
    head = ("distance", "LoD", "verdict", "points below the best", "bounds", "noticed beyond")
    note = (
        f"Margins: {number(own.realism_points)} points, {percent(own.noticed_share)} of people "
        f"({own.origins}); "
        f"bounds are one-sided, {percent(own.confidence)} each. LoDs are tested from the highest "
        "down and only until one fails. “Not shown” is no proof of a difference, nor of equality. "
        "Cheapest: share of draws from what the data leave open in which the LoD is the cheapest "
        "that is enough. * The cheapest that was shown to be enough."
    )
    return ReportTable(
        "Verdict on each LoD against the highest one shown there.",
        (*head, "bounds of it", "cheapest"),
        rows,
        text_columns=3,
        note=note,
    )


def _verdict_row(verdict: Verdict, *, chosen: bool) -> tuple[str, ...]:
    loss, noticed = verdict.realism, verdict.noticed
    name = verdict.outcome if verdict.is_reached else f"{verdict.outcome} (not tested)"
    if verdict.outcome == "different":
        name = verdict.outcome
    seen = (
        (percent(noticed.value), f"{percent(noticed.low)} to {percent(noticed.high)}")
        if noticed
        else ("–", "–")
    )
    return (
        verdict.distance,
        verdict.lod + (" *" if chosen else ""),
        name,
        number(loss.value),
        interval(loss.low, loss.high),
        *seen,
        percent(verdict.share_cheapest),
    )


def _realism(inference: Inference) -> ReportTable:
    rows: list[tuple[str, ...]] = []
    note = ""
    if inference.realism is not None:
        for i, row in enumerate(records(inference.realism.table())):
            latent = interval(row["latent_low"], row["latent_high"]) if i else "reference"
            rows.append(
                (
                    str(row["distance"]),
                    str(row["lod"]),
                    str(row["people"]),
                    str(row["ratings"]),
                    number(row["latent"]),
                    latent,
                    number(row["rating"]),
                    interval(row["rating_low"], row["rating_high"]),
                )
            )
        note = _people(inference)
    return ReportTable(
        "Realism by the ordinal mixed model: latent scale, and the population's mean rating.",
        ("distance", "LoD", "people", "ratings", "latent", "95 % CI", "mean rating", "95 % CI"),
        tuple(rows),
        text_columns=2,
        note=note,
    )


def _people(inference: Inference) -> str:
    """Say how people differ, and what stands beside the LoDs in the model."""
    realism = inference.realism
    if realism is None:
        return ""
    fit = realism.fit
    spreads = ", ".join(f"{name} {number(fit.sd(name))}" for name in fit.model.effects)
    beside = [name for name in (*realism.stimuli.nuisances, "contrast") if name in fit.model.names]
    effects = ", ".join(
        f"{name} {number(fit.value(name))} (± {number(1.96 * fit.standard_error(name))})"
        for name in beside
    )
    text = (
        "Unit of the latent scale: the scatter of one person's ratings. Each eye is taken beside "
        f"its like. People's standard deviations: {spreads}."
    )
    return f"{text} Beside the LoDs: {effects}." if effects else text


def _preference(inference: Inference) -> ReportTable:
    rows: list[tuple[str, ...]] = []
    note = ""
    if inference.preference is not None:
        for row in records(inference.preference.table()):
            is_free = bool(np.isfinite(row["jod_low"]))
            rows.append(
                (
                    str(row["distance"]),
                    str(row["lod"]),
                    number(row["jod"]),
                    interval(row["jod_low"], row["jod_high"]) if is_free else "reference",
                    "–" if not is_free else str(row["reference"]),
                )
            )
        side, draws = inference.preference.side()
        low, high = np.quantile(draws, (0.025, 0.975))
        note = (
            "1 JOD is 75 % preference where nobody may say “no difference”. Scales of different "
            "distances cannot be compared: no comparison links them. Standing on the right adds "
            f"{number(side)} ({interval(float(low), float(high))})."
        )
    return ReportTable(
        "Preference in comparisons, in JOD.",
        ("distance", "LoD", "JOD", "95 % CI", "measured from"),
        tuple(rows),
        text_columns=2,
        note=note,
    )


def _noticing(inference: Inference) -> ReportTable:
    rows: list[tuple[str, ...]] = []
    note = ""
    if inference.noticing is not None:
        for row in records(inference.noticing.table()):
            rows.append(
                (
                    str(row["distance"]),
                    " – ".join((row["lesser"], row["greater"])),
                    number(row["d_prime"]),
                    interval(row["d_prime_low"], row["d_prime_high"]),
                    percent(row["yes"]),
                    " to ".join((percent(row["yes_low"]), percent(row["yes_high"]))),
                )
            )
        alarm, draws = inference.noticing.false_alarms()
        low, high = np.quantile(draws, (0.025, 0.975))
        note = (
            f"False alarms, yes to pairs of equal LoDs: {percent(alarm)} ({percent(low)} to "
            f"{percent(high)}; {inference.noticing.catch_answers} answers)."
        )
    return ReportTable(
        "How well differences are detected: d′ of yes, not sure and no against equal pairs.",
        ("distance", "LoDs", "d′", "95 % CI", "yes", "95 % CI"),
        tuple(rows),
        text_columns=2,
        note=note,
    )
