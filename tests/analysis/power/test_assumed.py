"""What observers are assumed to see, and the right verdict on it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from analysis.decision.margins import Margins
from analysis.power.assumed import (
    Differences,
    best_lods,
    changed,
    excess_of,
    named_truth,
    sensitivity_of,
    thesis_like,
)
from analysis.power.crowd import answer_all, draw_crowd
from analysis.power.truth_file import read_truth
from analysis.simulation.observers import Stimulus

CLIPS = (
    Stimulus("near", 160.0, "low", "ultra"),
    Stimulus("near", 160.0, "medium", "ultra"),
    Stimulus("near", 160.0, "low", "medium"),
    Stimulus("far", 12.0, "ultra", "low"),
)
MARGINS = Margins()


def test_the_thesis_like_truth_has_the_populations_means() -> None:
    truth = thesis_like(CLIPS)
    assert truth.loss("near", "low", best="ultra") == pytest.approx(1.3, abs=1e-6)
    assert truth.loss("far", "low", best="ultra") == pytest.approx(0.25, abs=1e-6)
    assert truth.excess("far", "low", best="ultra") < 0.01
    verdicts = [truth.verdict(d, "low", best="ultra", margins=MARGINS) for d in ("near", "far")]
    assert verdicts == ["different", "equivalent"]


def test_named_truths_stand_where_they_say() -> None:
    equal = named_truth("equal", CLIPS, MARGINS)
    assert equal.loss("near", "low", best="ultra") == pytest.approx(0.0, abs=1e-6)
    assert equal.excess("near", "medium", best="ultra") == pytest.approx(0.0, abs=1e-6)
    edge = named_truth("realism-margin", CLIPS, MARGINS)
    assert edge.loss("near", "low", best="ultra") == pytest.approx(0.5, abs=1e-6)
    assert edge.verdict("near", "low", best="ultra", margins=MARGINS) == ""
    seen = named_truth("noticed-margin", CLIPS, MARGINS)
    assert seen.excess("far", "low", best="ultra") == pytest.approx(0.25, abs=1e-6)
    with pytest.raises(ValueError, match='truth: "flat"; accepted: thesis, equal, realism-margin'):
        named_truth("flat", CLIPS, MARGINS)


def test_the_share_that_notice_is_that_of_simulated_people() -> None:
    d, rng = sensitivity_of(0.4), np.random.default_rng(3)
    assert excess_of(d) == pytest.approx(0.4, abs=1e-9)
    people = 40_000
    each = np.repeat(np.arange(people), 2)
    noticed = answer_all(
        draw_crowd(rng, people),
        rng,
        person=each,
        position=np.ones_like(each),
        left=np.zeros(len(each)),
        right=np.zeros(len(each)),
        sensitivity=np.tile([d, 0.0], people),
    ).noticed.reshape(-1, 2)
    yes = [(column[column >= 0] == 2).mean() for column in noticed.T]
    assert yes[0] - yes[1] == pytest.approx(0.4, abs=0.012)


def test_a_sequence_names_the_best() -> None:
    assert best_lods(CLIPS, MARGINS) == {"near": "ultra", "far": "ultra"}
    turned = Margins(sequence=("medium", "ultra"))
    assert best_lods(CLIPS, turned) == {"near": "medium", "far": "ultra"}


def test_one_cell_changes_alone() -> None:
    base = thesis_like(CLIPS)
    new = changed(
        base, "mine", best={"near": "ultra"}, wanted={("near", "low"): Differences(0.2, None)}
    )
    assert new.loss("near", "low", best="ultra") == pytest.approx(0.2, abs=1e-6)
    assert new.excess("near", "low", best="ultra") == base.excess("near", "low", best="ultra")
    assert new.realism["near", "medium"] == base.realism["near", "medium"]


def test_a_truth_file_is_read(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('base = "equal"\n[near]\nlow = { loss = 0.3, noticed = 0.1 }\n')
    truth = read_truth(path, CLIPS, MARGINS)
    assert truth.name == "mine.toml"
    assert truth.loss("near", "low", best="ultra") == pytest.approx(0.3, abs=1e-6)
    assert truth.excess("near", "low", best="ultra") == pytest.approx(0.1, abs=1e-6)
    assert truth.loss("far", "low", best="ultra") == pytest.approx(0.0, abs=1e-6)


def test_all_faults_of_a_truth_file_are_told(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(
        'base = "flat"\n[nera]\nlow = { loss = 1.0 }\n[near]\nhihg = { loss = 1.0 }\n'
        'low = { loss = "much", noticde = 0.1 }\nmedium = { noticed = 1.5 }\n'
    )
    with pytest.raises(ValueError, match=r"mine\.toml: base: ") as told:
        read_truth(path, CLIPS, MARGINS)
    assert str(told.value).splitlines() == [
        "mine.toml: base: found 'flat'; accepted: thesis or equal",
        "mine.toml: nera: found {'low': {'loss': 1.0}}; accepted: a table named near, far",
        "mine.toml: near.hihg: found {'loss': 1.0}; accepted: one of low, medium, with what is "
        "assumed",
        "mine.toml: near.low.loss: found 'much'; accepted: -2 to 4, points below the best LoD",
        "mine.toml: near.low.noticde: found 0.1; accepted: the keys loss and noticed",
        "mine.toml: near.medium.noticed: found 1.5; accepted: 0 to 0.9, share of people beyond "
        "false alarms",
    ]


def test_a_truth_file_that_is_no_toml_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("loss = = 1")
    with pytest.raises(ValueError, match=r"mine\.toml: no TOML: "):
        read_truth(path, CLIPS, MARGINS)
