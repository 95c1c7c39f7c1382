"""Flags and weights: each spoiler gets its name, clean observers hardly ever any."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pandas as pd
import pytest

from analysis.screening.evidence import LEAST
from analysis.screening.flags import EXTREME, FALSE_ALARMS, STRAIGHT_LINER, flags_of
from analysis.screening.signals import COLUMNS, observer_signals
from analysis.screening.weights import observer_weights
from analysis.simulation.observers import Stimulus
from analysis.simulation.population import POPULATION
from analysis.simulation.simulated import simulate_tables
from analysis.simulation.spoilers import SPOILERS
from analysis.tables.reading import Tables, tables_from

LODS = ("low", "medium", "high", "ultra")


def clips(distances: tuple[str, ...]) -> dict[str, Stimulus]:
    pairs = [(lod, "ultra") for lod in LODS[:3]] + [("ultra", lod) for lod in LODS[:3]]
    pairs += [(lod, lod) for lod in LODS]
    return {
        f"{distance}-{left}-{right}": Stimulus(distance, POPULATION.iris_px[distance], left, right)
        for distance in distances
        for left, right in pairs
    }


def flagged(
    seed: int, shown: dict[str, Stimulus], kinds: dict[int, str], *, people: int = 30
) -> dict[str, tuple[str, ...]]:
    rng = np.random.default_rng(seed)
    frames = simulate_tables(shown, rng, participants=people, spoilers=kinds)
    return flags_of(observer_signals(tables_from(frames)))


def test_every_spoiler_gets_its_name() -> None:
    shown = clips(("macroscopic", "near", "medium", "far"))
    found = flagged(1, shown, dict(enumerate(SPOILERS)))
    assert {f"S{i:03}": (kind,) for i, kind in enumerate(SPOILERS, start=1)} == found


@pytest.mark.parametrize(
    ("distances", "least", "seeds"),
    [
        (("macroscopic", "far"), 0.8, 5),
        pytest.param(("macroscopic", "far"), 0.95, 40, marks=pytest.mark.long),
        pytest.param(None, 1.0, 40, marks=pytest.mark.long),
    ],
)
def test_spoilers_are_named_and_clean_people_are_not_over_many_studies(
    distances: tuple[str, ...] | None, least: float, seeds: int
) -> None:
    shown = clips(distances or tuple(POPULATION.iris_px))
    kinds = dict(enumerate(SPOILERS))
    hits: Counter[str] = Counter()
    clean = 0
    for seed in range(seeds):
        found = flagged(seed, shown, kinds)
        for i, kind in kinds.items():
            hits[kind] += kind in found.pop(f"S{i + 1:03}", ())
        clean += len(found)
    assert all(hits[kind] >= least * seeds for kind in SPOILERS), hits  # shufflers are the hardest
    assert clean <= 0.01 * 25 * seeds, clean
    print(f"named {dict(hits)} of {seeds}; clean people flagged {clean} of {25 * seeds}")


def test_few_clean_people_are_flagged_in_the_thesiss_study(
    thesis_clips: dict[str, Stimulus],
) -> None:
    found = [flagged(seed, thesis_clips, {}, people=10) for seed in range(8)]
    assert sum(map(len, found)) <= 2  # of 80


def frame(rows: list[tuple[object, ...]], *names: str) -> pd.DataFrame:
    return pd.DataFrame(rows, columns=list(names))


def tables(ratings: dict[str, list[int]], comparisons: pd.DataFrame | None = None) -> Tables:
    rows = [
        (who, LODS[i % 4], "near", rating)
        for who, given in ratings.items()
        for i, rating in enumerate(given)
    ]
    frames = {"ratings": frame(rows, "participant", "lod", "distance", "rating")}
    return tables_from(frames | ({} if comparisons is None else {"comparisons": comparisons}))


def test_signals_say_what_they_count() -> None:
    compared = frame(
        [
            ("A", "near", "low", "ultra", -1, "yes"),
            ("A", "near", "ultra", "low", -1, "yes"),
            ("A", "near", "low", "high", 0, "no"),
            ("A", "near", "low", "low", None, "yes"),
        ],
        *("participant", "distance", "left_lod", "right_lod", "comparison", "noticed"),
    )
    row = observer_signals(tables({"A": [1, 2, 5, 5], "B": [1, 3, 4, 5]}, compared)).iloc[0]
    assert tuple(row.index) == COLUMNS
    assert row["same_share"] == 0.5
    assert row["ends_share"] == 0.75
    assert (row["side"], row["compared"], row["against"]) == ("left", 3, 2)
    assert row["side_share"] == pytest.approx(2 / 3)
    assert row["against_share"] == pytest.approx(1 / 2)
    assert (row["catch_pairs"], row["false_alarms"]) == (1, 1.0)
    assert pd.isna(row["certified_share"])


def test_a_few_ratings_alike_are_no_flag_and_many_are() -> None:
    assert flags_of(observer_signals(tables({"A": [3] * 5, "B": [1, 2, 3, 4]}))) == {}
    found = flags_of(observer_signals(tables({"A": [3] * 8, "B": [1, 5] * 4, "C": [1, 2, 3, 4]})))
    assert found == {"A": (STRAIGHT_LINER,), "B": (EXTREME,)}


def test_false_alarms_are_named_and_cost_no_weight() -> None:
    rows = [("A", "near", "low", "low", "yes")] * 6 + [("B", "near", "low", "low", "no")] * 6
    names = ("participant", "distance", "left_lod", "right_lod", "noticed")
    table = frame(rows, *names).assign(trial=[str(i) for i in range(12)])
    signals = observer_signals(tables({"A": [1, 2, 3, 4], "B": [1, 2, 3, 4]}, table))
    assert flags_of(signals) == {"A": (FALSE_ALARMS,)}
    assert observer_weights(signals) == {}


def test_weights_fall_with_inconsistency_and_with_flags_but_never_to_zero() -> None:
    signals = observer_signals(
        tables({f"P{i}": [1, 2, 4, 5, 1, 2, 4, 4] for i in range(6)} | {"X": [3] * 8})
    )
    signals["inconsistency"] = [0.5, 0.5, 0.5, 0.5, 0.5, 0.9, 0.4]
    weights = observer_weights(signals)
    assert weights == {"P5": pytest.approx((0.75 / 0.9) ** 2), "X": LEAST}


@pytest.mark.parametrize("given", [{}, {"A": [3]}, {"A": [3, 3, 3, 3]}])
def test_hardly_any_data_raise_no_flag(given: dict[str, list[int]]) -> None:
    signals = observer_signals(tables(given))
    assert len(signals) == len(given)
    assert flags_of(signals) == {}
    assert observer_weights(signals) == {}
