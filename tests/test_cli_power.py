"""``ocularist power``: what it prints, and what it refuses in one line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from analysis.decision.margins import DEFAULT
from analysis.power.assumed import named_truth
from analysis.power.quick import prepare
from analysis.power.replicates import answers_of
from study.cli import main
from study.design.definition import read_definition
from study.planning import plans_of


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    try:
        status = main(["power", *arguments])
    except SystemExit as error:
        status = int(str(error.code))
    assert status != 0
    return capsys.readouterr().err


def test_power_of_the_recommended_study(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    own = ["--participants", "12,6", "--replicates", "3", "--jobs", "1", "--out", str(tmp_path)]
    assert main(["power", "lod", *own, "--noticed-margin", "0.3"]) == 0
    told = capsys.readouterr()
    assert told.err.splitlines()[-1] == "Simulating: 3 of 3 studies"  # without a terminal
    lines = told.out.splitlines()
    assert "More people can be tried: --participants 24,48" in lines
    assert lines[0].startswith("lod: 3 simulated studies of each number of people")
    head = next(line for line in lines if line.startswith("distance"))
    assert head.split()[-4:] == ["6", "people", "12", "people"]
    assert sum(line.startswith("macroscopic") for line in lines) >= 4
    assert any(line.startswith("SIMULATED people, 3 studies; brackets hold") for line in lines)
    written = json.loads((tmp_path / "power.json").read_text(encoding="utf-8"))
    assert written["participants"] == [6, 12]
    assert (written["study"], written["truth"]) == ("lod", "thesis")
    assert written["noticed_margin"] == 0.3
    assert written["margins"] == "noticed margin set at analysis"


def test_the_thesiss_design_cannot_conclude_equivalence(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    own = ["--participants", "10", "--replicates", "2", "--jobs", "1", "--out", str(tmp_path)]
    assert main(["power", "thesis", *own]) == 0
    text = " ".join(capsys.readouterr().out.split())
    assert "More people can be tried" not in text  # which would not help
    assert "Cannot be concluded, however many take part: equivalence of low at macroscopic" in text
    assert "high at near, low at medium, medium at medium, high at medium, ultra at medium" in text
    assert "macroscopic, near and far: no LoD can be named as the cheapest" in text


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--participants", "10,x"), '"10,x": write whole numbers from 2 to 5000, like 10,20,40'),
        (("--participants", "1"), '"1": write whole numbers from 2 to 5000'),
        (("--dropout", "1.5"), '"1.5" is no share; write a number from 0 to below 1, like 0.1'),
        (("--truth", "flat"), 'truth: "flat"; accepted: thesis, equal, realism-margin'),
        (("--truth", "nowhere.toml"), "nowhere.toml: No such file or directory"),
        (("--realism-margin", "0"), "realism_margin: found 0; accepted: above 0"),
        (("--replicates", "0"), '"0" is no count; write a whole number, 1 or more'),
    ],
)
def test_bad_input_is_one_clear_line(
    capsys: pytest.CaptureFixture[str], arguments: tuple[str, ...], told: str
) -> None:
    text = refused(capsys, "lod", *arguments)
    assert told in text
    assert text.count("\n") == 1


def test_small_losses_of_an_ablation_keep_their_sign() -> None:
    """A LoD that looks a little worse rates like one that lends its partner a little: told apart.

    The climb from no differences at all ended at a contrast of -1, every loss turned round, with a
    log-likelihood 12 below that of the right place.
    """
    (plan,) = plans_of(read_definition("ablation"), 160, seed=1, count=1)
    truth, rng = named_truth("thesis", plan.stimuli, DEFAULT), np.random.default_rng(1)
    realism = prepare(plan, answers_of(plan, truth, rng), rng).realism
    assert abs(realism.fit.value("contrast")) < 0.5
    rating = dict(zip(realism.cells, realism.expected()[0], strict=True))
    lost = [
        rating["macroscopic", "ultra"] - own
        for (distance, lod), own in rating.items()
        if distance == "macroscopic" and lod != "ultra"
    ]
    assert np.mean(lost) == pytest.approx(
        truth.loss("macroscopic", "no-texture", best="ultra"), abs=0.2
    )
