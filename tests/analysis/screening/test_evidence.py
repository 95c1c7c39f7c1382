"""Whether a person looked: chance has mean 0 and variance 1, looking stands far above it."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pandas as pd
import pytest

from analysis.screening.evidence import COMPARED, LEFT, NOTED, RIGHT, _fit, _Trials, evidence_of
from analysis.simulation.observers import Stimulus
from analysis.simulation.simulated import simulate_tables
from analysis.tables.reading import Tables, tables_from


def test_over_all_orders_the_evidence_has_mean_0_and_variance_1() -> None:
    rng = np.random.default_rng(4)
    x, y = rng.normal(size=(2, 6, 4))
    x, y = x - x.mean(axis=0), y - y.mean(axis=0)
    weight = np.array([1.0, 0.5, 2.0, 3.0])
    found = []
    for order in permutations(range(6)):
        trials = _Trials(("A",), np.zeros(6, dtype=np.intp), y[list(order)], x, weight)
        found.append(float(_fit(trials, (LEFT, RIGHT, COMPARED, NOTED))[0]))
    assert np.mean(found) == pytest.approx(0.0, abs=1e-9)
    assert np.var(found) == pytest.approx(1.0, rel=1e-9)


def rated(answers: dict[str, list[int]]) -> Tables:
    lods = ("low", "medium", "high", "ultra")
    rows = [
        (who, f"t{i}", "near", lods[i % 4], rating)
        for who, given in answers.items()
        for i, rating in enumerate(given)
    ]
    names = ["participant", "trial", "distance", "lod", "rating"]
    return tables_from({"ratings": pd.DataFrame(rows, columns=names)})


def test_who_follows_the_others_stands_above_and_who_turns_the_scale_below() -> None:
    up = [1, 2, 4, 5] * 3
    found = evidence_of(rated({"A": up, "B": up, "C": up, "D": [6 - r for r in up], "E": [3] * 12}))
    assert found.people == ("A", "B", "C", "D", "E")
    assert (found.looking[:3] > 2.5).all()
    assert found.looking[3] < -2.5
    assert np.isnan(found.looking[4])  # the same rating throughout goes with any order
    assert np.isnan(found.noticing).all()


def test_few_trials_and_cells_nobody_else_saw_tell_nothing() -> None:
    assert np.isnan(evidence_of(rated({"A": [1, 2, 3], "B": [1, 2, 3]})).looking).all()
    alone = rated({"A": [1, 2, 4, 5] * 3})
    assert np.isnan(evidence_of(alone).looking).all()


def test_what_is_noticed_makes_honest_people_stand_out(
    thesis_clips: dict[str, Stimulus],
) -> None:
    frames = simulate_tables(thesis_clips, np.random.default_rng(9), participants=20)
    found = evidence_of(tables_from(frames))
    assert np.median(found.looking) > np.median(found.valuing) + 0.3
    assert np.median(found.noticing) > 1.5
