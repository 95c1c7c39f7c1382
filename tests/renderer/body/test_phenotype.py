"""Shape targets and phenotypes: what they move, and what of them is refused."""

from __future__ import annotations

import numpy as np
import pytest

from renderer.body.makehuman import base_mesh
from renderer.body.phenotype import phenotype, target_offsets


def test_a_target_moves_only_its_own_vertices_in_proportion() -> None:
    whole = target_offsets({"faceunits/eyeBlinkLeft": 1.0})
    half = target_offsets({"faceunits/eyeBlinkLeft": 0.5})
    np.testing.assert_allclose(half * 2, whole)
    moved = np.flatnonzero(np.abs(whole).max(axis=1) > 3.0)
    assert 20 < len(moved) < 1000
    assert np.median(base_mesh().vertices_mm[moved, 0]) > 20


def test_an_unknown_target_is_an_error_with_examples() -> None:
    with pytest.raises(ValueError, match=r'unknown target "nose/long"; choose .*eyeBlinkLeft'):
        target_offsets({"nose/long": 1.0})


def test_men_are_taller_and_the_height_property_works() -> None:
    base = base_mesh()
    body = base.vertices_of("body")

    def stature(**values: float) -> float:
        vertices = base.vertices_mm + phenotype(**values)
        return float(np.ptp(vertices[body, 1]))

    assert stature(gender=1.0) > stature(gender=0.0) + 50
    assert stature(height=0.8) > stature(height=0.5) + 30


def test_a_phenotype_between_anchors_is_their_mixture() -> None:
    ends = [phenotype(gender=value) for value in (0.0, 1.0)]
    np.testing.assert_allclose(phenotype(gender=0.25), 0.75 * ends[0] + 0.25 * ends[1], atol=1e-9)


def test_phenotype_faults_are_named() -> None:
    with pytest.raises(ValueError, match=r"unknown tallness; choose from gender, age"):
        phenotype(tallness=1.0)
    with pytest.raises(ValueError, match=r"age = 1.5 lies outside 0 to 1"):
        phenotype(age=1.5)
