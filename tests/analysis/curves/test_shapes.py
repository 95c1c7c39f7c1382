"""Shapes of differences along size: derivatives, closed forms, and that they never fall."""

from __future__ import annotations

import numpy as np
import pytest

from analysis.curves.shapes import Shape, Shaped, bent_over

SIZES = np.log2([12.0, 40.0, 160.0, 350.0])


@pytest.mark.parametrize("shape", [Shape(), bent_over(SIZES)])
def test_the_jacobian_is_that_of_finite_differences(shape: Shape) -> None:
    shown = np.array([True, False, True, True, True])
    predictor = Shaped(shape, np.append(SIZES, 6.0), shown, "low")
    at = np.random.default_rng(2).normal(0.2, 0.5, len(predictor.names))
    at[1] += 6.0
    assert len(predictor.kinds) == len(predictor.names)
    steps = np.eye(len(at)) * 1e-6
    numeric = [(predictor.eta(at + e) - predictor.eta(at - e)) / 2e-6 for e in steps]
    assert predictor.jacobian(at) == pytest.approx(np.array(numeric).T, abs=1e-8)
    assert predictor.eta(at)[1] == 0.0


def test_a_sigmoid_is_half_its_height_in_its_middle() -> None:
    found = Shape().difference(np.array([[np.log(3.0), 6.0, 0.0]]), np.array([6.0, 60.0]))
    assert found == pytest.approx(np.array([[1.5, 3.0]]))


def test_bends_change_it_by_a_factor_at_their_knot() -> None:
    shape = bent_over(SIZES)
    assert np.array(shape.knots) == pytest.approx(SIZES)
    plain = np.array([[1.0, 6.0, 0.5, 0.0, 0.0, 0.0, 0.0]])
    bent = plain + np.array([[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.2]])
    before, after = (shape.difference(own, SIZES)[0] for own in (plain, bent))
    assert after / before == pytest.approx([1, 1, 1, np.exp(0.2)])
    assert Shaped(shape, SIZES, np.ones(4, dtype=bool), "low").eta(bent[0]) == pytest.approx(after)


def test_a_difference_never_falls_with_size() -> None:
    shape = bent_over(SIZES)
    draws = np.random.default_rng(1).normal(0, 1, (200, 7)) * [1, 2, 0.8, 0.6, 0.6, 0.6, 0.6]
    found = shape.difference(draws + [0, 6, 0.7, 0, 0, 0, 0], np.linspace(3.6, 8.4, 61))
    assert (np.diff(found, axis=1) >= 0).all()


def test_knots_stand_an_octave_apart_and_at_both_ends() -> None:
    knots = bent_over(np.log2([12.0, 18.0, 40.0, 60.0, 160.0, 240.0, 350.0])).knots
    assert 2.0 ** np.array(knots) == pytest.approx([12.0, 40.0, 160.0, 350.0])
    assert bent_over(np.array([5.0, 5.2])).knots == (5.0, 5.2)
