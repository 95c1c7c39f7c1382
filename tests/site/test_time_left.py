"""The time left: the study's estimate first, the participant's own pace later."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import pytest

from study.data.trials import Trial
from study.design.definition import read_definition
from study.design.duration import visit_parts
from study.site.time_left import minutes_left

START = datetime(2026, 11, 22, 9, 0, tzinfo=UTC)
THESIS = read_definition("thesis")


def trials(took_s: list[float], still_open: int) -> list[Trial]:
    """Return trials that took so many seconds, and others that are open."""
    every: list[float | None] = [*took_s, *[None] * still_open]
    return [
        Trial(
            id=number,
            position=number,
            number=number,
            is_practice=False,
            clip="1",
            clip_id="1",
            started_at=None if seconds is None else START,
            completed_at=None if seconds is None else START + timedelta(seconds=seconds),
        )
        for number, seconds in enumerate(every, start=1)
    ]


def test_at_first_it_is_the_studys_estimate() -> None:
    parts = visit_parts(THESIS)
    whole = (parts["watching"] + parts["answering"]) / 60
    assert minutes_left(THESIS, trials([], 8)) == pytest.approx(whole, abs=1)
    assert minutes_left(THESIS, trials([600, 600], 6)) == minutes_left(THESIS, trials([], 6))


def test_then_it_is_their_own_pace_and_no_pause_changes_it() -> None:
    assert minutes_left(THESIS, trials([60, 60, 60], 5)) == 5
    assert minutes_left(THESIS, trials([60, 60, 60, 60, 36_000], 3)) == 3


def test_it_is_never_less_than_a_minute() -> None:
    assert minutes_left(THESIS, trials([2, 2, 2], 1)) == 1
