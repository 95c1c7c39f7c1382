"""Noticing: closed forms of detection, and silence where nothing can be told."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from scipy.special import ndtri

from analysis.estimates.noticing import Noticing, noticing_of

RATINGS = pd.DataFrame(
    {"distance": "near", "lod": ["low", "ultra"], "lod_rank": [0, 3], "iris_px": 100.0}
)


def answers(pair: tuple[str, str], yes: int, unsure: int, no: int) -> pd.DataFrame:
    words = ["yes"] * yes + ["unsure"] * unsure + ["no"] * no
    return pd.DataFrame(
        {
            "participant": [f"p{i % 40}" for i in range(len(words))],
            "is_practice": False,
            "distance": "near",
            "left_lod": pair[0],
            "right_lod": pair[1],
            "noticed": words,
        }
    ).sample(frac=1.0, random_state=1)


def fitted(*parts: pd.DataFrame) -> Noticing | None:
    return noticing_of(pd.concat(parts, ignore_index=True), RATINGS, np.random.default_rng(1))


def test_d_prime_is_the_difference_of_the_scores_and_left_and_right_are_one_pair() -> None:
    alike = answers(("ultra", "ultra"), 100, 200, 700)
    differ = answers(("low", "ultra"), 293, 125, 82)
    mirrored = answers(("ultra", "low"), 293, 125, 82)
    found = fitted(alike, differ, mirrored)
    assert found is not None
    assert found.pairs == (("near", "low", "ultra"),)
    assert found.catch_answers == 1000
    # Both criteria give the same d' of 1.5, so the fit can meet all four shares.
    wanted = ndtri(0.586) - ndtri(0.1)
    assert wanted == pytest.approx(ndtri(0.836) - ndtri(0.3), abs=0.01)
    width = np.hypot(1.0, found.fit.sd("leniency"))
    assert found.sensitivity()[0][0] / width == pytest.approx(wanted, abs=0.06)
    assert found.false_alarms()[0] == pytest.approx(0.1, abs=0.01)
    assert found.shares()[0][0] == pytest.approx(0.586, abs=0.01)
    row = found.table().iloc[0]
    assert row["excess"] == pytest.approx(0.486, abs=0.015)
    assert row["excess_low"] < row["excess"] < row["excess_high"]


def test_an_invisible_difference_has_no_sensitivity() -> None:
    found = fitted(answers(("low", "low"), 40, 40, 120), answers(("low", "ultra"), 40, 40, 120))
    assert found is not None
    row = found.table().iloc[0]
    assert row["d_prime_low"] < 0 < row["d_prime_high"]
    assert row["excess_high"] < 0.25


def test_without_equal_pairs_a_yes_may_be_a_guess() -> None:
    assert fitted(answers(("low", "ultra"), 10, 5, 5)) is None
    assert fitted(answers(("low", "low"), 10, 5, 5)) is None
