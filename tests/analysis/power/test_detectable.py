"""What a study could have shown agrees with simulated studies, its own formula and scipy's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.stats import norm, t

from analysis.decision.margins import DEFAULT
from analysis.decision.verdicts import EQUIVALENT
from analysis.descriptive.shares import wilson
from analysis.inference.deciding import fit_noticing, fit_realism
from analysis.power.assumed import named_truth
from analysis.power.detectable import COLUMNS, detectable, people_for, smallest_margin
from analysis.power.plan import Plan
from analysis.power.replicates import Scene, answers_of, simulate_studies
from analysis.power.tables import as_tables
from analysis.simulation.observers import Stimulus
from analysis.simulation.population import POPULATION
from analysis.tables.reading import Tables


def plan(people: int) -> Plan:
    shown = [
        (where, *pair)
        for where in ("near", "far")
        for pair in (("high", "ultra"), ("ultra", "high"), ("ultra", "ultra"), ("high", "high"))
    ]
    clips = {
        f"{where} {left} {right}": Stimulus(where, POPULATION.iris_px[where], left, right)
        for where, left, right in shown
    }
    rows = [(who, at, clip) for who in range(people) for at, clip in enumerate(clips, start=1)]
    return Plan(clips, pd.DataFrame(rows, columns=["participant", "position", "clip"]))


def studied(people: int, seed: int) -> Tables:
    own = plan(people)
    truth = named_truth("equal", own.stimuli, DEFAULT)
    return as_tables(own, answers_of(own, truth, np.random.default_rng(seed)))


def shown_by(tables: Tables) -> pd.DataFrame:
    best = {"near": "ultra", "far": "ultra"}
    return detectable(fit_realism(tables, None), fit_noticing(tables, None), best, margins=DEFAULT)


def test_each_lod_has_its_margins() -> None:
    found = shown_by(studied(24, 1))
    assert tuple(found.columns) == COLUMNS
    assert found[["distance", "lod", "best"]].to_numpy().tolist() == [
        ["near", "high", "ultra"],
        ["far", "high", "ultra"],
    ]
    assert found["people"].tolist() == [24, 24]
    assert found["smallest_realism_margin"].between(0.1, 1.0).all()
    assert found["smallest_noticed_margin"].between(0.05, 0.6).all()
    factor = t.ppf(0.95, 23) + norm.ppf(0.8)
    assert found["smallest_realism_margin"].to_numpy() == pytest.approx(
        factor * found["realism_error"].to_numpy()
    )


def test_four_of_five_studies_fall_within_the_margin(rng: np.random.Generator) -> None:
    """By a t test of n differences: the closed form of what the models do."""
    people, error = 24, 1 / np.sqrt(24)
    margin = smallest_margin(error, people, confidence=0.95)
    away = rng.standard_normal((4000, people))
    own = away.std(axis=1, ddof=1) / np.sqrt(people)
    passed = away.mean(axis=1) + t.ppf(0.95, people - 1) * own < margin
    assert passed.mean() == pytest.approx(0.8, abs=0.025)


def test_people_needed_reach_the_margin_and_one_less_does_not() -> None:
    error = 0.3
    needed = people_for(0.25, error, 10, confidence=0.95)
    assert needed is not None
    for people, reaches in ((needed, True), (needed - 1, False)):
        there = error * np.sqrt(10 / people)
        assert (smallest_margin(there, people, confidence=0.95) <= 0.25) is reaches
    assert people_for(1e-4, error, 10, confidence=0.95) is None
    assert people_for(0.25, np.nan, 10, confidence=0.95) is None
    assert people_for(0.25, 0.0, 10, confidence=0.95) is None


def test_without_ratings_or_noticing_there_is_nothing_to_say() -> None:
    assert detectable(None, None, {}, margins=DEFAULT).empty
    tables = studied(10, 2)
    found = detectable(fit_realism(tables, None), None, {"near": "ultra"}, margins=DEFAULT)
    assert found["lod"].tolist() == ["high"]
    assert found["smallest_noticed_margin"].isna().all()
    assert found["people_for_noticed"].isna().all()


@pytest.mark.long
def test_it_agrees_with_simulated_power() -> None:
    """Studies of equal LoDs, decided by the margin that such studies say they reach."""
    people = 24
    tables = pd.concat([shown_by(studied(people, seed)) for seed in range(100, 120)])
    margins = tables.groupby("distance")[["smallest_realism_margin"]].mean()
    own = plan(people)
    for distance, margin in margins["smallest_realism_margin"].items():
        # Noticing at a margin that no study misses: realism alone decides.
        rule = replace(DEFAULT, realism_points=float(margin), noticed_share=0.95)
        truth = named_truth("equal", own.stimuli, rule)
        studies = simulate_studies(Scene((own,), truth, (people,), rule), replicates=250, seed=7)
        named = sum((people, distance, "high", EQUIVALENT) in study.verdicts for study in studies)
        low, high = wilson(named, len(studies))
        assert low - 0.03 <= 0.8 <= high + 0.03, (distance, named)  # errors differ by study
