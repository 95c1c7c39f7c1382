"""``ocularist check``: what so many people would see, and one participant's trials again."""

from __future__ import annotations

import re
from importlib import resources
from pathlib import Path

import pytest

from study.cli import main


def said(capsys: pytest.CaptureFixture[str], *arguments: str) -> list[str]:
    assert main(["check", *arguments]) == 0
    return capsys.readouterr().out.splitlines()


def test_check_tells_files_exposures_and_minutes(capsys: pytest.CaptureFixture[str]) -> None:
    lines = said(capsys, "lod", "--people", "10", "24", "48")
    assert lines[1] == (
        "112 clips and 3 for practice and 1 gold, in 1280x720 and 1920x1080, rightward and "
        "leftward: 452 files, 2320 s of video"
    )
    assert lines[2] == "The first participant can start when 24 of them are there"
    exposures = [" ".join(line.split()) for line in lines]
    assert "people 10 24 48" in exposures
    assert "each pairing with each iris 1 to 2 4 8" in exposures
    (visit,) = [line for line in exposures if line.startswith("- One visit has 24 clips")]
    assert "and takes about 14." in visit


def test_check_says_where_attention_questions_stand(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert said(capsys, "lod")[4] == "Attention questions: attention after trial 6"
    study = tmp_path / "study.toml"
    text = (resources.files("study.design") / "definitions" / "lod.toml").read_text()
    text = text.replace("after = 6\nexpected", "within = 15\nexpected")
    study.write_text(re.sub(r"(?m)^translations = .*$", "", text))
    assert said(capsys, str(study))[4] == "Attention questions: attention within trial 15"


def test_irises_of_one_pairing_share_a_line(capsys: pytest.CaptureFixture[str]) -> None:
    lines = said(capsys, "lod")
    (line,) = [line for line in lines if line.startswith("near-low-ultra ")]
    assert line.split(maxsplit=4)[1:] == ["near", "low", "ultra", "blue, green, brown, dark-brown"]
    (gold,) = [line for line in lines if line.startswith("gold ")]
    assert gold.endswith("bare              green (gold)")


def test_check_tells_one_participants_trials_again(capsys: pytest.CaptureFixture[str]) -> None:
    lines = said(capsys, "lod", "--order", "3/17/123456")
    assert len(lines) == 24
    assert lines[0].split() == ["practice", "1", "macroscopic", "low", "ultra", "practice-1"]
    assert [line.split()[0] for line in lines[3:6]] == ["warm-up", "warm-up", "trial"]
    assert lines[16].split() == ["trial", "14", "macroscopic", "ultra", "bare", "gold"]


def test_a_code_of_another_study_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "thesis", "--order", "3/17/123456"]) == 1
    told = 'ocularist check: "3/17/123456": block 3; thesis has no blocks: write 0\n'
    assert capsys.readouterr().err == told
