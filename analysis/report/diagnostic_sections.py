"""The report's sections on the model itself, on groups of people, on what the study could show."""

from __future__ import annotations

import pandas as pd

from analysis.decision.margins import Margins
from analysis.diagnostics.checks import end_counts, fit_checks, misfits
from analysis.diagnostics.odds import SCALE, odds_of
from analysis.diagnostics.predicted import predicted_ends, predicted_shares
from analysis.diagnostics.residuals import quantile_residuals
from analysis.diagnostics.rivals import METRIC, rivals
from analysis.estimates.groups import NOT_ASKED, QUESTIONS, group_effects
from analysis.estimates.realism import Realism
from analysis.inference.deciding import rng_of
from analysis.inference.inferring import Inference
from analysis.power.detectable import detectable
from analysis.report.diagnostic_tables import (
    checks_table,
    detectable_table,
    groups_table,
    odds_table,
    p_text,
    rivals_table,
)
from analysis.report.sections import Section
from analysis.tables.reading import Tables
from analysis.words.wording import listed, number

FIT, RIVALS = "Does the model fit?", "Model comparison"
GROUPS, COULD_SHOW = "Groups of people", "What this study could have shown"
_NO_MODEL = "No model of ratings was fitted: that takes ratings by two people."
_SIGNIFICANT = 0.05


def fit_section(realism: Realism | None) -> Section:
    """Return residuals, predicted shares of the ends and the check of proportional odds."""
    if realism is None:
        return Section(FIT, (_NO_MODEL,))
    residuals = quantile_residuals(realism, rng_of("residuals"))
    ends = predicted_ends(realism, rng_of("predicted"))
    checks = fit_checks(residuals, ends, rng_of("checks"))
    odds = odds_of(realism)
    given, mean, low, high = end_counts(ends)
    top = realism.stimuli.scale[1]
    sentences = (
        _fits("Residuals", len(residuals), misfits(checks, "residuals")),
        f"The rating {top} was given {given} times; the model expects {number(mean, digits=1)} "
        f"(95 % of drawn studies: {low:.0f} to {high:.0f}). "
        + _ends(misfits(checks, "predicted shares")),
        _odds(odds),
    )
    data = {
        "residuals": residuals,
        "predicted-shares": predicted_shares(realism, rng_of("predicted"), ends=ends),
        "fit-checks": checks,
        "odds-tests": odds,
    }
    return Section(FIT, sentences, (checks_table(checks), odds_table(odds)), data)


def rivals_section(realism: Realism | None) -> Section:
    """Return the models of ratings side by side."""
    if realism is None:
        return Section(RIVALS, (_NO_MODEL,))
    found = rivals(realism)
    return Section(RIVALS, (_best(found),), (rivals_table(found),), {"model-comparison": found})


def groups_section(tables: Tables, observers: pd.DataFrame | None) -> Section:
    """Return what groups differ in; ``observers`` are people's signals with their weights."""
    if observers is None or observers.empty:
        return Section(GROUPS, ("Nobody answered anything that counts.",))
    weights = dict(zip(observers["participant"].astype(str), observers["weight"], strict=True))
    found = group_effects(observers, tables.participants, weights)
    silent = [QUESTIONS[name] for name in found.loc[found["note"] == NOT_ASKED, "question"]]
    told = [f"Not asked: {listed(silent)}."] if silent else []
    clear = int((found["p_holm"] < _SIGNIFICANT).sum())
    tested = int(found["p_holm"].notna().sum())
    if tested:
        told.append(
            f"Of {tested} differences between groups {clear or 'none'} "
            f"{'is' if clear < 2 else 'are'} shown after adjustment; what was not shown is open."
        )
    asked = found[found["note"] != NOT_ASKED]
    made = (groups_table(asked),) if len(asked) else ()
    return Section(GROUPS, tuple(told), made, {"group-effects": found})


def detectable_section(inference: Inference) -> Section:
    """Return the smallest margins that this design and number of people could have shown."""
    found = detectable(
        inference.realism, inference.noticing, inference.best, margins=inference.margins
    )
    if found.empty:
        return Section(COULD_SHOW, ("No LoD was rated by two people beside a best one.",))
    made = (detectable_table(found, inference.margins),)
    return Section(COULD_SHOW, _could(found, inference.margins), made, {"detectable": found})


def _fits(what: str, count: int, failed: list[str]) -> str:
    if not failed:
        return f"{what}: the model fits; {count} ratings scatter about it as it says they should."
    return f"{what}: the model does not fit: {listed(failed)}."


def _ends(failed: list[str]) -> str:
    if not failed:
        return "The ends of the scale are used as it expects, by every person and for every LoD."
    return f"It does not fit in how the ends of the scale are used: {listed(failed)}."


def _odds(odds: pd.DataFrame) -> str:
    if odds["p"].isna().all():
        return f"Proportional odds could not be tested: {odds['note'].iloc[0]}."
    clear = odds[odds["p"] < _SIGNIFICANT]
    if clear.empty:
        return "Proportional odds: nothing speaks against one shift of the whole scale."
    named = [
        f"{'scatter' if test == SCALE else 'the thresholds'} by {factor} (p {p_text(p)})"
        for factor, test, p in zip(clear["factor"], clear["test"], clear["p"], strict=True)
    ]
    return (
        f"Proportional odds do not hold exactly: ratings differ in {listed(named)}; a loss of "
        "realism is then a mean over the scale. The more ratings there are, the smaller the "
        "departures that show."
    )


def _best(found: pd.DataFrame) -> str:
    known = found.dropna(subset=["left_out"])
    if known.empty:
        return "Too few people to leave any of them out: models are compared by AIC alone."
    clear = known[(known["left_out_difference"] > 2 * known["left_out_error"])]
    better = [row for row in clear.to_dict("records") if row["left_out_error"] > 0]
    if better:
        best = max(better, key=lambda row: float(row["left_out_difference"]))
        away, error = (
            number(float(best[name]), digits=1)
            for name in ("left_out_difference", "left_out_error")
        )
        text = (
            f"The model “{best['model']}” foretells a new person's ratings better than the "
            f"report's (log probability {away} ± {error} higher)."
        )
    else:
        text = "No other model foretells a new person's ratings clearly better than the report's."
    metric = known[known["model"] == METRIC]
    is_worse = bool((metric["left_out_difference"] < -2 * metric["left_out_error"]).any())
    verdict = "clearly worse" if is_worse else "not clearly worse"
    return f"{text} Taken as a metric scale, ratings are foretold {verdict}."


def _could(found: pd.DataFrame, margins: Margins) -> tuple[str, ...]:
    """Say per distance which margin of realism its LoDs could have been shown to be within."""
    told = []
    for distance, own in found.groupby("distance", sort=False):
        low, high = (float(own["smallest_realism_margin"].agg(end)) for end in ("min", "max"))
        reach = number(high) if high - low < 0.005 else f"{number(low)} to {number(high)}"
        if high <= margins.realism_points:
            end = "so a LoD that is as real as the best could be shown to be so"
        elif low <= margins.realism_points:
            end = "so for some LoDs a “not shown” says little"
        else:
            end = "so a “not shown” says little: more people are needed"
        told.append(
            f"{distance}: the smallest margin of realism within reach was {reach} points, "
            f"{number(margins.realism_points)} were asked for, {end}."
        )
    return tuple(told)
