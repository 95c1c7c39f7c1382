"""Studies repeated with new people, and every interval that the report prints of them.

Not a test: the tests beside it say what must hold.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.special import ndtri

sys.path.append(str(Path(__file__).parents[3]))

from analysis.correlation import rank_correlations
from analysis.curves.curve import MARGIN
from analysis.curves.noticed import noticed_curves
from analysis.curves.sizes import PIXELS
from analysis.decision.margins import DEFAULT
from analysis.estimates.preference import preference_of
from analysis.power.assumed import (
    Assumed,
    Differences,
    changed,
    named_truth,
    sensitivity_of,
)
from analysis.power.plan import Plan
from analysis.power.quick import Prepared, prepare
from analysis.power.replicates import answers_of
from analysis.power.tables import as_tables
from analysis.reliability.reliability import reliability
from analysis.simulation.observers import Stimulus
from analysis.simulation.population import POPULATION
from analysis.tables.columns import STANDARD_LODS

Intervals = dict[str, tuple[float, float]]
BEST = STANDARD_LODS[-1]
DISTANCES = ("macroscopic", "far")
MANY = 1500  # people whose estimates stand for the truth where it has no closed form


def everybody_sees_all(people: int, distances: tuple[str, ...] = DISTANCES) -> Plan:
    """Return a plan of ten clips per distance: each LoD beside the best both ways, and equal."""
    pairs = [(lod, BEST) for lod in STANDARD_LODS[:-1]]
    pairs += [(right, left) for left, right in pairs] + [(lod, lod) for lod in STANDARD_LODS]
    clips = {
        f"{distance}-{left}-{right}": Stimulus(distance, POPULATION.iris_px[distance], left, right)
        for distance in distances
        for left, right in pairs
    }
    rows = [
        (person, place + 1, clip) for person in range(people) for place, clip in enumerate(clips)
    ]
    return Plan(clips, pd.DataFrame(rows, columns=["participant", "position", "clip"]))


@dataclass(frozen=True)
class Setting:
    """People, truth and the models set up for them."""

    plan: Plan
    truth: Assumed
    prepared: Prepared


def truth_of(name: str, plan: Plan) -> Assumed:
    """Return a truth by its name; "last-on-margin" lets only the cheapest LoD be at the margin."""
    if name != "last-on-margin":
        return named_truth(name, plan.stimuli, DEFAULT)
    equal = named_truth("equal", plan.stimuli, DEFAULT)
    lost = Differences(DEFAULT.realism_points, 0.0)
    wanted = {(distance, STANDARD_LODS[0]): lost for distance in DISTANCES}
    return changed(equal, name, best=dict.fromkeys(DISTANCES, BEST), wanted=wanted)


def setting(people: int, truth: str) -> Setting:
    """Set up the repeated study."""
    plan = everybody_sees_all(people)
    known = truth_of(truth, plan)
    rng = np.random.default_rng(20120831)
    return Setting(plan, known, prepare(plan, answers_of(plan, known, rng), rng))


def model_intervals(own: Setting, rng: np.random.Generator) -> tuple[Intervals, dict[str, float]]:
    """Return 95 % intervals of losses and noticing in one study, and what they should hold."""
    answers = answers_of(own.plan, own.truth, rng)
    seen = np.ones(len(own.plan.person), dtype=bool)
    realism = own.prepared.realism_of(answers, seen, rng)
    noticing = own.prepared.noticing_of(answers, seen, rng)
    assert noticing is not None
    place = {cell: i for i, cell in enumerate(realism.cells)}
    rating = realism.expected()[1]
    yes, alarm, d = noticing.shares()[1], noticing.false_alarms()[1], noticing.sensitivity()[1]
    found: Intervals = {}
    true: dict[str, float] = {}
    for distance in DISTANCES:
        for lod in STANDARD_LODS[:-1]:
            name = f"{distance} {lod}"
            gap = rating[:, place[distance, BEST]] - rating[:, place[distance, lod]]
            pair = noticing.pairs.index((distance, lod, BEST))
            found[f"loss {name}"] = _quantiles(gap)
            found[f"excess {name}"] = _quantiles(yes[:, pair] - alarm)
            found[f"d' {name}"] = _quantiles(d[:, pair])
            true[f"loss {name}"] = own.truth.loss(distance, lod, best=BEST)
            true[f"excess {name}"] = own.truth.excess(distance, lod, best=BEST)
    return found, true


def table_intervals(own: Setting, rng: np.random.Generator) -> Intervals:
    """Return what is made from the tables: places in JOD, rank correlations, reliability."""
    tables = as_tables(own.plan, answers_of(own.plan, own.truth, rng))
    found: Intervals = {}
    preference = preference_of(tables.comparisons, tables.ratings, rng)
    assert preference is not None
    for row in preference.table().to_dict("records"):
        if np.isfinite(row["jod_low"]):
            found[f"JOD {row['distance']} {row['lod']}"] = (row["jod_low"], row["jod_high"])
    for row in rank_correlations(tables.ratings).to_dict("records"):
        for name, start in (("tau-b", "tau"), ("Somers' d", "d"), ("rmcorr", "rm")):
            found[f"{name} {row['distance']}"] = (row[f"{start}_low"], row[f"{start}_high"])
    for row in reliability(tables.ratings, rng).to_dict("records"):
        name = f"reliability {row['coefficient']}, {row['bias']}, {row['interval']}"
        found[name] = (row["low"], row["high"])
    return found


def table_truths(own: Setting) -> dict[str, float]:
    """Return what the same numbers come to with very many people."""
    rng = np.random.default_rng(1)
    many = everybody_sees_all(MANY)
    tables = as_tables(many, answers_of(many, own.truth, rng))
    true: dict[str, float] = {}
    preference = preference_of(tables.comparisons, tables.ratings, rng)
    assert preference is not None
    for row in preference.table().to_dict("records"):
        true[f"JOD {row['distance']} {row['lod']}"] = float(row["jod"])
    for row in rank_correlations(tables.ratings).to_dict("records"):
        for name, key in (("tau-b", "tau_b"), ("Somers' d", "somers_d"), ("rmcorr", "rmcorr")):
            true[f"{name} {row['distance']}"] = float(row[key])
    for row in reliability(tables.ratings, rng).to_dict("records"):
        # ICC(2,k) is (2,1) stepped up to however many rated all; others' means are noisier the
        # fewer the others are: neither has one truth.
        if "(2,k)" not in row["coefficient"] and "τ" not in row["coefficient"]:
            name = f"reliability {row['coefficient']}, {row['bias']}, {row['interval']}"
            true[name] = float(row["value"])
    return true


def threshold_intervals(
    people: int, rng: np.random.Generator
) -> tuple[Intervals, dict[str, float]]:
    """Return the sizes from which a quarter notice a LoD, in pixels, and the true ones."""
    plan = everybody_sees_all(people, tuple(POPULATION.iris_px))
    truth = named_truth("thesis", plan.stimuli, DEFAULT)
    compared = as_tables(plan, answers_of(plan, truth, rng)).comparisons
    found: Intervals = {}
    for curve in noticed_curves(compared, PIXELS, rng, best=BEST, margins=DEFAULT):
        for own in curve.thresholds:
            if own.name == MARGIN and curve.lod != "high":  # few ever notice it
                found[f"threshold {curve.lod}"] = (own.low, own.high)
    wanted = sensitivity_of(DEFAULT.noticed_share)
    true = {}
    for rank, lod in enumerate(STANDARD_LODS[:2], start=1):
        share = wanted / POPULATION.pair_sensitivity(rank, len(STANDARD_LODS))
        octave = POPULATION.half_sensitivity_log2_px
        octave += POPULATION.sensitivity_width_log2_px * float(ndtri(share))
        true[f"threshold {lod}"] = 2.0**octave
    return found, true


def held(found: list[Intervals], true: Mapping[str, float]) -> dict[str, list[bool]]:
    """Say of every interval whether it holds the truth, by name; those without one left out."""
    told: dict[str, list[bool]] = defaultdict(list)
    for own in found:
        for name, (low, high) in own.items():
            if name in true and np.isfinite(low):
                told[name].append(bool(low <= true[name] <= high))
    return told


def by_kind(told: Mapping[str, list[bool]]) -> dict[str, tuple[float, float, int]]:
    """Return for each kind of interval the share, its standard error over studies, and studies.

    Intervals of one study hang together: their mean per study is one observation.
    """
    kinds: dict[str, list[list[bool]]] = defaultdict(list)
    for name, own in told.items():
        kinds[_kind(name)].append(own)
    found = {}
    for kind, lists in kinds.items():
        count = min(map(len, lists))
        mean = np.array([own[:count] for own in lists], dtype=float).mean(axis=0)
        found[kind] = (float(mean.mean()), float(mean.std() / np.sqrt(count)), count)
    return found


def _kind(name: str) -> str:
    return name if name.startswith(("reliability", "Somers")) else name.split(maxsplit=1)[0]


def _quantiles(draws: np.ndarray) -> tuple[float, float]:
    low, high = np.quantile(draws, (0.025, 0.975))
    return float(low), float(high)
