"""The layers' coefficients: physical, and true to the family's hue when marched."""

from __future__ import annotations

import numpy as np
import pytest

from renderer.eye.subsurface import Path, piecewise_linear
from renderer.iris.maps import bake_iris, scattering
from renderer.iris.pigment import FAMILIES


@pytest.mark.parametrize("colour", FAMILIES)
def test_coefficients_are_physical(colour: str) -> None:
    tissue = scattering(colour)
    assert tissue.sigma_s.shape == tissue.sigma_t.shape == (4, 3)
    assert (tissue.sigma_s > 0.0).all()
    assert (tissue.sigma_s < tissue.sigma_t).all()
    assert (np.abs(tissue.anisotropy) < 1.0).all()


@pytest.mark.parametrize("colour", FAMILIES)
def test_a_marched_column_has_the_colour_of_the_map(colour: str) -> None:
    baked = bake_iris(2, colour, size_px=128)
    thickness = baked["mean_thickness"].astype(np.float64)
    column = Path(lambda at: np.tile(thickness, (len(at), 1)), 1.0, 1.0, -1.0)
    marched = piecewise_linear(column, scattering(colour), nodes=4)
    gain = baked["mean_albedo"] / marched
    # Equal gains would be the map's own hue; a quarter off either way is still the same family.
    assert gain.max() / gain.min() < 1.6, f"{colour}: gains {gain.round(2)}"


def test_the_pigment_epithelium_swallows_light() -> None:
    for colour in FAMILIES:
        tissue = scattering(colour)
        assert (tissue.sigma_s[3] / tissue.sigma_t[3]).max() < 0.02
