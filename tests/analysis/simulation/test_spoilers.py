"""Simulated spoilers: each does its one thing to an honest observer's answers."""

from __future__ import annotations

import numpy as np
import pytest

from analysis.simulation.observers import Answer, Observer, Stimulus, draw_observer
from analysis.simulation.spoilers import SPOILERS, spoiled

CLIP = Stimulus("macroscopic", 350.0, "low", "ultra")


def answers(observer: Observer, *, seed: int = 2) -> list[Answer]:
    rng = np.random.default_rng(seed)
    return [observer.answer(CLIP, rng) for _ in range(60)]


def given(found: list[Answer]) -> list[int]:
    both = [(a.left_rating, a.right_rating) for a in found]
    return [rating for pair in both for rating in pair if rating is not None]


@pytest.fixture
def honest(rng: np.random.Generator) -> Observer:
    return draw_observer(rng)


def test_a_straight_liner_says_the_same_of_everything(honest: Observer) -> None:
    found = answers(spoiled(honest, "straight-liner"))
    assert set(given(found)) == {3}
    assert {(a.comparison, a.noticed) for a in found} == {(0, "no")}


def test_an_extreme_uses_the_ends_only(honest: Observer) -> None:
    assert set(given(answers(spoiled(honest, "extreme")))) == {1, 5}


def test_an_inverter_turns_the_scale_and_the_comparison_round(honest: Observer) -> None:
    for said, turned in zip(answers(honest), answers(spoiled(honest, "inverter")), strict=True):
        if said.left_rating is not None:
            assert turned.left_rating == 6 - said.left_rating
        if said.comparison is not None:
            assert turned.comparison == -said.comparison


def test_a_side_picker_prefers_the_right_eye(honest: Observer) -> None:
    found = answers(spoiled(honest, "side-picker"))
    assert {a.comparison for a in found} == {1}
    assert all(a.left_rating < a.right_rating for a in found if a.left_rating and a.right_rating)


def test_a_shuffler_does_not_look(honest: Observer) -> None:
    found = answers(spoiled(honest, "shuffler"))
    gap = [a.right_rating - a.left_rating for a in found if a.left_rating and a.right_rating]
    assert abs(np.mean(gap)) < 0.5
    honest_gap = [
        a.right_rating - a.left_rating for a in answers(honest) if a.left_rating and a.right_rating
    ]
    assert np.mean(honest_gap) > 1.0


def test_an_unknown_kind_is_refused(honest: Observer) -> None:
    with pytest.raises(ValueError, match=f'"liar"; accepted: {", ".join(SPOILERS)}'):
        spoiled(honest, "liar")
