"""From errors to a policy: crossings in closed form, medians, and LoDs that are not worth it."""

from __future__ import annotations

import math

import pytest

from renderer.detail import Detail
from renderer.lod.derivation import LodError, derive_policy, limit_px, limits_px
from renderer.lod.policy import parse_policy, policy_text

SIZES = (8.0, 16.0, 32.0, 64.0)
LODS = {name: Detail.uniform(name) for name in ("low", "medium", "high")}


def growing(lod: str, case: str, *, reaches_one_at_px: float) -> list[LodError]:
    """An error that is 1 at a size and grows by 0.5 with each doubling."""
    return [
        LodError(lod, case, size, 1 + 0.5 * math.log2(size / reaches_one_at_px)) for size in SIZES
    ]


@pytest.mark.parametrize("at_px", [9.0, 16.0, 20.0, 50.0])
def test_the_limit_is_where_the_error_reaches_what_is_noticed(at_px: float) -> None:
    assert limit_px(growing("low", "a", reaches_one_at_px=at_px), 1.0) == pytest.approx(at_px)


def test_the_limit_stays_within_what_was_measured() -> None:
    assert limit_px(growing("low", "a", reaches_one_at_px=5.0), 1.0) == 0.0
    assert limit_px(growing("low", "a", reaches_one_at_px=500.0), 1.0) == 64.0


def test_the_first_crossing_counts() -> None:
    rows = [
        LodError("low", "a", size, e) for size, e in zip(SIZES, (0.5, 1.5, 0.5, 2), strict=True)
    ]
    assert 8.0 < limit_px(rows, 1.0) < 16.0


def test_a_policy_has_medians_ranges_and_no_step_that_serves_nothing() -> None:
    errors = [
        *growing("low", "a", reaches_one_at_px=10.0),
        *growing("low", "b", reaches_one_at_px=12.0),
        *growing("low", "c", reaches_one_at_px=20.0),
        *growing("medium", "a", reaches_one_at_px=11.0),
        *growing("high", "a", reaches_one_at_px=40.0),
    ]
    assert limits_px(errors, 1.0)["low"] == pytest.approx([10.0, 12.0, 20.0])
    file = derive_policy(
        errors,
        LODS,
        reference=("ultra", Detail.uniform("ultra")),
        just_noticeable=1.0,
        provenance={"gl_renderer": "x"},
    )
    found = [(step.lod, step.up_to_iris_px) for step in file.policy.steps]
    assert found == [("low", 12.0), ("high", 40.0), ("ultra", None)]
    assert file.evidence[0].interval_px == (10.0, 20.0)
    assert file.provenance["limits_px"]["medium"] == [11.0]
    assert file.provenance["mean_error"]["medium"]["16"] == pytest.approx(1.27, abs=0.01)
    assert parse_policy(policy_text(file), source="p").policy == file.policy
