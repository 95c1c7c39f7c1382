"""Clothes at the neck are closed against it, whoever looks over a collar; hair lies on the skin."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from renderer.body.makehuman import Floats, Indices
from renderer.crowd.bodies import cached_body
from renderer.crowd.cast import CAST, TEMPLATES
from renderer.crowd.figure import Body
from renderer.crowd.hems import TURNED_DOWN_MM, TURNED_IN_MM, hem, open_edges
from renderer.crowd.pieces import PARTS

NAMES = ("left", "elder", "right")


@pytest.fixture(scope="module", params=NAMES)
def body(request: pytest.FixtureRequest) -> Body:
    name: str = request.param
    return cached_body(TEMPLATES[name])


def part(body: Body, name: str) -> Indices:
    is_part = body.parts == PARTS.index(name)
    return np.asarray(body.triangles[is_part[body.triangles].all(axis=1)])


def above_skin_mm(body: Body, rows: Indices) -> Floats:
    """Return how far vertices stand off the nearest skin, along its normal."""
    skin = np.unique(part(body, "skin"))
    _, near = cKDTree(body.positions_mm[skin]).query(body.positions_mm[rows])
    off = body.positions_mm[rows] - body.positions_mm[skin[near]]
    return np.asarray((off * body.normals[skin[near]]).sum(axis=1))


def test_open_edges_are_those_of_one_triangle() -> None:
    square = np.array([[0, 1, 2], [0, 2, 3]])
    assert sorted(map(tuple, open_edges(square).tolist())) == [(0, 1), (1, 2), (2, 3), (3, 0)]


def test_a_hem_goes_on_over_the_edge_and_inwards() -> None:
    turn = np.arange(8) * np.pi / 4
    ring = 60.0 * np.column_stack([np.sin(turn), np.zeros(8), np.cos(turn)])
    tube = np.concatenate([ring, ring + [0.0, 50.0, 0.0]])
    a, b = np.arange(8), (np.arange(8) + 1) % 8
    triangles = np.concatenate([np.stack([a, b, b + 8], 1), np.stack([a, b + 8, a + 8], 1)])
    rows, places, _, more = hem(tube, triangles, is_hem=tube[:, 1] > 10.0)
    np.testing.assert_array_equal(rows, [*range(8, 16), *range(8, 16)])
    np.testing.assert_allclose(places[:8], tube[8:])
    np.testing.assert_allclose(np.hypot(places[8:, 0], places[8:, 2]), 60.0 - TURNED_IN_MM)
    np.testing.assert_allclose(places[8:, 1], 50.0 - TURNED_DOWN_MM)
    corners = np.concatenate([tube, places])[more]
    facing = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (facing[:, 1] > 0.0).all()  # who looks down at the collar sees it


def test_a_collar_ends_within_the_neck(body: Body) -> None:
    """Nothing is seen between cloth and neck: its last edge is under the skin."""
    edges = open_edges(part(body, "top"))
    neck_mm = body.positions_mm[edges[:, 0], 1].max() - 75.0
    last = np.unique(edges[(body.positions_mm[edges, 1] > neck_mm).all(axis=1)])
    # Of three rows that end there the cloth's own and the hem's first lie on each other.
    heights = np.sort(above_skin_mm(body, last))
    assert heights[: len(heights) // 3].max() < 0.0
    assert heights.max() < 20.0


def test_short_hair_ends_under_the_skin() -> None:
    """Its tips lie on the skin and go on below it, so nobody sees under the hair."""
    for name in ("left", "elder"):
        body = cached_body(TEMPLATES[name])
        heights = above_skin_mm(body, np.unique(open_edges(part(body, "hair"))))
        assert len(heights) > 40
        assert heights.max() < 4.0  # the thinned skin is that far off
        assert np.quantile(heights, 0.9) < 0.0


def test_long_hair_ends_level_at_the_collar() -> None:
    body = cached_body(TEMPLATES["right"])
    y = body.positions_mm[:, 1]
    hair, collar = np.unique(part(body, "hair")), np.unique(part(body, "top"))
    collar_mm, end_mm = y[collar].max(), y[hair].min()
    assert collar_mm - 40.0 < end_mm < collar_mm + 20.0  # it pierces no shoulder
    assert ((y[hair] < end_mm + 12.0).sum()) > 12  # a straight cut, no spikes


def test_nobody_wears_the_colour_of_skin() -> None:
    skins = np.array([person.skin for person in CAST])
    for person in CAST:
        top = np.array(person.top)
        hue = skins / skins.sum(axis=1, keepdims=True)
        assert np.abs(hue - top / top.sum()).max(axis=1).min() > 0.05, person.name


def test_the_rim_of_short_hair_is_lit_as_the_tips_before_it() -> None:
    """Under the skin it faced away from the sky: a thin dark line along the hairline."""
    body = cached_body(TEMPLATES["elder"])
    rim = np.unique(open_edges(part(body, "hair")))
    tips = rim - len(rim)  # the row before the last
    np.testing.assert_allclose(body.normals[rim], body.normals[tips])
