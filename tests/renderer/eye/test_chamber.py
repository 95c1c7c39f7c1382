from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from renderer.eye.anatomy import CORNEA_IOR
from renderer.eye.chamber import Radiance, chamber_irradiance
from renderer.eye.chamber_rays import chamber_window
from renderer.eye.lids import LidRims, lid_openness
from renderer.spherical_harmonics import sh_basis


def constant(directions: np.ndarray) -> np.ndarray:
    return np.ones((len(directions), 3))


def gradient(axis: int) -> Radiance:
    """Radiance that grows towards one of the world's axes."""
    return lambda directions: np.repeat(1.0 + 0.5 * directions[:, axis : axis + 1], 3, axis=1)


def test_furnace_the_chamber_gathers_n_squared_of_a_uniform_sky() -> None:
    """From the iris's centre 2.4 % is mirrored and 4 % of the hemisphere is limbus and wall."""
    centre = chamber_irradiance(constant, np.eye(3), rims=None, size_px=16)[7:9, 7:9].mean()
    assert float(centre) / math.pi == pytest.approx(CORNEA_IOR**2 * 0.935, rel=0.01)


def test_what_goes_in_and_what_is_mirrored_make_up_a_whole() -> None:
    """No ray is counted twice: the rest of each point's rays ends on limbus and wall."""
    window = chamber_window(16)
    out = np.bincount(window.point, window.transmitted, minlength=256)
    whole = out + window.mirror.sum(axis=1)
    assert whole.max() < 1.0
    assert whole.reshape(16, 16)[8, 8] == pytest.approx(0.96, abs=0.01)


def test_the_cornea_mirrors_light_between_points_both_ways() -> None:
    """Helmholtz: as much comes from A to B as from B to A."""
    mirror = chamber_window(32).mirror
    radius = np.hypot(*np.meshgrid(*[(np.arange(32) + 0.5) / 32 * 12 - 6] * 2)).ravel()
    edges_mm = (0.0, 1.5, 3.0, 5.0)
    rings = [(radius >= low) & (radius < high) for low, high in pairwise(edges_mm)]
    for one, other in ((0, 1), (1, 2), (0, 2)):
        there = mirror[np.ix_(rings[one], rings[other])].sum()
        back = mirror[np.ix_(rings[other], rings[one])].sum()
        assert there == pytest.approx(back, rel=0.1)


def test_a_bright_iris_lights_itself_most_where_the_cornea_mirrors_totally() -> None:
    black = chamber_irradiance(constant, np.eye(3), rims=None, size_px=16)
    bright = chamber_irradiance(
        constant, np.eye(3), rims=None, albedo=np.full((16, 16, 3), 0.2), size_px=16
    )
    gain = (bright / black)[8, 8:, 0]
    assert gain[0] == pytest.approx(1.005, abs=0.003)
    assert 1.03 < gain[5] < 1.1


def test_the_iris_darkens_towards_its_root() -> None:
    row = chamber_irradiance(constant, np.eye(3), rims=None, size_px=16)[8, 8:, 0]
    assert (np.diff(row) <= 1e-3).all()
    assert row[-1] < 0.4 * row[0]


def test_the_upper_lid_shades_the_upper_iris(average_rims: tuple[LidRims, LidRims]) -> None:
    shaded = chamber_irradiance(constant, np.eye(3), rims=average_rims[0], size_px=8)
    free = chamber_irradiance(constant, np.eye(3), rims=None, size_px=8)
    share = (shaded / free)[:, 4, 1]
    assert share[6] < share[1] < 1.0  # row 6 lies under the upper lid


def test_light_from_the_right_is_stronger_on_the_far_side_of_the_iris() -> None:
    across = chamber_irradiance(gradient(0), np.eye(3), rims=None, size_px=16)[8, :, 1]
    assert across[4] > 1.1 * across[11]


def test_the_surroundings_turn_against_the_gaze() -> None:
    turned = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])  # gaze to the right
    np.testing.assert_allclose(
        chamber_irradiance(gradient(0), turned, rims=None, size_px=4),
        chamber_irradiance(gradient(2), np.eye(3), rims=None, size_px=4),
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
