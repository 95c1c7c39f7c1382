"""A study file becomes a definition, and the definition the clips of the thesis."""

from __future__ import annotations

import json
from importlib.resources import files
from itertools import product
from pathlib import Path
from typing import Any

import pytest

from renderer.detail import EFFECTS, STANDARD_LODS, Detail
from study.design.definition import (
    StudyDefinition,
    built_in_names,
    parse_definition,
    read_definition,
)
from study.design.faults import DefinitionError
from study.design.parts import Size
from study.site.consent_words import consent_words
from study.texts import catalogue


@pytest.fixture(scope="module")
def thesis() -> StudyDefinition:
    return read_definition("thesis")


def test_thesis_has_the_seven_clips_of_table_5_2(thesis: StudyDefinition) -> None:
    shown = [(clip.id, clip.distance, clip.left, clip.right) for clip in thesis.clips]
    assert shown == [
        ("1", "macroscopic", "medium", "low"),
        ("2", "macroscopic", "high", "ultra"),
        ("3", "macroscopic", "high", "medium"),
        ("4", "near", "low", "ultra"),
        ("5", "near", "low", "medium"),
        ("6", "near", "ultra", "low"),
        ("7", "far", "ultra", "low"),
    ]


def test_thesis_lods_are_the_columns_of_table_5_1(thesis: StudyDefinition) -> None:
    assert {name: thesis.detail(name) for name in thesis.lods} == {
        name: Detail.uniform(name) for name in STANDARD_LODS
    }


def test_thesis_asks_appendix_b_and_every_question_is_optional(thesis: StudyDefinition) -> None:
    assert [question.id for question in thesis.questions] == [
        *("comparison", "noticed", "what_differed", "rating_left", "rating_right", "comments")
    ]
    assert not any(question.is_required for question in (*thesis.questions, *thesis.about))
    assert [question.id for question in thesis.about] == [
        *("works_with_graphics", "last_played", "age", "gender", "eyesight")
    ]


def test_thesis_consent_speaks_of_what_people_must_know(thesis: StudyDefinition) -> None:
    words = consent_words(thesis, catalogue("en"))
    text = " ".join((words.motion_warning, *(t for _, t in words.paragraphs), *words.withdrawal))
    needed = ("voluntary", "dizzy", "ten minutes", "store your answers", "withdraw", "erased")
    needed += ("Copies made for safety", "archives that others have taken away")
    assert [word for word in needed if word not in text] == []
    assert "eight short clips" in text
    assert len(thesis.every_clip) == 8
    assert words.statements[0] == "I am at least 18 years old."
    assert "we ask you separately" in words.health


def test_lod_starts_refraction_at_medium_and_asks_question_1_neutrally() -> None:
    lod = read_definition("lod")
    assert lod.detail("medium").refraction == "high"
    assert lod.detail("medium").with_levels(refraction="medium") == Detail.uniform("medium")
    comparison = next(q for q in lod.questions if q.id == "comparison")
    assert comparison.kind == "choice"
    assert [option.value for option in comparison.options] == [-1, 0, 1]
    assert len(lod.trial_clips) == 4 * 3 * 2 * 4 + 16
    assert sum(clip.is_catch for clip in lod.trial_clips) == 16
    assert {clip.iris for clip in lod.trial_clips} == set(lod.irises)


def test_ablation_leaves_each_effect_out_of_ultra_at_each_distance() -> None:
    ablation = read_definition("ablation")
    shown = {
        (clip.distance, effect)
        for clip in ablation.trial_clips
        for lod in {clip.left, clip.right} - {"ultra"}
        for effect, level in ablation.detail(lod).levels().items()
        if level == "off"
    }
    assert shown == set(product(ablation.distances, EFFECTS))
    for effect in EFFECTS:
        assert ablation.detail(f"no-{effect}") == Detail.uniform("ultra").with_levels(
            **{effect: "off"}
        )


def test_built_in_studies_are_sound_and_found_by_name() -> None:
    assert built_in_names() == ["ablation", "approach", "lod", "thesis"]
    assert [read_definition(name).key for name in built_in_names()] == built_in_names()


def test_rendering_order_lets_people_start_after_one_direction_of_one_size(
    thesis: StudyDefinition,
) -> None:
    wanted = thesis.wanted_specs()
    first, second = wanted[:8], wanted[8:16]
    assert [w.clip.id for w in first] == ["practice", *"1234567"]
    assert {(str(w.size), w.orbit_direction) for w in first} == {("1280x720", "rightward")}
    assert {(str(w.size), w.orbit_direction) for w in second} == {("1280x720", "leftward")}
    assert {str(w.size) for w in wanted[16:]} == {"1920x1080"}
    assert len({w.spec.clip_id for w in wanted}) == len(wanted) == 32


def test_rendering_order_brings_block_after_block_with_directions_in_turn() -> None:
    lod = read_definition("lod")
    wanted = lod.wanted_specs()
    around = {clip.id for clip in (*lod.practice, *lod.gold)}
    for number, direction in enumerate(("rightward", "leftward", "rightward")):
        part = wanted[24 * number : 24 * number + 24] if number < 2 else wanted[48:68]
        assert {w.orbit_direction for w in part} == {direction}
        assert {w.clip.id for w in part} - around == {clip.id for clip in lod.blocks[number]}
    names = [(w.clip.id, w.size, w.orbit_direction) for w in wanted]
    assert len(set(names)) == len(names) == 4 * len(lod.every_clip)


