"""Crowds from the command line and from study files."""

from __future__ import annotations

from pathlib import Path

import pytest

from renderer.clip_values import CROWDS
from renderer.detail import Detail
from renderer.lod.choice import LodPolicy, LodStep
from renderer.lod.policy import Evidence, PolicyFile, default_policy, write_policy
from study.cli import build_parser, main
from study.commands.eye_options import spec_of
from study.design.definition import read_definition


@pytest.mark.parametrize("crowd", CROWDS)
def test_a_still_may_have_any_crowd(crowd: int) -> None:
    options = build_parser().parse_args(["still", "--crowd", str(crowd)])
    assert spec_of(options).crowd == crowd


def test_the_crowds_view_has_thirty_people_unless_told_otherwise(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []
    monkeypatch.setattr(
        "renderer.still.write_still", lambda _path, spec, **more: asked.append((spec.crowd, more))
    )
    out = str(tmp_path / "group.png")
    assert main(["still", "--view", "crowd", "--out", out]) == 0
    assert main(["still", "--view", "crowd", "--crowd", "10", "--azimuth", "15", "--out", out]) == 0
    assert main(["still", "--out", out]) == 0
    assert [(crowd, more["view"]) for crowd, more in asked] == [
        (30, "crowd"),
        (10, "crowd"),
        (5, "face"),
    ]
    assert asked[1][1]["azimuth_deg"] == 15.0


@pytest.mark.parametrize(
    ("extra", "message"),
    [
        (("--crowd", "0"), "--crowd 0: the crowd's view needs people; choose 5, 10 or 30"),
        (("--wireframe",), "--wireframe: only the main character's eyes; leave out --view crowd"),
        (
            ("--switching", "blended"),
            "--switching: only the main character's eyes; leave out --view crowd",
        ),
        (("--lod-policy", "none.json"), "--lod-policy: none.json: No such file or directory"),
    ],
)
def test_what_the_crowds_view_cannot_have_is_one_clear_line(
    extra: tuple[str, ...], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["still", "--view", "crowd", *extra]) == 1
    assert capsys.readouterr().err.strip() == f"ocularist still: {message}"


def test_the_crowds_eyes_switch_where_a_policy_file_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []
    monkeypatch.setattr("renderer.still.write_still", lambda *_, policy, **__: asked.append(policy))
    step = LodStep("high", Detail.uniform("high"), None)
    own = LodPolicy((step,))
    path = tmp_path / "policy.json"
    write_policy(PolicyFile(own, (Evidence(),), "by hand"), path)
    out = ["--out", str(tmp_path / "group.png")]
    assert main(["still", "--view", "crowd", "--lod-policy", str(path), *out]) == 0
    assert main(["still", "--view", "crowd", *out]) == 0
    assert asked == [own, default_policy()]


def test_a_study_file_names_its_crowd(thesis_text: str, tmp_path: Path) -> None:
    study = tmp_path / "thesis.toml"
    study.write_text(thesis_text.replace("crowd = 5", "crowd = 30"), encoding="utf-8")
    assert read_definition(study).scene.crowd == 30
    study.write_text(thesis_text.replace("crowd = 5", "crowd = 7"), encoding="utf-8")
    with pytest.raises(ValueError, match='crowd: unknown value "7"; choose one of 0, 5, 10, 30'):
        read_definition(study)
