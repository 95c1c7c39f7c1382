"""The report's tables on the model itself, on groups of people, on what the study could show."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import pandas as pd

from analysis.decision.margins import Margins
from analysis.diagnostics.odds import SCALE
from analysis.diagnostics.rivals import METRIC
from analysis.estimates.groups import FEWEST, OUTCOMES, QUESTIONS
from analysis.power.needed import POWER
from analysis.report.tables import ReportTable
from analysis.tables.records import records
from analysis.words.wording import interval, number, percent

_NONE: Final = "–"


def p_text(p: float) -> str:
    """Write a p value; below a thousandth only that."""
    if pd.isna(p):
        return _NONE
    return "< 0.001" if p < 0.001 else number(p, digits=3)


def rivals_table(found: pd.DataFrame) -> ReportTable:
    """Return the models of ratings side by side; the report's own is marked."""
    rows = tuple(_rival(row) for row in records(found))
    how = ", ".join(dict.fromkeys(word for word in found["left_out_by"] if word))
    note = (
        "* Verdicts rest on this one. Log-likelihood and AIC: maximum likelihood without priors; "
        "less AIC is better. Person left out: log probability of each person's ratings by a fit to "
        f"the others, with priors{f' ({how})' if how else ''}; more is better, ± one standard "
        "error over people. The metric scale (Gaussian, random intercept, as lmer or MixedLM) has "
        "a density, which no probability can be compared with; a rating counts here as all that "
        "rounds to it. The logit link goes by AIC alone: priors are made for the probit's unit."
    )
    head = ("people differ in", "parameters", "log-likelihood", "AIC", "above the least")
    return ReportTable(
        "Models of the ratings compared.",
        (*head, "person left out", "against the report's"),
        rows,
        note=note,
    )


def checks_table(found: pd.DataFrame) -> ReportTable:
    """Return each check of the fit with its p value."""
    rows = tuple(
        (
            str(row["check"]),
            str(row["of"]),
            p_text(row["p"]),
            p_text(row["p_holm"]),
            "fits" if row["fits"] else "does not fit",
        )
        for row in records(found)
    )
    note = (
        "Residuals: randomised quantile residuals, standard normal where the model is right (Dunn "
        "and Smyth 1996). Predicted shares: how often the ends of the scale were given, against "
        "studies drawn from the fitted model. The same ratings fitted the model, so a right "
        "one fails more seldom than in 5 %. Each rating's residual stands in residuals.csv, each "
        "person's and each LoD's share in predicted-shares.csv."
    )
    head = ("check", "of", "p", "p, adjusted (Holm)", "verdict")
    return ReportTable("Does the model of ratings fit?", head, rows, text_columns=2, note=note)


def odds_table(found: pd.DataFrame) -> ReportTable:
    """Return the tests of proportional odds."""
    rows = tuple(
        (
            str(row["factor"]),
            "scatter differs" if row["test"] == SCALE else "thresholds differ",
            number(row["statistic"]),
            str(row["dof"]) if row["dof"] else _NONE,
            p_text(row["p"]),
            str(row["note"]),
        )
        for row in records(found)
    )
    note = (
        "Likelihood-ratio tests as R's scale_test and nominal_test: may the scatter of ratings, or "
        "the distances between the scale's thresholds, differ by LoD, by distance? People differ "
        "in leniency in all these fits; those who also differ in scatter or in how they use the "
        "scale's ends can make thresholds differ. p allows for the parameters fitted."
    )
    return ReportTable(
        "Proportional odds: is it one shift that a LoD or a distance makes?",
        ("factor", "test", "χ²", "dof", "p", "note"),
        rows,
        text_columns=2,
        note=note,
    )


