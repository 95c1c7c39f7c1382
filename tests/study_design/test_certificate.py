"""The rule that says which plays count, on records as browsers send them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from study.design.certificate import _CHECKS, REASONS, Certificate, Verdict, judge, judge_trial
from study.design.definition import parse_definition, read_definition
from study.design.faults import DefinitionError

RULE = Certificate()


def play(**changes: Any) -> dict[str, Any]:
    """Return the record of a faultless play of five seconds, but for ``changes``."""
    return {
        "is_complete": True,
        "expected_frames": 150,
        "expected_fps": 30,
        "expected_sha256": "ab",
        "clip_sha256": "ab",
        "presented_frames": 149,
        "dropped_frames": 0,
        "max_gap_ms": 51.2,
        "wall_ms": 4933.0,
        "media_ms": 4933.3,
        "stalled_ms": 0,
        "pauses": 0,
        "seeks": 0,
        "min_rate": 1,
        "max_rate": 1,
        "hidden_ms": 0,
        "unfocused_ms": 0,
        "windowed_ms": 0,
        "shown_scale": 1.0,
        "resizes": 0,
        **changes,
    }


def test_a_faultless_play_counts() -> None:
    assert judge(play(), RULE) == Verdict(True)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"is_complete": False}, "incomplete"),
        ({"presented_frames": 147}, "frames-missing"),
        ({"dropped_frames": 2}, "frames-dropped"),
        ({"max_gap_ms": 150.1}, "gap"),
        ({"stalled_ms": 151}, "stalled"),
        ({"pauses": 1}, "paused"),
        ({"seeks": 1}, "sought"),
        ({"max_rate": 1.25}, "speed"),
        ({"min_rate": 0.5}, "speed"),
        ({"wall_ms": 5500}, "speed"),
        ({"wall_ms": 4300}, "speed"),
        ({"hidden_ms": 1}, "hidden"),
        ({"was_hidden": True}, "hidden"),
        ({"unfocused_ms": 20}, "unfocused"),
        ({"shown_scale": 0.98}, "scaled"),
        ({"shown_scale": 1.02}, "scaled"),
        ({"resizes": 1}, "scaled"),
        ({"visible_share": 0.98}, "cut-off"),
        ({"clip_sha256": "cd"}, "other-clip"),
        ({"clip_sha256": ""}, "other-clip"),
    ],
)
def test_each_fault_fails_alone_and_says_why(changes: dict[str, Any], reason: str) -> None:
    assert judge(play(**changes), RULE) == Verdict(False, (reason,))


@pytest.mark.parametrize(
    "changes",
    [
        {"presented_frames": 148, "dropped_frames": 1},
        {"max_gap_ms": 150},
        {"wall_ms": 5400},
        {"windowed_ms": 5000},
        {"shown_scale": 1.01},
        {"visible_share": 0.99},
        {"hidden_ms": None, "stalled_ms": "long", "seeks": float("nan"), "pauses": True},
    ],
)
def test_what_the_rule_allows_counts(changes: dict[str, Any]) -> None:
    assert judge(play(**changes), RULE) == Verdict(True)


@pytest.mark.parametrize(
    "changes",
    [
        {"presented_frames": None},
        {"presented_frames": "many"},
        {"presented_frames": float("inf")},
        {"expected_frames": 0},
        {"expected_frames": -150},
    ],
)
def test_uncounted_frames_certify_nothing(changes: dict[str, Any]) -> None:
    assert judge(play(**changes), RULE) == Verdict(None, ("not-counted",))


@pytest.mark.parametrize(
    ("presented", "certified"), [(149, True), (148, True), (147, None), (75, None)]
)
def test_frames_between_callbacks_are_unknown_and_not_missing(
    presented: int, *, certified: bool | None
) -> None:
    reasons = () if certified else ("not-counted",)
    told = play(counted_by="callbacks", presented_frames=presented, max_gap_ms=67)
    assert judge(told, RULE) == Verdict(certified, reasons)


@pytest.mark.parametrize(
    ("changes", "verdict"),
    [
        ({}, Verdict(None, ("not-counted",))),
        ({"presented_frames": 140}, Verdict(False, ("frames-missing",))),
        ({"dropped_frames": 2}, Verdict(False, ("not-counted", "frames-dropped"))),
    ],
)
def test_playback_quality_proves_what_was_lost_and_not_what_was_shown(
    changes: dict[str, Any], verdict: Verdict
) -> None:
    assert judge(play(counted_by="quality", max_gap_ms=None, **changes), RULE) == verdict


def test_what_is_wrong_without_counting_fails_uncounted_frames() -> None:
    hidden = play(presented_frames=None, hidden_ms=5)
    assert judge(hidden, RULE) == Verdict(False, ("not-counted", "hidden"))


def test_a_study_may_be_stricter_or_laxer() -> None:
    strict = Certificate(may_be_windowed=False, max_dropped_share=0.0)
    assert judge(play(windowed_ms=1, dropped_frames=1), strict).reasons == (
        "frames-dropped",
        "windowed",
    )
    lax = Certificate(may_lose_focus=True, max_dropped_share=0.5, max_gap_ms=900.0)
    odd = play(unfocused_ms=800, presented_frames=74, dropped_frames=75, max_gap_ms=880)
    assert judge(odd, lax) == Verdict(True)


def test_one_play_that_counts_is_enough_for_a_trial() -> None:
    bad = play(seeks=2, hidden_ms=10)
    assert judge_trial([bad, play(), bad], RULE) == Verdict(True)


def test_a_trial_tells_the_reasons_of_the_play_that_came_nearest() -> None:
    uncounted = play(presented_frames=None)
    plays = [play(seeks=1, pauses=1), play(max_gap_ms=400), play(pauses=1), uncounted]
    assert judge_trial(plays, RULE) == Verdict(False, ("paused",))
    assert judge_trial([uncounted], RULE) == Verdict(None, ("not-counted",))
    assert judge_trial([], RULE) == Verdict(None)


def test_every_reason_has_its_words() -> None:
    assert list(_CHECKS) == list(REASONS)
    page = Path(__file__).parents[2] / "docs" / "tables.md"
    after = page.read_text(encoding="utf-8").split("## Why a play does not count\n")[1]
    told = after.split("\n## ")[0]
    rows = [line for line in told.splitlines() if line.startswith("| `")]
    assert rows == [f"| `{reason}` | {words} |" for reason, words in REASONS.items()]


def test_the_rule_comes_from_the_study_file_and_is_checked() -> None:
    data = read_definition("thesis").model_dump(mode="json", exclude_unset=True)
    found = parse_definition({**data, "certificate": {"max_gap_ms": 80.0, "retries": 0}})
    assert (found.certificate.max_gap_ms, found.certificate.retries) == (80.0, 0)
    with pytest.raises(DefinitionError) as caught:
        parse_definition({**data, "certificate": {"max_dropped_share": 1.5, "max_gaps": 3}})
    text = str(caught.value)
    assert (
        "certificate.max_dropped_share: input should be less than or equal to 1; found 1.5" in text
    )
    assert 'certificate.max_gaps: unknown key "max_gaps"; choose one of max_dropped_share' in text


def test_clips_can_be_watched_as_often_as_they_must() -> None:
    data = read_definition("thesis").model_dump(mode="json", exclude_unset=True)
    with pytest.raises(DefinitionError, match="max_views: 2 is fewer than min_views, 3"):
        parse_definition({**data, "order": {"min_views": 3, "max_views": 2}})


def test_a_study_without_a_rule_of_its_own_is_the_study_that_it_was() -> None:
    study = read_definition("thesis")
    data = study.model_dump(mode="json", exclude_unset=True)
    spelt_out = {**data, "certificate": {"max_dropped_share": 0.01}}
    assert parse_definition(spelt_out).definition_hash == study.definition_hash
    stricter = parse_definition({**data, "certificate": {"max_dropped_share": 0.0}})
    assert stricter.definition_hash != study.definition_hash