def test_a_clip_spec_carries_what_the_file_says(raw: dict[str, Any]) -> None:
    raw["eye"] = {"iris_seed": 7, "iris_colour": "green", "pupil_mm": 3.0}
    raw["scene"] = {"sun_azimuth_deg": 10.0, "crowd": 0}
    raw["preset"] = "calibrated"
    definition = parse_definition(raw)
    size = Size(width=640, height=360)
    spec = definition.clip_spec(definition.clips[0], size=size, orbit_direction="leftward")
    assert (spec.left, spec.right) == (Detail.uniform("low"), Detail.uniform("ultra"))
    assert (spec.width, spec.height, spec.orbit_direction) == (640, 360, "leftward")
    assert (spec.iris_seed, spec.iris_colour, spec.pupil_mm) == (7, "green", 3.0)
    assert (spec.sun_azimuth_deg, spec.crowd, spec.preset) == (10.0, 0, "calibrated")
    assert spec.frame_count == 10


def test_a_lod_may_start_from_another(raw: dict[str, Any]) -> None:
    detail = parse_definition(raw).detail("no-caustics")
    assert detail == Detail.uniform("ultra").with_levels(caustics="off")
    assert set(detail.levels()) == set(EFFECTS)


def test_a_definition_survives_json(raw: dict[str, Any]) -> None:
    definition = parse_definition(raw)
    again = parse_definition(json.loads(definition.to_json()))
    assert again == definition
    assert again.definition_hash == definition.definition_hash
    assert list(again.lods) == ["low", "ultra", "no-caustics"]


def test_the_hash_follows_contents_and_not_the_order_of_keys(raw: dict[str, Any]) -> None:
    definition = parse_definition(raw)
    shuffled = parse_definition(dict(reversed(raw.items())))
    changed = parse_definition({**raw, "title": "Another title"})
    assert shuffled.definition_hash == definition.definition_hash
    assert changed.definition_hash != definition.definition_hash


def test_a_definition_cannot_be_changed(raw: dict[str, Any]) -> None:
    definition = parse_definition(raw)
    with pytest.raises(ValueError, match="frozen"):
        definition.__setattr__("title", "Another")


def test_a_file_is_read_by_its_path(tmp_path: Path) -> None:
    thesis_file = Path(read_definition.__code__.co_filename).parent / "definitions" / "thesis.toml"
    copy = tmp_path / "mine.toml"
    words = thesis_file.with_name("thesis.ar.toml").read_text(encoding="utf-8")
    (tmp_path / "mine.ar.toml").write_text(words, encoding="utf-8")
    copy.write_text(thesis_file.read_text(encoding="utf-8").replace('key = "thesis"', 'key = "m"'))
    assert read_definition(copy).key == "m"


def test_a_missing_file_names_the_built_in_studies() -> None:
    with pytest.raises(DefinitionError) as caught:
        read_definition("thesys")
    assert str(caught.value) == (
        "thesys: cannot be read (No such file or directory); give the path of a TOML file or a "
        'built-in study: ablation, approach, lod, thesis; did you mean "thesis"?'
    )


def test_a_file_that_is_no_toml_says_where(tmp_path: Path) -> None:
    file = tmp_path / "bad.toml"
    file.write_text("key = \n")
    with pytest.raises(DefinitionError, match=r"^bad\.toml: not a TOML file: .*line 1"):
        read_definition(file)


def test_a_file_that_is_no_text_says_so(tmp_path: Path) -> None:
    file = tmp_path / "bad.toml"
    file.write_bytes(b"\xff\xfe")
    with pytest.raises(DefinitionError, match=r"^bad\.toml: not UTF-8 text"):
        read_definition(file)


def test_a_byte_order_mark_is_no_fault(tmp_path: Path) -> None:
    study = tmp_path / "study.toml"
    folder = Path(str(files("study.design"))) / "definitions"
    for name in ("thesis", "thesis.ar"):
        text = (folder / f"{name}.toml").read_text(encoding="utf-8")
        target = study if name == "thesis" else study.with_name("study.ar.toml")
        target.write_text(text, encoding="utf-8-sig")
    assert read_definition(study).definition_hash == read_definition("thesis").definition_hash


def test_the_cubes_size_reaches_the_clips_and_leaves_old_definitions_their_hash(
    raw: dict[str, Any],
) -> None:
    before = parse_definition(raw).definition_hash
    raw["eye"] = {**raw.get("eye", {}), "cube_size": "table"}
    assert parse_definition(raw).definition_hash == before
    raw["eye"]["cube_size"] = "auto"
    automatic = parse_definition(raw)
    assert automatic.definition_hash != before
    assert {wanted.spec.cube_size for wanted in automatic.wanted_specs()} == {"auto"}
    raw["eye"]["cube_size"] = "tiny"
    with pytest.raises(DefinitionError, match=r'eye\.cube_size: .*"tiny"'):
        parse_definition(raw)
