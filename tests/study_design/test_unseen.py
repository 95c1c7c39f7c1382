"""Differences that no pixel shows are told once per cause, with every place they concern."""

from __future__ import annotations

from typing import Any

from study.design import audit
from study.design.definition import parse_definition, read_definition
from study.design.unseen import unseen_differences


def told(name: str, effect: str) -> list[str]:
    return [line for line in unseen_differences(read_definition(name)) if line.startswith(effect)]


def test_the_audit_warns_of_each_cause_once() -> None:
    lod = read_definition("lod")
    causes = list(unseen_differences(lod))
    assert audit.warnings(lod)[-len(causes) :] == causes
    assert len(causes) == len({line.partition(", as ")[0] for line in causes}) == 10


def test_irises_sides_and_sizes_of_one_pair_are_told_together() -> None:
    assert told("lod", "caustics") == [
        "caustics: differences are smaller than a pixel below an iris of 256 px, as the coarser "
        "map has 256 texels across the iris: high | ultra at macroscopic (233 px at 1280x720), "
        "near (107 and 160 px), medium (27 and 40 px), far (8 and 12 px)"
    ]


def test_pairs_alike_in_all_of_their_places_are_told_together() -> None:
    (line,) = told("lod", "subsurface")
    assert line.endswith(
        ": low | ultra, medium | ultra at medium (27 px at 1280x720), far (8 and 12 px)"
    )


def test_pairs_with_places_of_their_own_are_told_apart() -> None:
    (line,) = told("thesis", "sclera")
    assert line.endswith(
        ": low | ultra at near (107 px at 1280x720), far (8 and 12 px); low | medium at near "
        "(107 px at 1280x720)"
    )


def test_clips_in_which_nothing_else_differs_come_first_and_say_so(raw: dict[str, Any]) -> None:
    raw["lods"]["smooth"] = {"base": "ultra", "tessellation": "high"}
    raw["clips"] = [
        {"id": "x", "distance": "far", "left": "ultra", "right": "smooth"},
        {"id": "y", "distance": "far", "left": "ultra", "right": "low"},
    ]
    first, *others = unseen_differences(parse_definition(raw))
    assert first == (
        "tessellation: differences are smaller than a pixel below an iris of 200 px, as the "
        "coarser mesh has 2000 triangles: ultra | smooth at far (2 and 4 px); nothing else "
        "differs there"
    )
    assert others
    assert not any("nothing else" in line or "smooth" in line for line in others)


def test_a_size_is_compared_as_it_is_told() -> None:
    # Far is 12 pixels by definition, though perspective makes it 11.97.
    (line,) = told("ablation", "texture")
    assert line.endswith("ultra | no-texture at far (8 px at 1280x720); nothing else differs there")
