from __future__ import annotations

import math

import numpy as np
import pytest

from renderer.eye.anatomy import CORNEA_IOR
from renderer.eye.chamber import chamber_irradiance, lid_openness
from renderer.eye.lids import LidRims
from renderer.spherical_harmonics import sh_basis

CONSTANT = np.zeros((9, 3))
CONSTANT[0] = 1 / 0.282095  # radiance 1 from everywhere


def test_furnace_the_chamber_gathers_n_squared_of_a_uniform_sky() -> None:
    """Nearly the whole hemisphere over the iris's centre looks out through the cornea."""
    centre = chamber_irradiance(CONSTANT, np.eye(3), rims=None, size_px=16)[7:9, 7:9].mean()
    assert float(centre) / math.pi == pytest.approx(CORNEA_IOR**2 * 0.979, rel=0.03)


def test_the_iris_darkens_towards_its_root() -> None:
    row = chamber_irradiance(CONSTANT, np.eye(3), rims=None, size_px=16)[8, 8:, 0]
    assert (np.diff(row) <= 1e-3).all()
    assert row[-1] < 0.4 * row[0]


def test_the_upper_lid_shades_the_upper_iris(average_rims: tuple[LidRims, LidRims]) -> None:
    shaded = chamber_irradiance(CONSTANT, np.eye(3), rims=average_rims[0], size_px=8)
    free = chamber_irradiance(CONSTANT, np.eye(3), rims=None, size_px=8)
    share = (shaded / free)[:, 4, 1]
    assert share[6] < share[1] < 1.0  # row 6 lies under the upper lid


def test_light_from_the_right_is_stronger_on_the_far_side_of_the_iris() -> None:
    from_right = CONSTANT.copy()
    from_right[3] = 0.5 / 0.488603
    across = chamber_irradiance(from_right, np.eye(3), rims=None, size_px=16)[8, :, 1]
    assert across[4] > 1.1 * across[11]


def test_the_surroundings_turn_against_the_gaze() -> None:
    from_right = CONSTANT.copy()
    from_right[3] = 0.5 / 0.488603
    turned = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])  # gaze to the right
    ahead = CONSTANT.copy()
    ahead[2] = 0.5 / 0.488603
    np.testing.assert_allclose(
        chamber_irradiance(from_right, turned, rims=None, size_px=4),
        chamber_irradiance(ahead, np.eye(3), rims=None, size_px=4),
        rtol=1e-4,
    )


def test_rays_pass_between_the_lids_and_end_on_them(
    average_rims: tuple[LidRims, LidRims],
) -> None:
    points = np.array([[0.0, 0.0, 12.5]] * 3)
    directions = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.02], [0.0, -1.0, 0.02]])
    openness = lid_openness(points, directions, average_rims[0])
    assert openness[0] == 1.0
    assert openness[1] < 0.5
    assert openness[2] < 1.0


def test_harmonics_are_orthonormal() -> None:
    rng = np.random.Generator(np.random.PCG64(1))
    directions = rng.standard_normal((200_000, 3))
    basis = sh_basis(directions / np.linalg.norm(directions, axis=1, keepdims=True))
    gram = 4 * math.pi * basis.T @ basis / len(basis)
    np.testing.assert_allclose(gram, np.eye(9), atol=0.02)
