"""Hair of the scalp: a mass that no edge betrays, locks over it, single hairs along the line."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from renderer.head.face_mesh import face_mesh
from renderer.head.hair import LAYERS, grow_hair
from renderer.head.hair_cap import HairCap, hair_cap, inside_hairline
from renderer.head.strand_group import Strands


@pytest.fixture(scope="module")
def cap() -> HairCap:
    return hair_cap(face_mesh())


@pytest.fixture(scope="module")
def hair(cap: HairCap) -> Strands:
    return grow_hair(cap, np.random.Generator(np.random.PCG64(3)))


def layers(hair: Strands) -> list[Strands]:
    """Split the hair into its layers again."""
    starts = np.cumsum([0, *(layer.count for layer in LAYERS)])
    return [
        Strands(hair.points_mm[a:b], hair.width_mm[a:b], hair.colour[a:b])
        for a, b in itertools.pairwise(starts)
    ]


def test_the_mass_dives_under_the_skin_before_the_hairline(cap: HairCap) -> None:
    above = inside_hairline(cap.foot_mm)
    under = ((cap.foot_mm - cap.points_mm) * cap.normals).sum(axis=1)
    face = cap.foot_mm[:, 2] > -40.0  # behind the ears the scalp folds
    assert under[face & (above < 2)].min() > 0.9
    assert np.abs(under[above > 20]).max() < 0.01


def test_the_mass_is_finer_than_the_scalp_it_covers(cap: HairCap) -> None:
    corners = cap.points_mm[cap.triangles]
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    assert np.median(edges) < 6.0


def test_locks_lie_on_the_mass_not_in_it(cap: HairCap, hair: Strands) -> None:
    locks = layers(hair)[0].points_mm[:, 2:-1].reshape(-1, 3)
    step = 7
    nearest = np.array(
        [np.argmin(((cap.foot_mm - point) ** 2).sum(axis=1)) for point in locks[:: step * 23]]
    )
    height = ((locks[:: step * 23] - cap.foot_mm[nearest]) * cap.normals[nearest]).sum(axis=1)
    assert np.median(height) > 0.5
    assert (height > 0.0).mean() > 0.9
    assert height.max() < 6.0


def test_most_hairs_root_along_the_hairline(hair: Strands) -> None:
    for layer, share in zip(layers(hair), (0.15, 0.7, 0.8), strict=True):
        above = inside_hairline(layer.points_mm[:, 0])
        assert (np.abs(above) < 12.0).mean() > share


def test_short_new_hairs_break_the_line(hair: Strands) -> None:
    new = layers(hair)[2]
    above = inside_hairline(new.points_mm[:, 0])
    assert (above < 0).mean() > 0.1
    assert new.width_mm.max() < 0.1
    way = np.linalg.norm(new.points_mm[:, -1] - new.points_mm[:, 0], axis=1)
    assert np.median(way) < 20


def test_the_comb_leads_back_from_the_forehead(hair: Strands) -> None:
    way = hair.points_mm[:, -1] - hair.points_mm[:, 0]
    front = hair.points_mm[:, 0, 1] > 70
    assert (way[front, 2] < 0).mean() > 0.9


def test_the_same_seed_grows_the_same_hair(cap: HairCap, hair: Strands) -> None:
    again = grow_hair(cap, np.random.Generator(np.random.PCG64(3)))
    np.testing.assert_array_equal(again.points_mm, hair.points_mm)
