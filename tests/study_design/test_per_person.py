"""Blocks: every clip equally often over them, every distance, side and iris within each."""

from __future__ import annotations

from collections import Counter
from typing import Any

import pytest

from study.design.definition import (
    DefinitionError,
    StudyDefinition,
    parse_definition,
    read_definition,
)
from study.design.pairings import CatchClip, Clip, Factors
from study.design.per_person import Block, PerPerson, blocks_of

DISTANCES = ("macroscopic", "near", "medium", "far")


def crossed(lods: int, irises: int, *, distances: int = 4) -> tuple[Clip, ...]:
    factors = Factors(
        distances=DISTANCES[:distances],
        lods=tuple(f"lod-{n}" for n in range(lods)),
        against=("best",),
        irises=tuple(f"iris-{n}" for n in range(irises)),
    )
    return tuple(factors.clips())


def compared(clip: Clip) -> str:
    return clip.left if clip.right in ("ultra", "best") else clip.right


@pytest.mark.parametrize(
    ("lods", "irises", "distances", "share"),
    [
        *[(3, 4, 4, 4), (3, 1, 4, 4), (7, 2, 4, 4), (3, 3, 4, 4), (2, 2, 3, 3), (4, 3, 2, 5)],
        *[(3, 4, 4, 6), (1, 1, 4, 1), (5, 1, 1, 7)],
    ],
)
def test_every_clip_is_in_equally_many_blocks_and_none_twice_in_one(
    lods: int, irises: int, distances: int, share: int
) -> None:
    clips = crossed(lods, irises, distances=distances)
    blocks = blocks_of(clips, PerPerson(pairs=share * distances))
    seen = Counter(clip.id for block in blocks for clip in block)
    assert set(seen) == {clip.id for clip in clips}
    assert len(set(seen.values())) == 1
    for block in blocks:
        assert len({clip.condition for clip in block}) == len(block) == share * distances
        assert set(Counter(clip.distance for clip in block).values()) == {share}
        sides = Counter(clip.right == "best" for clip in block)
        assert abs(sides[True] - sides[False]) <= distances * (share % 2)


@pytest.mark.parametrize(("name", "irises"), [("lod", 4), ("ablation", 2)])
def test_one_person_sees_every_distance_side_and_iris_equally_often(name: str, irises: int) -> None:
    definition = read_definition(name)
    for block in definition.blocks:
        pairs = [clip for clip in block if not clip.is_catch]
        catch = [clip for clip in block if clip.is_catch]
        assert (len(pairs), len(catch)) == (16, 4)
        for kind in (
            Counter(clip.distance for clip in pairs),
            Counter(clip.left == "ultra" for clip in pairs),
            Counter(clip.iris for clip in pairs),
            Counter((clip.iris, clip.left == "ultra") for clip in pairs),
            Counter((clip.iris, clip.distance) for clip in pairs),
            Counter(clip.distance for clip in catch),
            Counter(clip.iris for clip in catch),
        ):
            assert len(set(kind.values())) == 1, kind
        assert len({clip.iris for clip in block}) == irises
        lods = Counter(map(compared, pairs))
        assert max(lods.values()) - min(lods.values()) <= 1


def test_everybody_sees_each_lod_in_a_pair_at_each_distance_and_alone_once() -> None:
    for block in read_definition("lod").blocks:
        pairs = {(clip.distance, compared(clip)) for clip in block if not clip.is_catch}
        assert len(pairs) == 12
        alone = [clip.left for clip in block if clip.is_catch]
        assert sorted(alone) == ["high", "low", "medium", "ultra"]


def test_without_a_number_everybody_sees_every_clip() -> None:
    clips = crossed(2, 1)
    assert blocks_of(clips, None) == (clips,)


def ids(block: Block) -> list[str]:
    return [clip.id for clip in block]


def test_catch_clips_are_taken_in_the_files_turn() -> None:
    catch = [CatchClip(distance=d, lod=lod).clip() for lod in ("a", "b") for d in ("near", "far")]
    pairs = [clip for clip in crossed(1, 1, distances=4) if clip.distance in ("near", "far")]
    blocks = blocks_of([*pairs, *catch], PerPerson(pairs=4, catch=2))
    assert [ids(block)[-2:] for block in blocks] == [
        ["catch-near-a", "catch-far-a"],
        ["catch-near-b", "catch-far-b"],
    ]


def many(raw: dict[str, Any], **changes: Any) -> StudyDefinition:
    raw["clips"] = []
    raw["factors"] = [{"distances": ["near", "far"], "lods": ["low"], "against": ["ultra"]}]
    return parse_definition(raw | changes)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        (
            {"per_person": {"pairs": 3}},
            "per_person.pairs: 3 cannot be shared equally by 2 distances; use 2, 4",
        ),
        (
            {"per_person": {"pairs": 6}},
            "per_person.pairs: 6 of 4 pairings; nobody sees one twice, so 4 is the most",
        ),
        (
            {"per_person": {"pairs": 2, "catch": 1}},
            "per_person.catch: 1 of no catch clips; add some, or leave this out",
        ),
        (
            {
                "per_person": {"pairs": 2},
                "clips": [{"id": "x", "distance": "far", "left": "ultra", "right": "no-caustics"}],
            },
            "per_person.pairs: every distance needs equally many pairings; found far 3, near 2",
        ),
        (
            {
                "per_person": {"pairs": 2},
                "irises": {"dark": {"iris_colour": "brown"}},
                "clips": [
                    {"id": f"{d}-dark", "distance": d, "left": "low", "right": "ultra", "iris": i}
                    for d, i in (("near", "dark"), ("far", "dark"))
                ],
            },
            "per_person.pairs: every pairing needs equally many irises; found 1 and 2",
        ),
        ({"per_person": {}}, "per_person.pairs: missing; this key is required"),
    ],
)
def test_numbers_that_cannot_be_balanced_are_told(
    raw: dict[str, Any], changes: dict[str, Any], told: str
) -> None:
    with pytest.raises(DefinitionError) as caught:
        many(raw, **changes)
    assert told in str(caught.value).replace("definition: ", "").splitlines()


def test_more_blocks_than_anybody_can_fill_are_told(raw: dict[str, Any]) -> None:
    raw["lods"] |= {f"lod-{n}": {"base": "ultra", "caustics": "off"} for n in range(41)}
    factors = {"distances": ["near", "far"], "lods": [f"lod-{n}" for n in range(41)]}
    irises = {f"iris-{n}": {"iris_seed": n} for n in range(3)}
    raw |= {"irises": irises, "per_person": {"pairs": 2}}
    raw |= {"clips": [], "factors": [{**factors, "against": ["ultra"], "irises": list(irises)}]}
    with pytest.raises(DefinitionError, match=r"per_person: 246 blocks are needed .* at most 240"):
        parse_definition(raw)