def groups_table(found: pd.DataFrame) -> ReportTable:
    """Return what groups of people differ in."""
    rows = tuple(_group(row) for row in records(found))
    note = (
        "Each group against all others who answered the question, by one number per person "
        "(Welch's t): mean rating by the P.910 bias, scatter as a ratio of inconsistencies, the "
        "slope of ratings on others' means. p adjusted after Holm over the table. Could show: the "
        f"true difference that groups of this size show in {percent(POWER)} of studies. Groups of "
        f"fewer than {FEWEST} people are not estimated; people who weigh less than half are left "
        "out. Exploratory: nobody was drawn by group."
    )
    return ReportTable(
        "Do groups of people use the scale otherwise?",
        ("question", "group", "in", "estimate", "95 % CI", "p (Holm)", "could show", "n", "others"),
        rows,
        text_columns=3,
        note=note,
    )


def detectable_table(found: pd.DataFrame, margins: Margins) -> ReportTable:
    """Return the smallest margins that the study could have shown."""
    rows = tuple(_detectable(row) for row in records(found))
    note = (
        f"For a LoD that truly is as good as the best: within this margin {percent(POWER)} of such "
        f"studies show it, each test at {percent(margins.confidence)}; from this study's own "
        "standard errors. People for a margin: how many like these the declared margin takes "
        "(errors fall with the root of their number). Verdicts ask for both tests, and for all "
        "LoDs above in the sequence, so they take more; ocularist power simulates that."
    )
    return ReportTable(
        "What a study of this design and size could have shown.",
        (
            *("distance", "LoD", "standard error, points", "could show, points"),
            *(f"people for {number(margins.realism_points)}", "standard error, noticed"),
            *("could show, noticed", f"people for {percent(margins.noticed_share)}"),
        ),
        rows,
        text_columns=2,
        note=note,
    )


def _rival(row: Mapping[str, Any]) -> tuple[str, ...]:
    name = str(row["model"]) + (" *" if row["is_reported"] else "")
    name = {"people alike": "nothing"}.get(name, name)
    if row["note"]:
        return (name, str(row["note"]), *[_NONE] * 5)
    left = _NONE if pd.isna(row["left_out"]) else number(row["left_out"], digits=1)
    away, error = row["left_out_difference"], row["left_out_error"]
    against = _NONE if pd.isna(away) or row["is_reported"] else f"{number(away, digits=1)} ± "
    return (
        f"leniency, on a {METRIC}" if row["model"] == METRIC else name,
        str(row["parameters"]),
        number(row["log_likelihood"], digits=1),
        number(row["aic"], digits=1),
        number(row["aic_difference"], digits=1),
        left,
        against if against == _NONE else against + number(error, digits=1),
    )


def _group(row: Mapping[str, Any]) -> tuple[str, ...]:
    question = QUESTIONS[str(row["question"])]
    counts = tuple(_NONE if pd.isna(row[name]) else str(row[name]) for name in ("people", "others"))
    if row["note"]:
        outcome = OUTCOMES.get(str(row["outcome"]), "")
        text = f"{outcome}: {row['note']}" if outcome else str(row["note"])
        return (question, str(row["group"]) or _NONE, text, *[_NONE] * 4, *counts)
    return (
        question,
        str(row["group"]),
        OUTCOMES[str(row["outcome"])],
        number(row["estimate"]),
        interval(row["low"], row["high"]),
        p_text(row["p_holm"]),
        number(row["detectable"]),
        *counts,
    )


def _detectable(row: Mapping[str, Any]) -> tuple[str, ...]:
    def needed(value: Any) -> str:
        return "more than 100 000" if pd.isna(value) else str(value)

    is_seen = pd.notna(row["noticed_error"])
    return (
        str(row["distance"]),
        str(row["lod"]),
        number(row["realism_error"]),
        number(row["smallest_realism_margin"]),
        needed(row["people_for_realism"]),
        percent(row["noticed_error"]) if is_seen else _NONE,
        percent(row["smallest_noticed_margin"]) if is_seen else _NONE,
        needed(row["people_for_noticed"]) if is_seen else _NONE,
    )
