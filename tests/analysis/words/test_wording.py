"""Numbers as sentences and tables of the report write them."""

from __future__ import annotations

import pytest

from analysis.words.wording import number, percent, place


@pytest.mark.parametrize(
    ("value", "text"),
    [(-0.24, "−0.24"), (-0.004, "0.00"), (0.0, "0.00"), (1.5, "1.50"), (float("nan"), "–")],
)
def test_a_number_has_a_true_minus_and_zero_none(value: float, text: str) -> None:
    assert number(value) == text


@pytest.mark.parametrize(("share", "text"), [(-0.05, "−5"), (-0.004, "0"), (0.9, "90")])
def test_a_share_has_a_true_minus_and_zero_none(share: float, text: str) -> None:
    assert percent(share) == f"{text}\N{NO-BREAK SPACE}%"


def test_a_distance_with_the_name_of_a_lod_says_what_it_is() -> None:
    assert place("medium", {"low", "medium"}) == "medium distance"
    assert place("far", {"low", "medium"}) == "far"
