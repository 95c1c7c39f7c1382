"""The checks before the clips in the data: their order, their events, the angles that follow."""

from __future__ import annotations

from typing import Any

import pytest

from study.data import before, events, export, progress, steps
from study.data.angles import iris_angle, shown
from study.data.refusals import NotReachedError
from study.data.studies import Study
from study.design.definition import StudyDefinition, parse_definition

FACTS: dict[str, Any] = {
    "mm_per_px": 0.25,
    "mm_per_px_se": 0.001,
    "view_dist_cm": 60.0,
    "view_dist_cm_se": 4.4,
}
CALIBRATION = {"facts": FACTS, "report": {"screen_width_px": 1920, "pixel_ratio": 1.0}}
PLAY = {"shown_scale": 1.0, "screen_width_px": 1920, "device_pixel_ratio": 1.0}


@pytest.fixture
def definition(raw: dict[str, Any]) -> StudyDefinition:
    """The small study with a screen check and an eyesight test, and no calibration."""
    return parse_definition({**raw, "device_check": {}, "eyesight": {}})


def step_of(walk: Any) -> str:
    return str(progress.current_step(walk.db, walk.participant).name)


def store(walk: Any, check: Any, key: str = "a", **facts: Any) -> bool:
    return before.record(
        walk.db, walk.participant, check, key=key, report={"x": 1}, facts=facts
    ).new


def test_checks_come_after_the_questions_and_before_the_instructions(walk: Any) -> None:
    walk.consent()
    with pytest.raises(NotReachedError, match="device_check comes after what is still open"):
        store(walk, "device_check")
    walk.about()
    assert step_of(walk) == "device_check"
    for early in ("eyesight", "calibration"):
        with pytest.raises(NotReachedError, match=f"{early} comes after what is still open"):
            store(walk, early)
    with pytest.raises(NotReachedError, match="the questions about you and the checks"):
        steps.finish_instructions(walk.db, walk.participant, key="instructions")
    assert store(walk, "device_check", refresh_hz=60.0)
    assert step_of(walk) == "eyesight"
    assert store(walk, "eyesight", key="b")
    assert step_of(walk) == "instructions"


def test_the_first_report_of_a_check_counts(walk: Any, study: Study) -> None:
    walk.consent()
    walk.about()
    assert store(walk, "device_check", zoom=1.0)
    assert not store(walk, "device_check", zoom=1.0)
    assert not store(walk, "device_check", key="other", zoom=2.0)
    assert before.facts_of(walk.db, walk.participant, "device_check") == {"zoom": 1.0}
    assert before.facts_of(walk.db, walk.participant, "eyesight") == {}
    row = export.tables(walk.db, study).participants.iloc[0]
    assert (row["zoom"], row["status"]) == (1.0, "eyesight")


def test_a_key_that_was_used_for_something_else_stores_nothing(walk: Any) -> None:
    walk.consent()
    walk.about()
    before.note(walk.db, walk.participant, "device_check_failed", key="a", payload={"n": 1})
    assert not store(walk, "device_check")
    assert step_of(walk) == "device_check"
    assert before.times(walk.db, walk.participant, "device_check_failed") == 1
    kinds = [event.kind for event in events.history(walk.db, walk.participant)]
    assert kinds[-1] == "device_check_failed"


def test_an_iris_has_its_angle_where_screen_and_play_agree() -> None:
    found = iris_angle([PLAY], CALIBRATION, iris_px=160.0, width_px=1280)
    assert found["iris_deg"] == pytest.approx(3.818, abs=1e-3)
    assert found["iris_deg_se"] == pytest.approx(0.0733 * 3.818, rel=0.02)
    half = iris_angle([{**PLAY, "shown_scale": 0.5}], CALIBRATION, iris_px=160.0, width_px=1280)
    assert half["iris_deg"] == pytest.approx(1.909, abs=2e-3)


@pytest.mark.parametrize(
    ("play", "calibration"),
    [
        (PLAY, None),
        ({**PLAY, "shown_scale": None}, CALIBRATION),
        ({**PLAY, "screen_width_px": 2560, "device_pixel_ratio": 2.0}, CALIBRATION),
        (PLAY, {**CALIBRATION, "facts": {**FACTS, "view_dist_cm": None}}),
        (PLAY, {"report": {}, "facts": {}}),
    ],
)
def test_an_angle_that_nobody_knows_is_missing(play: Any, calibration: Any) -> None:
    found = iris_angle([play], calibration, iris_px=160.0, width_px=1280)
    assert found == {"iris_deg": None, "iris_deg_se": None}
    assert iris_angle([], CALIBRATION, iris_px=160.0, width_px=1280)["iris_deg"] is None


def test_zooming_between_plays_widens_what_is_known_of_the_scale() -> None:
    assert shown([], width_px=1280) == {"shown_scale": None, "shown_scale_se": None}
    zoomed = {**PLAY, "shown_scale": 0.9, "device_pixel_ratio": 1.25, "screen_width_px": 2400}
    found = shown([PLAY, zoomed], width_px=1280)
    assert found == {"shown_scale": 0.9, "shown_scale_se": pytest.approx(0.05)}
    angle = iris_angle([PLAY, zoomed], CALIBRATION, iris_px=160.0, width_px=1280)
    assert angle["iris_deg"] == pytest.approx(0.9 * 3.818, abs=2e-3)
    assert angle["iris_deg_se"] == pytest.approx(0.0925 * 0.9 * 3.818, rel=0.02)
