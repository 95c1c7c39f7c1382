"""Intervals of thresholds over repeated studies of simulated people, whose truth is known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ndtri

from analysis.curves.curve import D_PRIME_1, MARGIN
from analysis.curves.noticed import noticed_curves
from analysis.curves.sizes import PIXELS
from analysis.decision.margins import DEFAULT
from analysis.simulation.observers import Stimulus
from analysis.simulation.population import POPULATION
from analysis.simulation.simulated import simulate_tables
from analysis.tables.reading import Tables, tables_from

LOW = 3.8  # d' of low beside ultra at full size
MOST = LOW * (1 + POPULATION.share_of_experts * (POPULATION.expert_sensitivity - 1))


def study(seed: int, people: int) -> Tables:
    shown = {}
    for distance, px in POPULATION.iris_px.items():
        for left, right in (("low", "ultra"), ("ultra", "low"), ("ultra", "ultra")):
            shown[f"{distance} {left} {right}"] = Stimulus(distance, px, left, right)
    rng = np.random.default_rng([20120831, seed])
    return tables_from(simulate_tables(shown, rng, participants=people))


def check(people: int, studies: int, *, seed: int) -> None:
    """Assert coverage of the size at d' = 1, and how often a safe limit lies beyond the truth."""
    middle, width = POPULATION.half_sensitivity_log2_px, POPULATION.sensitivity_width_log2_px
    truth = 2.0 ** (middle + width * ndtri(1.0 / MOST))
    covered, beyond = 0, 0
    for number in range(studies):
        rows = study(seed + number, people).comparisons
        rng = np.random.default_rng(number)
        (curve,) = noticed_curves(rows, PIXELS, rng, best="ultra", margins=DEFAULT)
        found = curve.threshold(D_PRIME_1)
        covered += found.low <= truth <= found.high
        beyond += found.safe > truth
        assert curve.threshold(MARGIN).safe <= curve.threshold(MARGIN).size
    # Binomial at 95 % and 5 %: three standard deviations to either side.
    slack = 3 * np.sqrt(0.05 * 0.95 / studies)
    assert covered / studies >= 0.95 - slack - 0.01
    assert beyond / studies <= 0.05 + slack + 0.01


def test_a_few_studies_hold_the_truth() -> None:
    check(12, 8, seed=0)


@pytest.mark.long
@pytest.mark.parametrize("people", [10, 24, 100])
def test_intervals_of_thresholds_keep_their_word(people: int) -> None:
    check(people, 100, seed=1000)
