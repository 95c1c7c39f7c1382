"""Whether a person looked: odds that follow others, turned scales, and too little to tell."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from analysis.screening.evidence import LEAST, evidence_of, weights_of
from analysis.simulation.observers import Stimulus
from analysis.simulation.simulated import simulate_tables
from analysis.tables.reading import Tables, tables_from

UP = [1, 2, 4, 5] * 3


def rated(answers: dict[str, list[int]]) -> Tables:
    lods = ("low", "medium", "high", "ultra")
    rows = [
        (who, f"t{i}", "near", lods[i % 4], rating)
        for who, given in answers.items()
        for i, rating in enumerate(given)
    ]
    names = ["participant", "trial", "distance", "lod", "rating"]
    return tables_from({"ratings": pd.DataFrame(rows, columns=names)})


def test_who_follows_the_others_looked_and_who_turns_the_scale_did_not_hold_it_upright() -> None:
    turned, dealt = [6 - rating for rating in UP], UP[1:] + UP[:1]
    people = dict.fromkeys("ABCD", UP) | {"E": turned, "F": dealt, "G": [3] * 12}
    found = evidence_of(rated(people))
    assert found.people == tuple("ABCDEFG")
    assert (found.looking[:4] > 3).all()
    assert (found.upright[:4] > 10).all()
    assert found.upright[4] < found.looking[4] < -3
    assert found.looking[5] < -1.7
    assert abs(found.upright[6]) < 0.5  # the middle turned round is the middle


def test_answers_that_follow_a_pair_to_the_other_side_are_more_evidence() -> None:
    rows = [
        (f"P{i}", f"t{k}", "near", *pair, answer)
        for i in range(6)
        for k, (*pair, answer) in enumerate([("low", "ultra", 1), ("high", "ultra", 0)] * 4)
    ]
    names = ["participant", "trial", "distance", "left_lod", "right_lod", "comparison"]
    table = pd.DataFrame(rows, columns=names).assign(noticed="yes")
    is_turned = (table["trial"].isin(["t0", "t1", "t5"])) & (table["participant"] == "P3")
    swapped = table.copy()
    swapped.loc[is_turned, ["left_lod", "right_lod"]] = table[["right_lod", "left_lod"]].to_numpy()[
        is_turned
    ]
    swapped.loc[is_turned, "comparison"] *= -1
    found = [evidence_of(tables_from({"comparisons": own})).looking for own in (table, swapped)]
    assert found[1][3] > found[0][3] + 1
    others = np.arange(6) != 3
    assert found[1][others] == pytest.approx(found[0][others], rel=1e-3)


def test_few_trials_and_few_people_tell_nothing() -> None:
    few = {name: [1, 2, 3] for name in "ABCDEF"}
    assert np.isnan(evidence_of(rated(few)).looking).all()
    assert np.isnan(evidence_of(rated(dict.fromkeys("ABCD", UP))).looking).all()


def test_honest_answers_are_seldom_likelier_from_somebody_who_did_not_look(
    thesis_clips: dict[str, Stimulus],
) -> None:
    found = []
    for seed in range(4):
        frames = simulate_tables(thesis_clips, np.random.default_rng([9, seed]), participants=20)
        found.append(evidence_of(tables_from(frames)).looking)
    odds = np.concatenate(found)
    for k in (5, 20):  # of the true model Markov's inequality says 1 in k
        assert (odds < -np.log(k)).mean() < 1 / k, k
    assert np.median(odds) > 2.5


def test_weights_fall_evenly_with_the_odds_to_a_tenth() -> None:
    given = np.log([8.0, 1.0, 0.5, 0.2, 0.01])
    assert weights_of(np.append(given, np.nan)) == pytest.approx([1, 1, 0.5, 0.2, LEAST, 1])
