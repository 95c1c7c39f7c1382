"""LoD by size: what is enough, hysteresis in closed form, blending without a jump, policy files."""

from __future__ import annotations

import itertools
import json
import math
from dataclasses import asdict
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from renderer.detail import STANDARD_LODS, Detail
from renderer.lod.choice import LodPolicy, LodStep, shares
from renderer.lod.policy import (
    Evidence,
    PolicyFile,
    default_policy,
    parse_policy,
    read_policy,
    write_policy,
)

LIMITS = (14.0, 48.0, 200.0)


def policy_of(limits: tuple[float, ...] = LIMITS, **values: float) -> LodPolicy:
    names = STANDARD_LODS[-len(limits) - 1 :]
    steps = [
        LodStep(name, Detail.uniform(name), limit)
        for name, limit in zip(names, (*limits, None), strict=True)
    ]
    return LodPolicy(tuple(steps), **values)


SIZES = st.floats(min_value=1.0, max_value=1000.0)


@pytest.mark.parametrize(
    ("iris_px", "step"), [(3, 0), (14, 0), (14.01, 1), (48, 1), (49, 2), (200, 2), (201, 3)]
)
def test_a_step_serves_up_to_its_limit(iris_px: float, step: int) -> None:
    assert policy_of().choose(iris_px) == step


@given(SIZES, st.integers(0, 3))
def test_no_eye_is_ever_coarser_than_its_size_allows(iris_px: float, last: int) -> None:
    policy = policy_of()
    needed = policy.choose(iris_px)
    assert policy.choose(iris_px, last=last) >= needed
    if iris_px not in LIMITS:
        assert policy.mix(iris_px) > needed - 1
    assert policy.mix(math.nextafter(200.0, 1e3)) == 3.0


@pytest.mark.parametrize("limit", LIMITS)
def test_hysteresis_keeps_the_finer_step_down_to_its_own_limit(limit: float) -> None:
    policy = policy_of(hysteresis=0.1)
    coarse = LIMITS.index(limit)
    assert policy.choose(0.901 * limit, last=coarse + 1) == coarse + 1
    assert policy.choose(0.899 * limit, last=coarse + 1) == coarse
    assert policy.choose(1.001 * limit, last=coarse) == coarse + 1
    assert policy.choose(0.999 * limit, last=coarse) == coarse


@given(st.lists(st.floats(0.901, 1.2), min_size=2, max_size=40), st.sampled_from(LIMITS))
def test_jitter_within_the_hysteresis_switches_at_most_once(
    sizes: list[float], limit: float
) -> None:
    policy, step = policy_of(hysteresis=0.1), None
    steps = []
    for size in sizes:
        step = policy.choose(size * limit, last=step)
        steps.append(step)
    assert sum(a != b for a, b in itertools.pairwise(steps)) <= 1
    bare = policy_of(hysteresis=0.0)
    jitter = [bare.choose(s * limit, last=0) for s in (0.95, 1.05, 0.95, 1.05)]
    assert len(set(jitter)) == 2, "the test can fail: without hysteresis it toggles"


def test_a_leap_passes_over_steps_both_ways() -> None:
    policy = policy_of()
    assert policy.choose(300.0, last=0) == 3
    assert policy.choose(5.0, last=3) == 0
    assert policy.choose(46.0, last=3) == 2, "46 px need medium; its finer neighbour is kept"


@given(SIZES)
def test_blending_is_continuous_rises_and_joins_two_steps_at_most(iris_px: float) -> None:
    policy = policy_of(band=0.25)
    here, above = policy.mix(iris_px), policy.mix(iris_px * 1.001)
    # A band of a quarter spans log(1 / 0.75): the steepest rise is its reciprocal.
    assert -1e-9 <= above - here <= 0.001 / math.log(1 / 0.75) + 1e-9
    parts = shares(here)
    assert len(parts) <= 2
    assert sum(share for _, share in parts) == pytest.approx(1.0)
    assert sum(step * share for step, share in parts) == pytest.approx(here)


def test_outside_its_bands_a_blend_is_one_step() -> None:
    policy = policy_of(band=0.25)
    assert [policy.mix(px) for px in (10.0, 14.0, 30.0, 48.0, 140.0, 200.0, 900.0)] == [
        *(0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0)
    ]
    assert policy.mix(48.0 * math.sqrt(0.75)) == pytest.approx(1.5)


def test_bands_that_would_overlap_are_cut() -> None:
    policy = policy_of((14.0, 15.0), band=0.25)
    assert policy.mix(14.0) == 1.0
    assert policy.mix(math.sqrt(14.0 * 15.0)) == pytest.approx(1.5)


def test_a_fixed_eye_keeps_the_finest_step() -> None:
    assert policy_of().place(5.0, "fixed") == 3.0
    assert policy_of().place(12.8, "instant", last=1.0) == 1.0
    assert policy_of().place(12.8, "blended", last=1.0) < 1.0


def test_faults_of_a_policy_are_told_together() -> None:
    low, ultra = (Detail.uniform(name) for name in ("low", "ultra"))
    with pytest.raises(ValueError, match=r"steps\.1\.up_to_iris_px: 5; the finest LoD") as caught:
        LodPolicy((LodStep("low", low, -3.0), LodStep("ultra", ultra, 5.0)), band=2.0)
    assert "steps.0.up_to_iris_px: -3.0; the LoDs run from coarse to fine" in str(caught.value)
    assert "band: 2.0 lies outside 0 to 0.9" in str(caught.value)
    with pytest.raises(ValueError, match="steps: empty"):
        LodPolicy(())


def test_a_policy_survives_json() -> None:
    policy = policy_of(band=0.5)
    assert LodPolicy.from_dict(json.loads(json.dumps(asdict(policy)))) == policy


def test_a_file_keeps_policy_evidence_and_own_lods(tmp_path: Path) -> None:
    bent = Detail.uniform("medium").with_levels(refraction="high")
    steps = (LodStep("bent", bent, 60.0), LodStep("ultra", Detail.uniform("ultra"), None))
    evidence = (Evidence((50.0, 70.0), 3.5), Evidence(None, 9.0))
    file = PolicyFile(LodPolicy(steps), evidence, "people's ratings", {"participants": 40})
    write_policy(file, tmp_path / "lod_policy.json")
    assert read_policy(tmp_path / "lod_policy.json") == file


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"schema": 9}, "schema: 9"),
        ({"bands": 1}, "bands: unknown key; choose one of band, hysteresis"),
        ({"steps": [{"lod": "best"}]}, r'steps\.0\.levels: missing; .* "best" needs the level'),
        ({"steps": []}, "steps: empty"),
        ({"hysteresis": None}, "hysteresis: None is no number"),
    ],
)
def test_a_file_that_is_none_says_why(change: dict[str, object], message: str) -> None:
    data = {
        "schema": 1,
        "measure": "x",
        "hysteresis": 0.1,
        "band": 0.2,
        "steps": [{"lod": "ultra", "up_to_iris_px": None}],
    }
    assert parse_policy(json.dumps(data), source="p.json").policy.finest == Detail.uniform("ultra")
    with pytest.raises(ValueError, match=rf"p\.json: not a LoD policy of schema 1: .*{message}"):
        parse_policy(json.dumps(data | change), source="p.json")


def test_the_default_policy_runs_from_low_to_ultra() -> None:
    policy = default_policy()
    assert policy.steps[-1].lod == "ultra"
    assert list(policy.limits_px) == sorted(policy.limits_px)
