"""The table of seven effects by five levels."""

from __future__ import annotations

import pytest

from renderer.detail import EFFECTS, LEVELS, TABLE, Detail, lod_rank


def test_every_effect_means_something_at_every_level() -> None:
    assert set(TABLE) == set(EFFECTS)
    for effect in EFFECTS:
        assert tuple(TABLE[effect]) == LEVELS
        keys = {frozenset(TABLE[effect][level].settings) for level in LEVELS}
        assert len(keys) == 1, f"{effect}: its levels set different things"


@pytest.mark.parametrize(
    ("effect", "setting", "values"),
    [
        ("texture", "iris_map_px", [128, 512, 1024, 2048]),
        ("refraction", "refracts", [0, 0, 1, 1]),
        ("reflection", "cube_px", [0, 128, 1024, 2048]),
        ("subsurface", "samples", [0, 0, 10, 200]),
        ("caustics", "caustic_map_px", [0, 0, 256, 1024]),
        ("tessellation", "triangles", [150, 500, 2000, 8000]),
        ("sclera", "normal_map_px", [0, 0, 128, 512]),
    ],
)
def test_the_levels_are_the_thesis_table_5_1(effect: str, setting: str, values: list[int]) -> None:
    found = [Detail.uniform(level).setting(effect, setting) for level in LEVELS[1:]]
    assert found == values


def test_one_effect_can_be_set_or_kept_alone() -> None:
    ultra = Detail.uniform("ultra")
    without = ultra.with_levels(caustics="off")
    assert without.caustics == "off"
    assert without.with_levels(caustics="ultra") == ultra
    alone = ultra.only("caustics").levels()
    assert alone.pop("caustics") == "ultra"
    assert set(alone.values()) == {"off"}


def test_unknown_effects_and_levels_are_named_with_what_exists() -> None:
    with pytest.raises(
        ValueError, match='reflection: unknown level "hihg"; choose one of off, low'
    ):
        Detail(reflection="hihg")
    with pytest.raises(ValueError, match='unknown effect "gloss"; choose one of texture, refrac'):
        Detail().with_levels(gloss="low")


def test_only_the_four_standard_lods_have_a_rank() -> None:
    assert [lod_rank(name) for name in ("low", "medium", "high", "ultra")] == [1, 2, 3, 4]
    assert lod_rank("ultra-no-caustics") is None
