import numpy as np
import pytest

from renderer.crowd.cube_tiles import TILES, cover, touched
from renderer.park.cube_faces import FACE_AXES

NEAR_MM = 150.0


@pytest.mark.parametrize("face", range(6))
def test_a_sphere_touches_the_face_it_stands_before_and_not_the_opposite(face: int) -> None:
    centre = (FACE_AXES[face] @ np.array([0.3, -0.2, 1.0]))[None] * 1000
    found = touched(centre, np.array([100.0]), near_mm=NEAR_MM)
    column, row = round((0.3 + 1) / 2 * TILES), round((-0.2 + 1) / 2 * TILES)
    assert found.tiles[face, row, column]
    assert 1 <= found.tiles[face].sum() <= 9
    assert found.bodies[face].all()
    assert not found.tiles[face ^ 1].any()
    assert not found.bodies[face ^ 1].any()


def test_whatever_lies_in_a_sphere_lies_in_its_tiles() -> None:
    rng = np.random.Generator(np.random.PCG64(7))
    centres = rng.normal(size=(60, 3)) * 1500
    reach_mm = rng.uniform(20, 600, 60)
    towards = rng.normal(size=(400, 60, 3))
    towards /= np.linalg.norm(towards, axis=-1, keepdims=True)
    points = centres + reach_mm[:, None] * towards * rng.uniform(size=(400, 60, 1)) ** 0.2
    found = touched(centres, reach_mm, near_mm=NEAR_MM)
    hits = 0
    for face, axes in enumerate(FACE_AXES):
        right, down, forward = np.moveaxis(points @ axes, -1, 0)
        on_it = (forward > NEAR_MM) & (np.maximum(np.abs(right), np.abs(down)) < forward)
        column, row = (
            ((across[on_it] / forward[on_it] + 1) / 2 * TILES).astype(int)
            for across in (right, down)
        )
        assert found.tiles[face, row, column].all()
        assert found.bodies[face, np.nonzero(on_it)[1]].all()
        hits += on_it.sum()
    assert hits > 10000
    assert found.bodies.sum() < 180  # of 360


def test_a_shape_stretches_what_lies_around_points() -> None:
    flat = np.diag([3.0, 0.0, 1.0])
    at, reach_mm = np.array([[0.0, -500.0, 1000.0]]), np.array([100.0])
    rows, columns = np.nonzero(touched(at, reach_mm, near_mm=NEAR_MM, shape=flat).tiles[4])
    # Down half of the way to the lower edge, from 900 to 1100 mm away, 300 mm to either side.
    assert set(rows) == {11, 12}
    assert set(columns) == set(range(5, 11))


def test_tiles_of_many_spheres_are_those_of_each() -> None:
    rng = np.random.Generator(np.random.PCG64(8))
    centres, reach_mm = rng.normal(size=(20, 3)) * 2000, rng.uniform(20, 200, 20)
    alone = [
        touched(centre[None], reach[None], near_mm=NEAR_MM).tiles
        for centre, reach in zip(centres, reach_mm, strict=True)
    ]
    together = touched(centres, reach_mm, near_mm=NEAR_MM).tiles
    np.testing.assert_array_equal(together, np.any(alone, axis=0))
    assert 0.01 < together.mean() < 0.5


def test_rectangles_cover_the_tiles_exactly() -> None:
    rng = np.random.Generator(np.random.PCG64(5))
    for share in (0.0, 0.4, 0.9, 1.0):
        tiles = rng.uniform(size=(TILES, TILES)) < share
        again = np.zeros((TILES, TILES), dtype=int)
        for x, y, width, height in cover(tiles):
            again[y : y + height, x : x + width] += 1
        np.testing.assert_array_equal(again, tiles.astype(int))
    assert cover(np.ones((TILES, TILES), dtype=bool)) == [(0, 0, TILES, TILES)]
