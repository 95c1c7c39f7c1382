import numpy as np
from scipy.spatial.transform import Rotation

from renderer.crowd.turns import Hinges, Pointers, applied, applied_back, unit

RNG = np.random.default_rng(7)


def test_hinges_turn_by_the_right_hand() -> None:
    axes, angles = RNG.normal(size=(5, 4, 3)), RNG.uniform(-4.0, 4.0, (5, 4))
    vectors = (angles[..., None] * unit(axes)).reshape(-1, 3)
    expected = Rotation.from_rotvec(vectors).as_matrix().reshape(5, 4, 3, 3)
    np.testing.assert_allclose(Hinges(axes).turns(angles), expected, atol=1e-12)
    np.testing.assert_allclose(Hinges(axes).turns(0.0 * angles), expected * 0 + np.eye(3))


def test_pointers_turn_what_points_and_nothing_square_to_both() -> None:
    rest, to = 3.0 * RNG.normal(size=(6, 3)), unit(RNG.normal(size=(6, 3)))
    turns = Pointers(rest).towards(to)
    np.testing.assert_allclose(applied(turns, unit(rest)), to, atol=1e-12)
    square = np.cross(rest, to)
    np.testing.assert_allclose(applied(turns, square), square, atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(turns), 1.0)
    np.testing.assert_allclose(Pointers(to).towards(to), np.tile(np.eye(3), (6, 1, 1)), atol=1e-15)


def test_what_is_turned_can_be_turned_back() -> None:
    turns = Hinges([1.0, 2.0, 3.0]).turns(np.array([0.4, 1.9]))
    vectors = RNG.normal(size=(2, 3))
    np.testing.assert_allclose(applied_back(turns, applied(turns, vectors)), vectors)
