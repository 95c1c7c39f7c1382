"""Simulated people whose truth is known: intervals hold it, and tests raise few false alarms.

Observers are those of ``analysis.simulation.observers``, whom the models describe only in part. The
bounds of short runs leave room for their own error: a share of 0.95 or 0.05 fails them once in a
thousand.
"""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from analysis.decision.margins import DEFAULT
from analysis.decision.verdicts import DIFFERENT, EQUIVALENT
from analysis.power.replicates import answers_of
from analysis.tables.columns import STANDARD_LODS

sys.path += [str(Path(__file__).parent), str(Path(__file__).parents[1])]
from chance import least, most
from repeated import (
    Intervals,
    Setting,
    by_kind,
    held,
    model_intervals,
    setting,
    table_intervals,
    table_truths,
    threshold_intervals,
)

LONG = pytest.mark.long
MODELS = ("loss", "excess")
TABLES = ("JOD", "tau-b", "Somers' d", "rmcorr", "reliability alpha", "reliability ICC(2,1)")


def repeat(own: Setting, studies: int) -> tuple[list[Intervals], dict[str, float]]:
    made = [model_intervals(own, np.random.default_rng([7, i])) for i in range(studies)]
    return [found for found, _ in made], made[0][1]


def shares(own: Setting, studies: int) -> Counter[tuple[str, str, str]]:
    fallen: Counter[tuple[str, str, str]] = Counter()
    for number in range(studies):
        rng = np.random.default_rng([8, number])
        answers = answers_of(own.plan, own.truth, rng)
        fallen.update(own.prepared.decide(answers, rng, margins=DEFAULT).verdicts())
    return fallen


@pytest.mark.parametrize(
    ("people", "studies"),
    [
        (24, 12),
        pytest.param(10, 300, marks=LONG),
        pytest.param(24, 300, marks=LONG),
        pytest.param(100, 100, marks=LONG),
    ],
)
def test_intervals_of_losses_and_noticing_hold_the_truth(people: int, studies: int) -> None:
    found, true = repeat(setting(people, "thesis"), studies)
    told = by_kind(held(found, true))
    for kind in MODELS:
        assert told[kind][0] >= least(studies, 0.93), told
    every = {name: np.mean(own) for name, own in held(found, true).items()}
    assert min(every.values()) >= least(studies, 0.89), every  # no cell far behind the others


@LONG
@pytest.mark.parametrize(("people", "studies"), [(10, 150), (24, 150), (100, 60)])
def test_intervals_made_from_the_tables_hold_the_truth(people: int, studies: int) -> None:
    own = setting(people, "thesis")
    found = [table_intervals(own, np.random.default_rng([9, i])) for i in range(studies)]
    told = by_kind(held(found, table_truths(own)))
    for kind in TABLES:
        own_kinds = [share for name, (share, _, _) in told.items() if name.startswith(kind)]
        assert min(own_kinds) >= least(studies, 0.92), told


@pytest.mark.parametrize(
    ("people", "studies"),
    [(24, 12), pytest.param(10, 200, marks=LONG), pytest.param(24, 200, marks=LONG)],
)
def test_where_lods_are_equal_hardly_anything_is_found(people: int, studies: int) -> None:
    own = setting(people, "equal")
    found, true = repeat(own, studies)
    assert max(map(abs, true.values())) < 1e-6
    alarms = {kind: 1 - share for kind, (share, _, _) in by_kind(held(found, true)).items()}
    for kind in MODELS:
        assert alarms[kind] <= most(studies, 0.07), alarms
    fallen = shares(own, studies)
    different = {cell: n for cell, n in fallen.items() if cell[2] == DIFFERENT}
    assert sum(different.values()) <= most(studies, 0.01) * studies, different


@LONG
@pytest.mark.parametrize(("people", "studies"), [(10, 150), (24, 150)])
def test_correlations_and_preference_find_nothing_where_lods_are_equal(
    people: int, studies: int
) -> None:
    own = setting(people, "equal")
    found = [table_intervals(own, np.random.default_rng([10, i])) for i in range(studies)]
    zero = {name: 0.0 for name in found[0] if not name.startswith("reliability")}
    alarms = {kind: 1 - share for kind, (share, _, _) in by_kind(held(found, zero)).items()}
    for kind, share in alarms.items():
        assert share <= most(studies, 0.07), (kind, alarms)


@LONG
@pytest.mark.parametrize(("people", "studies"), [(10, 100), (24, 100), (100, 40)])
def test_intervals_of_sizes_at_which_a_quarter_notice_hold_the_truth(
    people: int, studies: int
) -> None:
    made = [threshold_intervals(people, np.random.default_rng([5, i])) for i in range(studies)]
    told = held([found for found, _ in made], made[0][1])
    assert set(told) == {"threshold low", "threshold medium"}
    for own in told.values():
        assert np.mean(own) >= least(studies, 0.92), told


@pytest.mark.parametrize("truth", ["realism-margin", "noticed-margin", "last-on-margin"])
@pytest.mark.parametrize(
    ("people", "studies"),
    [(24, 15), pytest.param(10, 300, marks=LONG), pytest.param(24, 300, marks=LONG)],
)
def test_on_the_margin_enough_is_said_in_at_most_six_of_a_hundred(
    truth: str, people: int, studies: int
) -> None:
    fallen = shares(setting(people, truth), studies)
    at_margin = STANDARD_LODS[:1] if truth == "last-on-margin" else STANDARD_LODS
    fallen = Counter({cell: n for cell, n in fallen.items() if cell[1] in at_margin})
    said = {cell: n for cell, n in fallen.items() if cell[2] == EQUIVALENT}
    assert all(n <= most(studies, 0.06) * studies for n in said.values()), said
    different = {cell: n for cell, n in fallen.items() if cell[2] == DIFFERENT}
    assert all(n <= most(studies, 0.07) * studies for n in different.values()), different
