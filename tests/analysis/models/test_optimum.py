"""Climbing: a quadratic is solved exactly, silence is told, a bad inverse does no harm."""

from __future__ import annotations

import numpy as np
import pytest

from analysis.models.optimum import climb, hessian, inverse_of

CURVATURE = np.array([[4.0, 1.0], [1.0, 3.0]])
TOP = np.array([1.0, -2.0])


def bowl(x: np.ndarray) -> tuple[float, np.ndarray]:
    away = x - TOP
    return float(0.5 * away @ CURVATURE @ away), CURVATURE @ away


def test_the_optimum_of_a_bowl_is_found_from_anywhere() -> None:
    assert climb(bowl, np.zeros(2))[0] == pytest.approx(TOP, abs=1e-5)


@pytest.mark.parametrize("inverse", [np.linalg.inv(CURVATURE), np.array([[1.0, 2.0], [0.0, -1.0]])])
def test_a_known_inverse_helps_and_a_bad_one_does_no_harm(inverse: np.ndarray) -> None:
    assert climb(bowl, np.zeros(2), inverse=inverse)[0] == pytest.approx(TOP, abs=1e-3)


def test_curvature_and_its_inverse_are_exact() -> None:
    assert hessian(bowl, TOP) == pytest.approx(CURVATURE, abs=1e-6)
    found, is_flat = inverse_of(CURVATURE)
    assert found == pytest.approx(np.linalg.inv(CURVATURE))
    assert not is_flat
    assert inverse_of(np.diag([1.0, 1e-4]))[1]
