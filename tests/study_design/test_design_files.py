"""Pictures that a study file names: found beside it, known by their contents, refused in words."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from study.design.definition import StudyDefinition, parse_definition, read_definition
from study.design.faults import DefinitionError
from study.design.files import find_files

Written = Callable[[Path, dict[str, Any]], StudyDefinition]


@pytest.fixture
def written(thesis_with: Callable[[str, str], str]) -> Written:
    """What reads the thesis's study with another [scene] from a file in a folder."""

    def read(folder: Path, scene: dict[str, Any]) -> StudyDefinition:
        folder.mkdir(exist_ok=True)
        keys = "\n".join(f"{key} = {json.dumps(value)}" for key, value in scene.items())
        (folder / "study.toml").write_text(thesis_with("scene", keys), encoding="utf-8")
        return read_definition(folder / "study.toml")

    return read


def test_a_picture_lies_beside_the_study_file_and_names_the_clips(
    written: Written, tmp_path: Path
) -> None:
    for name, contents in (("a", b"one"), ("b", b"one"), ("c", b"two")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "lobby.exr").write_bytes(contents)
    a, b, c = (
        written(tmp_path / name, {"environment": "lobby.exr", "environment_turn_deg": 30.0})
        for name in "abc"
    )
    first = a.wanted_specs()[0].spec
    assert first.environment == "image"
    assert first.environment_file == str(tmp_path / "a" / "lobby.exr")
    assert first.environment_sha256 == hashlib.sha256(b"one").hexdigest()
    assert first.environment_turn_deg == 30.0
    assert first.clip_id == b.wanted_specs()[0].spec.clip_id != c.wanted_specs()[0].spec.clip_id
    assert a.definition_hash == b.definition_hash != c.definition_hash


def test_a_definition_with_a_picture_survives_the_way_through_json(
    written: Written, tmp_path: Path
) -> None:
    (tmp_path / "lobby.hdr").write_bytes(b"x")
    definition = written(tmp_path, {"environment": "lobby.hdr"})
    assert parse_definition(json.loads(definition.to_json())) == definition


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        ({"environment": "none.exr"}, "scene.environment: {}/none.exr: No such file or directory"),
        (
            {"environment": "lobby"},
            'scene.environment: unknown environment "lobby"; write "park", or the path',
        ),
        (
            {"environment": "lobby.exr", "sun_azimuth_deg": 3.0},
            "scene.sun_azimuth_deg: lobby.exr brings its own sun; leave this out",
        ),
        ({"environment": "image"}, "environment_file: empty"),
        (
            {"environment": "lobby.exr", "environment_turn_deg": 400.0},
            "scene.environment_turn_deg: 400.0 lies outside -180.0 to 180.0",
        ),
        ({"environment_sha256": "0"}, 'environment_sha256: only an environment "image" has one'),
    ],
)
def test_faults_of_pictures_stand_with_their_place(
    written: Written, tmp_path: Path, scene: dict[str, Any], words: str
) -> None:
    (tmp_path / "lobby.exr").write_bytes(b"x")
    with pytest.raises(DefinitionError) as caught:
        written(tmp_path, scene)
    assert words.format(tmp_path) in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


def test_a_study_without_pictures_stays_as_it_is(tmp_path: Path) -> None:
    data = {"key": "x", "scene": {"environment": "park", "crowd": 0}}
    assert find_files(data, tmp_path) == (data, [])
    assert find_files({"key": "x", "scene": 3}, tmp_path) == ({"key": "x", "scene": 3}, [])
