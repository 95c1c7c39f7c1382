import numpy as np

from renderer.crowd.occlusion import cone_directions, openness, sphere_directions, visibility


def floor_and_roof() -> tuple[np.ndarray, np.ndarray]:
    """A floor of 2 m with a smaller roof 0.3 m above its left half, in mm."""
    corners, triangles = [], []
    for height, right in ((0.0, 1000.0), (300.0, 0.0)):
        xs, zs = np.linspace(-1000, right, 21), np.linspace(-1000, 1000, 21)
        first = len(corners)
        corners += [[x, height, z] for z in zs for x in xs]
        for row in range(20):
            for column in range(20):
                a = first + row * 21 + column
                triangles += [[a, a + 22, a + 1], [a, a + 21, a + 22]]
    return np.array(corners), np.array(triangles)


def test_a_roof_shades_the_floor_below_it_and_nothing_else() -> None:
    places, triangles = floor_and_roof()
    lit = visibility(places, triangles, directions=np.array([[0.0, 1.0, 0.0]]))[:, 0]
    floor = np.arange(441)
    inner = np.abs(places[:441, 2]) < 900
    assert lit[floor[inner & (places[:441, 0] < -100) & (places[:441, 0] > -900)]].max() == 0
    assert lit[floor[places[:441, 0] > 100]].min() == 1
    assert lit[441:].min() == 1


def test_openness_is_one_on_a_free_plane_and_less_under_a_roof() -> None:
    places, triangles = floor_and_roof()
    normals = np.tile([0.0, 1.0, 0.0], (len(places), 1))
    share = openness(places, normals, triangles=triangles, count=64)
    assert share[441:].min() > 0.9
    under = np.linalg.norm(places[:441] - [-500, 0, 0], axis=1).argmin()
    assert share[under] < 0.45


def test_directions_are_unit_and_balanced() -> None:
    directions = sphere_directions(64)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1.0)
    np.testing.assert_allclose(directions.mean(axis=0), 0.0, atol=0.02)
    cone = cone_directions(np.array([0.0, 1.0, 0.0]), angle_rad=0.05)
    np.testing.assert_allclose(np.arccos(cone[1:, 1]), 0.05, rtol=1e-6)
