"""lod_policy.json: what it holds, how it stays safe, and that the renderer reads it."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analysis.costs.cost import COLUMNS, Costs
from analysis.curves.along_sizes import Curves
from analysis.curves.curve import MARGIN, NOTICED, RATED, SizeCurve, Threshold
from analysis.curves.sizes import PIXELS
from analysis.decision.margins import Margins
from analysis.decision.policy import Policy, policy_of
from analysis.decision.policy_sentences import policy_answer
from analysis.tables.columns import EFFECTS
from renderer.detail import Detail
from renderer.lod.policy import parse_policy

RANKS = {"low": 0.0, "medium": 1.0, "high": 2.0, "ultra": 3.0}


def curve(kind: str, lod: str, safe: float, high: float) -> SizeCurve:
    sizes = np.array([12.0, 350.0])
    return SizeCurve(
        kind=kind,
        measure=PIXELS,
        lod=lod,
        best="ultra",
        sizes=sizes,
        value=np.zeros(2),
        low=np.zeros(2),
        high=np.zeros(2),
        base=(0.0, 0.0, 0.0),
        points=pd.DataFrame(),
        thresholds=(Threshold(MARGIN, 0.5, (safe + high) / 2, safe, high, safe),),
        people=24,
        answers=200,
    )


def policy(
    rated: dict[str, tuple[float, float]],
    noticed: dict[str, tuple[float, float]],
    *,
    costs: Costs | None = None,
    levels: dict[str, dict[str, str]] | None = None,
    verdicts: dict[str, dict[float, bool]] | None = None,
) -> Policy:
    made = [curve(RATED, lod, *own) for lod, own in rated.items()]
    made += [curve(NOTICED, lod, *own) for lod, own in noticed.items()]
    return policy_of(
        Curves(tuple(made)),
        "ultra",
        RANKS,
        levels=levels or {},
        margins=Margins(),
        costs=costs,
        provenance={"simulated": True, "people": 24},
        verdicts=verdicts or {},
    )


def limits(made: Policy) -> dict[str, float | None]:
    return {step.lod: step.up_to_px for step in made.steps}


ALL = {"low": (20.0, 40.0), "medium": (60.0, 90.0), "high": (200.0, np.inf)}


def test_a_limit_is_the_smaller_safe_bound_of_the_two_questions() -> None:
    made = policy(ALL, ALL | {"medium": (50.0, 80.0)})
    assert limits(made) == {"low": 20.0, "medium": 50.0, "high": 200.0, "ultra": None}
    assert [step.interval_px for step in made.steps] == [
        (20.0, 40.0),
        (50.0, 80.0),
        (200.0, 350.0),
        None,
    ]


def test_no_lod_reaches_further_than_a_finer_one() -> None:
    made = policy(ALL | {"low": (120.0, 140.0)}, ALL | {"low": (300.0, np.inf)})
    assert limits(made) == {"low": 60.0, "high": 200.0, "ultra": None}
    assert made.left_out == {"medium": "a coarser one is enough up to the same size"}


def test_a_lod_that_is_never_enough_ends_the_sequence() -> None:
    made = policy(ALL | {"medium": (0.0, 20.0)}, ALL)
    assert limits(made) == {"high": 200.0, "ultra": None}
    assert made.left_out == {
        "medium": "not shown to be enough at any size",
        "low": "not tested after medium, which is not shown to be enough",
    }
    nothing = policy(dict.fromkeys(ALL, (0.0, 0.0)), ALL)
    assert limits(nothing) == {"ultra": None}


def test_what_was_not_measured_is_not_enough() -> None:
    made = policy(ALL, {"low": (20.0, 40.0), "high": (200.0, np.inf)})
    assert limits(made) == {"high": 200.0, "ultra": None}
    assert made.left_out["medium"] == "along pixels it is not known how it is noticed"


def test_no_limit_lies_beyond_the_sizes_shown_nor_at_a_failed_distance() -> None:
    far = dict.fromkeys(ALL, (np.inf, np.inf))
    assert limits(policy(far, far)) == {"low": 350.0, "ultra": None}
    verdicts = {"high": {160.0: True, 350.0: False}, "low": {12.0: True, 40.0: False}}
    made = policy(far, far, verdicts=verdicts)
    assert limits(made) == {"low": 12.0, "medium": 160.0, "ultra": None}
    none = policy(far, far, verdicts={"high": {12.0: False}})
    assert none.left_out["low"] == "not tested after high, which is not shown to be enough"
    assert none.left_out["high"] == "not shown to be enough at any size"


def costs() -> Costs:
    rows = [
        ("gl", "1920x1080", 2, distance, px, lod, ms, 2.0, 9)
        for distance, px in (("near", 160.0), ("far", 12.0))
        for lod, ms in (("low", 180.0 + px), ("ultra", 300.0 + px))
    ]
    return Costs(pd.DataFrame(rows, columns=list(COLUMNS)), "2 eyes, 1920x1080 pixels, gl", 2.0)


def test_the_renderer_reads_what_people_decided() -> None:
    medium = dict.fromkeys(EFFECTS, "medium") | {"refraction": "high"}
    low = dict.fromkeys(EFFECTS, "low")
    made = policy(ALL, ALL, costs=costs(), levels={"medium": medium, "low": low})
    file = parse_policy(made.text(), source="lod_policy.json")
    assert [step.lod for step in file.policy.steps] == ["low", "medium", "high", "ultra"]
    assert file.policy.limits_px == (20.0, 60.0, 200.0)
    assert file.policy.steps[0].detail == Detail.uniform("low")
    assert file.policy.steps[1].detail.levels() == medium
    assert file.policy.choose(19.0) == 0
    assert [own.interval_px for own in file.evidence][:2] == [(20.0, 40.0), (60.0, 90.0)]
    assert [own.ms for own in file.evidence] == [96.0, None, None, 230.0]  # nearest size, per eye
    assert "noticed beside it by at most 25" in file.measure
    told = json.loads(made.text())["provenance"]
    assert told["margins"]["origin"] == "set at analysis"
    assert told["sizes_shown_px"] == [12.0, 350.0]
    assert told["limits_px"]["high"]["rated"]["high"] == "above"
    assert told["simulated"] is True
    low_ms, high_ms = told["ms_interval"]["low"]
    assert low_ms < 96.0 < high_ms
    assert set(told["ms_interval"]) == {"low", "ultra"}


def test_a_lod_whose_levels_are_unknown_is_refused_where_its_name_does_not_say_them() -> None:
    step = replace(policy(ALL, ALL).steps[0], lod="plain")
    text = Policy((step, policy(ALL, ALL).steps[-1]), {}, "by hand").text()
    with pytest.raises(
        ValueError, match='only low, medium, high, ultra are known by name, "plain"'
    ):
        parse_policy(text, source="lod_policy.json")


def test_what_a_distance_shows_holds_where_a_curve_is_too_unsure() -> None:
    verdicts = {"high": {12.0: True, 40.0: True, 160.0: False}, "low": {12.0: True, 40.0: False}}
    unsure = {"high": (0.0, 200.0), "low": (15.0, 50.0)}
    made = policy(unsure, unsure, verdicts=verdicts)
    assert limits(made) == {"low": 15.0, "high": 40.0, "ultra": None}
    alone = policy({}, {}, verdicts=verdicts)  # a study without curves
    assert limits(alone) == {"low": 12.0, "high": 40.0, "ultra": None}
    assert [step.interval_px for step in alone.steps] == [(12.0, 40.0), (40.0, 160.0), None]


def test_the_answer_along_size_names_limits_costs_and_reasons() -> None:
    made = policy({"low": (20.0, 40.0), "high": (200.0, np.inf)}, ALL, costs=costs())
    gap = "\N{NO-BREAK SPACE}"
    text = policy_answer(made, costs())
    assert text.startswith(f"high is enough up to an iris of 200{gap}px (undecided from there to ")
    assert f"; ultra above, 230{gap}ms of a frame per eye (229{gap}ms to 231{gap}ms)" in text
    assert "; medium: along pixels it is not known how it is rated; low: not tested after" in text
    plain = policy_answer(policy(ALL, ALL))
    assert plain == (
        f"low is enough up to an iris of 20{gap}px (undecided from there to 40{gap}px), medium is "
        f"enough up to an iris of 60{gap}px (undecided from there to 90{gap}px) and high is enough "
        f"up to an iris of 200{gap}px (undecided from there to 350{gap}px); ultra above."
    )
    nothing = policy_answer(policy({}, {}, verdicts={"high": {12.0: False}}))
    assert nothing.startswith("at no size is a LoD below ultra shown to be enough (high: along")
