"""Single effects exactly on a margin: how often one is called dispensable, which is wrong there."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analysis.decision.margins import DEFAULT
from analysis.decision.verdicts import DIFFERENT, EQUIVALENT
from analysis.power.assumed import Differences, changed, named_truth
from analysis.power.plan import Plan
from analysis.power.quick import prepare
from analysis.power.replicates import answers_of
from analysis.simulation.observers import Stimulus
from analysis.simulation.population import POPULATION
from analysis.tables.columns import EFFECTS

sys.path.append(str(Path(__file__).parents[1]))
from chance import most

LODS = ("no-caustics", "no-sclera", "no-texture")
DISTANCES = ("macroscopic", "near", "far")
BEST = "ultra"
FULL = dict.fromkeys(EFFECTS, BEST)
LEVELS = {BEST: FULL} | {lod: FULL | {lod.removeprefix("no-"): "off"} for lod in LODS}
LONG = pytest.mark.long


def ablation(people: int) -> Plan:
    """Return a plan of every LoD beside the best both ways, and two equal pairs, per distance."""
    pairs = [(lod, BEST) for lod in LODS] + [(BEST, lod) for lod in LODS] + [(BEST, BEST)] * 2
    clips = {
        f"{distance} {i}": Stimulus(
            distance, POPULATION.iris_px[distance], one, other, LEVELS[one], LEVELS[other]
        )
        for distance in DISTANCES
        for i, (one, other) in enumerate(pairs)
    }
    rows = [
        (person, place + 1, clip) for person in range(people) for place, clip in enumerate(clips)
    ]
    return Plan(clips, pd.DataFrame(rows, columns=["participant", "position", "clip"]))


def studies_with(
    outcome: str, wanted: dict[tuple[str, str], Differences], *, people: int, studies: int
) -> Counter[str]:
    """Count for each LoD the studies in which it gets a verdict at any distance of ``wanted``."""
    plan = ablation(people)
    equal = named_truth("equal", plan.stimuli, DEFAULT)
    truth = changed(equal, "margin", best=dict.fromkeys(DISTANCES, BEST), wanted=wanted)
    rng = np.random.default_rng(20120831)
    prepared = prepare(plan, answers_of(plan, truth, rng), rng)
    found: Counter[str] = Counter()
    for number in range(studies):
        own = np.random.default_rng([11, number])
        effects = prepared.decide(answers_of(plan, truth, own), own, margins=DEFAULT).effects
        assert len(effects) == len(LODS) * len(DISTANCES)
        found.update(
            {v.lod for v in effects if v.outcome == outcome and (v.distance, v.lod) in wanted}
        )
    return found


def on(margin: Differences, distances: tuple[str, ...]) -> dict[tuple[str, str], Differences]:
    return {(distance, lod): margin for distance in distances for lod in LODS}


REALISM = Differences(DEFAULT.realism_points, 0.0)
NOTICED = Differences(0.0, DEFAULT.noticed_share)


RUNS = [
    (10, 250, "realism", DISTANCES),
    (10, 250, "noticed", DISTANCES),
    (10, 250, "realism", DISTANCES[:1]),
    (24, 250, "realism", DISTANCES),
    (24, 250, "noticed", DISTANCES),
    (24, 250, "noticed", DISTANCES[:1]),
]


@pytest.mark.parametrize(
    ("people", "studies", "margin", "distances"),
    [(24, 8, "realism", DISTANCES), *(pytest.param(*run, marks=LONG) for run in RUNS)],
)
def test_an_effect_on_its_margin_is_hardly_ever_called_dispensable(
    people: int, studies: int, margin: str, distances: tuple[str, ...]
) -> None:
    """At most one study in twenty says so of it at any distance where it is not true."""
    wanted = on({"realism": REALISM, "noticed": NOTICED}[margin], distances)
    found = studies_with(EQUIVALENT, wanted, people=people, studies=studies)
    print(people, margin, len(distances), {lod: found[lod] for lod in LODS}, "of", studies)
    assert max(found.values(), default=0) <= most(studies, 0.05) * studies, found


@LONG
@pytest.mark.parametrize("people", [10, 24])
def test_an_effect_on_both_margins_is_hardly_ever_called_different(people: int) -> None:
    """Either test may show it, at twice its p value, over all distances."""
    both = Differences(DEFAULT.realism_points, DEFAULT.noticed_share)
    found = studies_with(DIFFERENT, on(both, DISTANCES), people=people, studies=250)
    print(people, "different", {lod: found[lod] for lod in LODS}, "of 250")
    assert max(found.values(), default=0) <= most(250, 0.07) * 250, found
