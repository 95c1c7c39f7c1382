"""All models of one study at once: what is fitted, what is decided, what stays silent."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from analysis.costs.cost import COLUMNS, Costs
from analysis.decision.sentences import answer
from analysis.decision.verdicts import NOT_SHOWN, Margins
from analysis.inference.deciding import decisions_of
from analysis.inference.inferring import infer
from analysis.report.inference_tables import inference_tables
from analysis.simulation.observers import Stimulus
from analysis.simulation.population import POPULATION
from analysis.simulation.simulated import simulate_tables
from analysis.tables.reading import Tables, tables_from
from renderer.lod.policy import parse_policy


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
        "person-effects",
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
    assert "whether it is noticed beyond false alarms was not measured" in far


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


def changed(tables: Tables, *, people: int = 30, **cells: object) -> Tables:
    """Return the tables with other cells, of the first people."""
    few = tables.ratings["participant"].unique()[:people]
    ratings, comparisons = (
        table[table["participant"].isin(few)] for table in (tables.ratings, tables.comparisons)
    )
    compared = {name: cells[name] for name in ("noticed", "comparison") if name in cells}
    rated = {"rating": cells["rating"]} if "rating" in cells else {}
    return Tables(ratings.assign(**rated), comparisons.assign(**compared), tables.participants)


def test_odd_data_give_an_answer_or_a_clear_statement(tables: Tables) -> None:
    """All alike, all missing, perfect separation, two people: a verdict or a reason, no fault."""
    alike = infer(changed(tables, people=6, rating=3.0, noticed="no", comparison=0))
    assert all(own.verdicts[0].outcome == NOT_SHOWN for own in alike.decisions)
    missing = infer(changed(tables, rating=np.nan, noticed=None, comparison=np.nan))
    assert (missing.realism, missing.joint, missing.policy, missing.decisions) == (None,) * 3 + (
        (),
    )
    assert missing.curves.notes[0].startswith("No curve over pixels for low: it takes answers at")
    is_best = tables.ratings["lod"] == "ultra"
    apart = infer(changed(tables, people=8, rating=np.where(is_best, 5.0, 1.0)[: 8 * 16]))
    assert apart.warnings()[0] == (
        "The model of realism: all ratings of low at macroscopic and low at far are the lowest: "
        "how far beyond the scale's end that lies is not known, and priors keep it finite."
    )
    two = infer(changed(tables, people=2))
    assert [own.verdicts[0].outcome for own in two.decisions] == [NOT_SHOWN] * 2
    for found in (alike, missing, apart, two):
        for table in found.tables().values():
            assert len(table)


def test_only_the_decisions_are_those_of_the_whole(tables: Tables) -> None:
    assert decisions_of(tables) == infer(tables).decisions


def test_a_policy_and_a_front_follow_from_the_same_fits(tables: Tables) -> None:
    rows = [
        ("gl", "1920x1080", 2, distance, POPULATION.iris_px[distance], lod, ms, 1.0, 9)
        for distance in ("macroscopic", "far")
        for lod, ms in (("low", 100.0), ("ultra", 200.0))
    ]
    costs = Costs(pd.DataFrame(rows, columns=list(COLUMNS)), "2 eyes, 1920x1080 pixels, gl", 2.0)
    found = infer(tables, margins=Margins(realism_points=0.6), costs=costs)
    assert found.policy is not None
    low, ultra = found.policy.steps
    assert (low.lod, ultra.lod, ultra.up_to_px) == ("low", "ultra", None)
    assert 12.0 <= (low.up_to_px or 0.0) < 350.0
    assert parse_policy(found.policy.text(), source="p").policy.limits_px == (low.up_to_px,)
    assert found.policy.provenance["people"] == 30
    assert len(found.pareto) == 4
    table = found.tables()["decision"]
    assert table["ms_saved"].tolist() == pytest.approx([50.0, 50.0])
    assert (table["p_equivalent_holm"] >= table["p_equivalent"]).all()
    assert "it saves 50.0" in answer(found.decisions[1], costs)
    assert found.linkage is not None
    assert found.linkage.is_one
