"""The loss of realism along size over repeated studies of simulated people whose truth is known."""

from __future__ import annotations

import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest

from analysis.curves.curve import SizeCurve
from analysis.curves.rated import rated_curves
from analysis.curves.sizes import PIXELS
from analysis.decision.margins import DEFAULT
from analysis.power.assumed import Assumed, named_truth
from analysis.power.plan import Plan
from analysis.power.replicates import answers_of
from analysis.power.tables import as_tables
from analysis.simulation.population import POPULATION

sys.path += [str(Path(__file__).parents[1]), str(Path(__file__).parents[1] / "simulations")]
from chance import least
from repeated import BEST, everybody_sees_all

NOTHING = 0.03  # points; a curve never reaches 0 itself, so that no interval holds it


def studied(plan: Plan, truth: Assumed, seed: int) -> tuple[SizeCurve, ...]:
    rng = np.random.default_rng([31, seed])
    tables = as_tables(plan, answers_of(plan, truth, rng))
    return rated_curves(
        tables.ratings, PIXELS, rng, best=BEST, scale=tables.scale, margins=DEFAULT, experts={}
    )


@pytest.mark.parametrize(
    ("people", "studies"),
    [
        (24, 6),
        *(pytest.param(n, s, marks=pytest.mark.long) for n, s in ((10, 100), (24, 100), (100, 40))),
    ],
)
def test_bands_hold_the_loss_at_the_sizes_shown(people: int, studies: int) -> None:
    plan = everybody_sees_all(people, tuple(POPULATION.iris_px))
    truth = named_truth("thesis", plan.stimuli, DEFAULT)
    holds, away = defaultdict(list), defaultdict(list)
    for seed in range(studies):
        for curve in studied(plan, truth, seed):
            for distance, px in POPULATION.iris_px.items():
                true = truth.loss(distance, curve.lod, best=BEST)
                at = int(np.abs(np.log(curve.sizes / px)).argmin())
                away[distance, curve.lod].append(float(curve.value[at]) - true)
                if true > NOTHING:
                    holds[distance, curve.lod].append(curve.low[at] <= true <= curve.high[at])
    told = {cell: float(np.mean(own)) for cell, own in holds.items()}
    bias = {cell: round(float(np.mean(own)), 3) for cell, own in away.items()}
    print(people, {cell: round(100 * share) for cell, share in told.items()}, bias)
    assert np.mean(list(told.values())) >= least(studies, 0.93), told
    assert min(told.values()) >= least(studies, 0.85), told
    assert max(map(abs, bias.values())) < 0.1 + 0.3 / np.sqrt(studies), bias
