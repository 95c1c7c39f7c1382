"""From a plan to power: verdicts of the report's own models, counted, written and worded."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analysis.decision.margins import DEFAULT, Margins
from analysis.decision.verdicts import decide
from analysis.estimates.noticing import noticing_of
from analysis.estimates.realism import realism_of
from analysis.power.assumed import named_truth
from analysis.power.outcome import Outcome, outcome_of
from analysis.power.plan import Plan
from analysis.power.quick import prepare
from analysis.power.replicates import Scene, answers_of, simulate_studies
from analysis.power.sentences import answer_lines, opening_lines
from analysis.power.tables import as_tables
from analysis.power.text_table import table_lines
from analysis.power.writing import write_power
from analysis.simulation.observers import Stimulus
from analysis.simulation.population import POPULATION

CATCH = [("macroscopic", "low", "low"), ("far", "ultra", "ultra")]
PAIRS = [
    *(("macroscopic", "low", "ultra"), ("macroscopic", "ultra", "low")),
    *(("far", "low", "ultra"), ("far", "ultra", "low"), ("far", "medium", "low")),
]
LODS = ("low", "medium", "ultra")


def plan(people: int, shown: list[tuple[str, str, str]] | None = None) -> Plan:
    clips = {
        f"{distance} {left} {right}": Stimulus(distance, POPULATION.iris_px[distance], left, right)
        for distance, left, right in shown or PAIRS + CATCH
    }
    rows = [(who, at, clip) for who in range(people) for at, clip in enumerate(clips, start=1)]
    return Plan(clips, pd.DataFrame(rows, columns=["participant", "position", "clip"]))


def scene(people: tuple[int, ...], own: Plan | None = None, truth: str = "thesis") -> Scene:
    own = own or plan(max(people))
    return Scene((own,), named_truth(truth, own.stimuli, DEFAULT), people)


@pytest.fixture(scope="module")
def outcome() -> Outcome:
    own = scene((24, 48))
    studies = simulate_studies(own, replicates=4, seed=3)
    return outcome_of(own, studies, distances=("macroscopic", "near", "far"), lods=LODS)


@pytest.fixture(scope="module")
def ranked() -> Outcome:
    own = scene((12, 48), plan(48, [*PAIRS[:4], *CATCH]))
    studies = simulate_studies(own, replicates=20, seed=4)
    return outcome_of(own, studies, distances=("macroscopic", "far"), lods=("low", "ultra"))


def test_the_quick_way_gives_the_verdicts_of_the_reports_models() -> None:
    own = plan(20)
    truth = named_truth("thesis", own.stimuli, DEFAULT)
    first, rng = np.random.default_rng(1), np.random.default_rng(2)
    prepared = prepare(own, answers_of(own, truth, first), first)
    answers = answers_of(own, truth, rng)
    tables = as_tables(own, answers)
    realism = realism_of(tables.ratings, np.random.default_rng(5), scale=(1, 5))
    noticing = noticing_of(tables.comparisons, tables.ratings, np.random.default_rng(6))
    seen = np.ones(len(own.person), dtype=bool)
    quick = prepared.realism_of(answers, seen, np.random.default_rng(5))
    assert quick.fit.log_likelihood == pytest.approx(realism.fit.log_likelihood, abs=0.01)
    np.testing.assert_allclose(quick.expected()[0], realism.expected()[0], atol=0.005)
    spotted = prepared.noticing_of(answers, seen, np.random.default_rng(6))
    assert spotted is not None
    assert noticing is not None
    np.testing.assert_allclose(spotted.shares()[0], noticing.shares()[0], atol=0.005)
    usual = decide(realism, noticing, prepared.ranks, margins=DEFAULT)
    found = prepared.decide(answers, rng, margins=DEFAULT).decisions
    assert [[v.outcome for v in d.verdicts] for d in found] == [
        [v.outcome for v in d.verdicts] for d in usual
    ]


def test_power_grows_with_people_and_its_error_is_stated(ranked: Outcome) -> None:
    far = ranked.verdicts[ranked.verdicts["distance"] == "far"]
    few, many = (dict(row) for _, row in far.iterrows())
    assert [few["right_verdict"], few["participants"], many["participants"]] == [
        *("equivalent", 12, 48),
    ]
    assert few["true_loss"] == pytest.approx(0.25, abs=1e-6)
    assert few["equivalent"] < many["equivalent"]
    assert few["equivalent_low"] <= few["equivalent"] <= few["equivalent_high"]
    total = few["equivalent"] + few["different"] + few["not_shown"]
    assert total == pytest.approx(1.0)
    near = ranked.verdicts[ranked.verdicts["distance"] == "macroscopic"]
    assert near["different"].min() == 1.0


def test_what_the_design_cannot_conclude_is_empty_and_not_zero(outcome: Outcome) -> None:
    rows = outcome.verdicts[outcome.verdicts["participants"] == 48].set_index(["distance", "lod"])
    nobody = rows.loc[("near", "low")]
    assert nobody[["equivalent", "different", "not_shown"]].isna().all()
    assert nobody["cannot_conclude"] == "nobody sees anything at near"
    unpaired = rows.loc[("far", "medium")]
    assert unpaired["cannot_conclude"] == "medium never stands beside ultra at far"
    assert np.isnan(unpaired["equivalent"])
    assert not np.isnan(unpaired["different"])
    behind = rows.loc[("far", "low")]
    assert behind["cannot_conclude"] == "medium, which is tested before it, cannot be shown"
    assert np.isnan(behind["equivalent"])
    named = outcome.cheapest[outcome.cheapest["distance"] == "far"]
    assert named["right"].isna().all()  # medium stands in the sequence before low


def test_the_right_lod_is_named_more_often_and_a_cheaper_one_hardly_ever(ranked: Outcome) -> None:
    found = ranked
    far = found.cheapest[found.cheapest["distance"] == "far"]
    assert far["right_lod"].tolist() == ["low", "low"]
    assert far["right"].iloc[0] < far["right"].iloc[1]
    near = found.cheapest[found.cheapest["distance"] == "macroscopic"]
    assert near["right_lod"].tolist() == ["ultra", "ultra"]
    assert near["too_cheap"].max() == 0.0
    lines = answer_lines(found)
    assert lines[0].startswith("macroscopic: nothing below ultra is enough here; with 48 people, 0")
    assert lines[1].startswith("far: with 48 people, ")
    assert " of studies name low, the cheapest LoD that is enough here; " in lines[1]


def test_without_equal_pairs_no_equivalence_can_be_concluded() -> None:
    own = scene((12,), plan(12, PAIRS[:4]))
    studies = simulate_studies(own, replicates=3, seed=1)
    found = outcome_of(own, studies, distances=("far",), lods=("low", "ultra"))
    assert found.verdicts["equivalent"].isna().all()
    assert "false alarms are unknown" in answer_lines(found)[0]


def test_lods_without_a_rank_are_decided_one_by_one() -> None:
    levels = {"texture": "ultra", "refraction": "off"}
    clips = {}
    for left, right in (("ultra", "bare"), ("bare", "ultra"), ("ultra", "ultra")):
        own_levels = [levels if lod == "bare" else {} for lod in (left, right)]
        clips[f"{left} {right}"] = Stimulus("far", 12.0, left, right, *own_levels)
    rows = [(who, at, clip) for who in range(40) for at, clip in enumerate(clips, start=1)]
    own = Plan(clips, pd.DataFrame(rows, columns=["participant", "position", "clip"]))
    truth = named_truth("equal", own.stimuli, DEFAULT)
    place = Scene((own,), truth, (40,), Margins(realism_points=1.0))
    found = outcome_of(
        place, simulate_studies(place, replicates=5, seed=1), distances=("far",), lods=("bare",)
    )
    assert found.verdicts["equivalent"].iloc[0] > 0.5
    (line,) = answer_lines(found)
    assert line.startswith("far: the right verdict in 80")
    assert line.endswith(" for bare.")
    assert "named by" not in "\n".join(table_lines(found))


def test_what_is_simulated_and_what_the_words_mean_stand_first(outcome: Outcome) -> None:
    lines = opening_lines(scene((24, 48)), outcome, "mine")
    assert lines[0].startswith("mine: 4 simulated studies of each number of people")
    assert 'who see what "thesis" assumes' in lines[0]
    assert "at most 0.5 points below the best LoD" in lines[1]
    assert "at most 25\N{NO-BREAK SPACE}% of people beyond false alarms" in lines[1]
    assert len(lines) == 3  # LoDs with a rank are not alike


def test_what_nobody_sees_is_told_once_and_fills_no_rows(outcome: Outcome) -> None:
    text = "\n".join(table_lines(outcome))
    assert "near" not in text
    told = [line for line in answer_lines(outcome) if "which nobody sees" in line]
    assert told == [
        "Nothing can be concluded of medium at macroscopic, low at near, medium at near and ultra "
        "at near, which nobody sees."
    ]


def test_lods_that_take_too_many_people_are_told_together() -> None:
    own = scene((4, 8), plan(8, [*PAIRS[:4], *CATCH]), truth="realism-margin")
    rows = [
        {"distance": "far", "lod": lod, "participants": n, "right_verdict": "equivalent"}
        | {"equivalent": 0.1, "equivalent_low": 0.0, "equivalent_high": 0.3}
        | {"true_loss": 0.1, "true_noticed": 0.0, "different": 0.0, "cannot_conclude": ""}
        for lod in ("a", "b", "c")
        for n in (4, 8)
    ]
    nothing = pd.DataFrame([{"distance": "far", "best": "", "cannot_conclude": ""}])
    found = Outcome(pd.DataFrame(rows), nothing, 10, frozenset())
    assert answer_lines(found) == [
        "far: the right verdict in 80\N{NO-BREAK SPACE}% of studies takes more than 8 people for "
        "each of the 3 LoDs."
    ]
    assert opening_lines(own, found, "mine")[-1].startswith("All 3 LoDs without a rank are assumed")


def test_processes_share_the_work_and_change_nothing() -> None:
    own = scene((8, 16))
    alone = simulate_studies(own, replicates=5, seed=9)
    told: list[int] = []
    with ThreadPoolExecutor(2) as executor:
        shared = simulate_studies(
            own, replicates=5, seed=9, executor=executor, share=2, progress=told.append
        )
    assert shared == alone
    assert sum(told) == 5


def test_people_who_leave_cost_power() -> None:
    whole = scene((30,))
    thinner = replace(whole, dropout=0.9)
    rates = []
    for own in (whole, thinner):
        studies = simulate_studies(own, replicates=6, seed=2)
        found = outcome_of(own, studies, distances=("macroscopic",), lods=("low",))
        rates.append(float(found.verdicts["different"].iloc[0]))
    assert rates[0] == 1.0
    assert rates[1] <= rates[0]
    with pytest.raises(ValueError, match="dropout: found 1; accepted: from 0 to below 1"):
        replace(whole, dropout=1.0)


def test_tables_settings_and_chart_are_written(outcome: Outcome, tmp_path: Path) -> None:
    files = write_power(outcome, tmp_path, title="Power", settings={"seed": 3})
    assert [path.name for path in files] == [
        *("power.csv", "power-cheapest.csv", "power.json", "power.svg", "power.png"),
    ]
    table = pd.read_csv(tmp_path / "power.csv")
    assert list(table.columns) == [
        *("distance", "lod", "best", "true_loss", "true_noticed", "right_verdict"),
        *("participants", "replicates"),
        *(
            f"{name}{end}"
            for name in ("equivalent", "different", "not_shown")
            for end in ("", "_low", "_high")
        ),
        "cannot_conclude",
    ]
    cheapest = pd.read_csv(tmp_path / "power-cheapest.csv")
    assert list(cheapest.columns) == [
        *("distance", "participants", "replicates", "best", "right_lod"),
        *(
            f"{name}{end}"
            for name in ("right", "too_cheap", "too_dear")
            for end in ("", "_low", "_high")
        ),
        "cannot_conclude",
    ]
    told = json.loads((tmp_path / "power.json").read_text(encoding="utf-8"))
    assert (told["simulated"], told["seed"], told["replicates"]) == (True, 3, 4)
    assert told["answers"] == answer_lines(outcome)
    picture = (tmp_path / "power.svg").read_text(encoding="utf-8")
    assert picture.startswith("<?xml")


def test_a_plan_that_does_not_fit_is_refused() -> None:
    own = plan(3)
    with pytest.raises(ValueError, match="plan: 5 people wanted, 3 come"):
        own.first(5)
    with pytest.raises(ValueError, match="plan: unknown clip nowhere; there are macroscopic"):
        Plan(own.clips, own.table.assign(clip="nowhere"))
    with pytest.raises(ValueError, match="plan: no column position; needed: participant,"):
        Plan(own.clips, own.table.drop(columns="position"))
    with pytest.raises(ValueError, match="participants: at least 2"):
        scene((1,), own)
