"""Exposures of the recommended studies over people: the proof of the balance, by simulation."""

from __future__ import annotations

from collections import Counter

import pytest

from study.design.definition import read_definition
from study.design.exposure import Spread, exposure_table, people_until, spreads, visits

LOD, ABLATION = read_definition("lod"), read_definition("ablation")


def spread(people: int, name: str) -> tuple[int, int, int]:
    found = {s.name: s for s in spreads(LOD, visits(LOD, people))}[name]
    return found.kinds, found.least, found.most


@pytest.mark.parametrize(
    ("people", "pairing", "iris", "catch"),
    [(6, (4, 4), (1, 1), (1, 2)), (10, (6, 7), (1, 2), (2, 3)), (24, (16, 16), (4, 4), (6, 6))],
)
def test_lod_shows_every_pairing_side_and_iris_equally_often(
    people: int, pairing: tuple[int, int], iris: tuple[int, int], catch: tuple[int, int]
) -> None:
    assert spread(people, "each pairing, each way round") == (24, *pairing)
    assert spread(people, "each pairing with each iris") == (96, *iris)
    assert spread(people, "each equal pair") == (16, *catch)
    assert spread(people, "each distance") == (4, 4 * people, 4 * people)
    assert spread(people, "each orbit direction") == (2, people // 2, people // 2)


def test_48_people_see_every_pairing_in_both_directions_equally_often() -> None:
    assert spread(48, "each pairing, each way round") == (24, 32, 32)
    assert spread(48, "each pairing in each direction") == (48, 16, 16)
    kinds, least, most = spread(48, "each row of the orders")
    assert (kinds, least, most) == (20, 2, 3)


def test_120_people_are_balanced_over_places_and_carry_over() -> None:
    for name in ("each row of the orders", "each distance at each place"):
        _, least, most = spread(120, name)
        assert least == most
    assert spread(120, "each distance after each other") == (12, 150, 150)


def test_28_people_see_every_effect_left_out_equally_often() -> None:
    found = {s.name: (s.least, s.most) for s in spreads(ABLATION, visits(ABLATION, 28))}
    assert found["each pairing, each way round"] == (8, 8)
    assert found["each pairing with each iris"] == (4, 4)
    assert found["each pairing in each direction"] == (4, 4)


def test_each_visit_has_twenty_trials_and_is_the_same_again() -> None:
    first = visits(LOD, 5)
    assert first == visits(LOD, 8)[:5]
    assert {len(visit.clips) for visit in first} == {20}
    assert all(Counter(c.is_catch for c in visit.clips)[True] == 4 for visit in first)


def test_a_table_says_what_so_many_people_see() -> None:
    lines = [line.split("  ") for line in exposure_table(LOD, [10, 24])]
    cells = {line[0]: [cell.strip() for cell in line[1:] if cell.strip()] for line in lines}
    assert cells["people"] == ["10", "24"]
    assert cells["each pairing, each way round"] == ["6 to 7", "16"]
    assert cells["each orbit direction"] == ["5", "12"]


def test_a_spread_is_one_number_where_all_are_equal() -> None:
    assert str(Spread("x", 4, 3, 3)) == "3"
    assert str(Spread("x", 4, 2, 3)) == "2 to 3"


def test_a_study_that_everybody_sees_whole_is_counted_too() -> None:
    lines = exposure_table(read_definition("thesis"), [4])
    assert lines[2].split("  ")[-1].strip() == "4"
    assert not any(line.startswith("each row") for line in lines)


def test_so_many_people_come_until_each_cell_was_seen_so_often() -> None:
    assert people_until(LOD, 12) == 12  # everybody sees each LoD at each distance
    needed = people_until(ABLATION, 6)
    assert needed is not None
    seen = [
        {(clip.distance, lod) for clip in visit.clips for lod in (clip.left, clip.right)}
        for visit in visits(ABLATION, needed)
    ]
    cells = set.union(*seen)
    assert min(sum(cell in own for own in seen) for cell in cells) == 6
    assert min(sum(cell in own for own in seen[:-1]) for cell in cells) == 5
    assert people_until(ABLATION, 6, most=6) is None
