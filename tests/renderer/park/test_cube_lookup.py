from __future__ import annotations

import numpy as np

from renderer.park.cube_faces import face_directions
from renderer.park.cube_lookup import halve, look_up


def pattern(directions: np.ndarray) -> np.ndarray:
    """Three channels that tell every axis and its sign apart."""
    x, y, z = np.moveaxis(directions, -1, 0)
    return np.stack([1 + 0.5 * x + 0.2 * y * z, 2 + y, 3 - z + 0.3 * x * y], axis=-1)


def faces(size: int) -> np.ndarray:
    return np.stack([pattern(face_directions(size, face)) for face in range(6)])


def test_a_lookup_finds_what_was_drawn_there() -> None:
    rng = np.random.Generator(np.random.PCG64(1))
    directions = rng.standard_normal((2000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    np.testing.assert_allclose(look_up(faces(64), directions), pattern(directions), atol=0.02)


def test_one_texel_a_face_is_enough() -> None:
    np.testing.assert_array_equal(
        look_up(np.full((6, 1, 1, 3), 0.5), np.array([[0.0, 0.6, -0.8]])), [[0.5, 0.5, 0.5]]
    )


def test_halving_keeps_the_mean() -> None:
    small = halve(faces(16), 4)
    assert small.shape == (6, 4, 4, 3)
    np.testing.assert_allclose(small.mean(axis=(1, 2)), faces(16).mean(axis=(1, 2)), rtol=1e-12)
