"""All models of one study at once: what is fitted, what is decided, what stays silent."""

from __future__ import annotations

import numpy as np
import pytest

from analysis.decision.sentences import answer
from analysis.decision.verdicts import Margins
from analysis.inference import infer
from analysis.inference_tables import inference_tables
from analysis.observers import Stimulus
from analysis.population import POPULATION
from analysis.reading import Tables, tables_from
from analysis.simulated import simulate_tables


@pytest.fixture(scope="module")
def tables() -> Tables:
    shown = {}
    for distance in ("macroscopic", "far"):
        px = POPULATION.iris_px[distance]
        for left, right in (("low", "ultra"), ("ultra", "low"), ("low", "low"), ("ultra", "ultra")):
            shown[f"{distance} {left} {right}"] = Stimulus(distance, px, left, right)
    return tables_from(simulate_tables(shown, np.random.default_rng(8), participants=30))


def test_near_a_cheap_eye_is_different_and_far_it_is_enough(tables: Tables) -> None:
    found = infer(tables, margins=Margins(realism_points=0.6))
    assert [(own.distance, own.lod) for own in found.decisions] == [
        ("macroscopic", "ultra"),
        ("far", "low"),
    ]
    near, far = map(answer, found.decisions)
    assert near.startswith("only ultra was shown to be enough: low is not (rated ")
    assert "beyond false alarms)" in near
    assert far.startswith("low is enough: rated at most ")
    assert "points below ultra (margin 0.60) and noticed by at most" in far
    assert set(found.tables()) == {
        "decision",
        "realism-model",
        "preference-model",
        "noticing-model",
        "curves",
        "curve-points",
        "thresholds",
        "joint-scale",
    }


def test_the_tables_of_the_report_name_margins_and_models(tables: Tables) -> None:
    verdicts, realism, preference, noticing = inference_tables(infer(tables))
    assert verdicts.rows[0][:3] == ("macroscopic", "low", "different")
    assert "Margins: 0.50 points, 25\N{NO-BREAK SPACE}% of people" in verdicts.note
    assert realism.rows[0][5] == "reference"
    assert "contrast" in realism.note
    assert [row[3] == "reference" for row in preference.rows] == [False, True, False, True]
    assert noticing.rows[0][1] == "low – ultra"
    assert "False alarms" in noticing.note


def test_without_equal_pairs_nothing_is_called_enough(tables: Tables) -> None:
    ratings = tables.ratings[tables.ratings["lod"] != tables.ratings["other_lod"]]
    pairs = tables.comparisons[tables.comparisons["left_lod"] != tables.comparisons["right_lod"]]
    found = infer(Tables(ratings, pairs, tables.participants))
    assert found.noticing is None
    far = answer(found.decisions[1])
    assert far.startswith("only ultra was shown to be enough: for low it was not shown (")
    assert "whether it is noticed was not measured" in far


def test_one_person_says_nothing_about_others(tables: Tables) -> None:
    own = tables.ratings["participant"].iloc[0]
    found = infer(
        Tables(
            tables.ratings[tables.ratings["participant"] == own],
            tables.comparisons[tables.comparisons["participant"] == own],
            tables.participants,
        )
    )
    assert (found.realism, found.preference, found.noticing) == (None, None, None)
    assert inference_tables(found) == []
    assert found.tables() == {}


def test_the_same_tables_give_the_same_numbers(tables: Tables) -> None:
    first, second = infer(tables).tables(), infer(tables).tables()
    for name, table in first.items():
        assert table.equals(second[name])
