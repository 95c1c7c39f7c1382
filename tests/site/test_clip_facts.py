"""What a clip's page says about eyes that keep their LoD and eyes that switch."""

from __future__ import annotations

from study.design.definition import read_definition
from study.design.parts import read_size
from study.site.gallery import facts_of, levels_of


def test_an_eye_that_switches_has_its_levels_by_size_and_the_policy_in_words() -> None:
    study = read_definition("approach")
    clip = study.clip("approach-near-blended-ultra")
    spec = study.clip_spec(clip, size=read_size("1280x720"), orbit_direction="rightward")
    assert ("reflection", "by size", "ultra") in levels_of(spec)
    facts = dict(facts_of(spec))
    assert facts["lod_policy"] == "low up to 14 px, medium up to 48 px, high up to 200 px, ultra"
    assert facts["left_switching"] == "blended"


def test_an_eye_that_keeps_its_lod_has_its_levels() -> None:
    study = read_definition("thesis")
    spec = study.clip_spec(study.clip("1"), size=read_size("1280x720"), orbit_direction="rightward")
    assert ("texture", "medium", "low") in levels_of(spec)
    assert "lod_policy" not in dict(facts_of(spec))
