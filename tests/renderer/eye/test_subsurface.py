from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import ndimage

from renderer.eye.subsurface import (
    Path,
    Tissue,
    henyey_greenstein,
    left_sum,
    midpoint_sum,
    piecewise_linear,
    subsurface_gain,
)

# The thesis's figure 4.9 (dermis, blood, organs) over an opaque floor.
ORGANIC = Tissue(
    np.array([[2.0, 1, 1], [6, 3, 2], [1, 1, 2], [0.5, 0.5, 0.5]]),
    np.array([[2.6, 1.6, 1.6], [6.6, 3.6, 2.6], [1.5, 1.5, 2.5], [20, 20, 20]]),
    np.array([0.25, 0.40, 0.80, 0.0]),
)
MEANS_MM = np.array([0.05, 0.12, 0.15, 0.08])


def flat(thickness: np.ndarray) -> Path:
    return Path(lambda at: np.tile(thickness, (len(at), 1)), 0.8, 0.7, -0.6)


def uneven(seed: int) -> Path:
    """A column whose layers vary over about 0.3 mm, as the iris maps are band-limited."""
    rng = np.random.Generator(np.random.PCG64(seed))
    noise = ndimage.gaussian_filter1d(rng.random((400, 4)), 30, axis=0)
    noise = (noise - noise.mean(axis=0)) / noise.std(axis=0)
    layers = np.clip(MEANS_MM * (1 + 0.35 * noise), 0.005, None)
    x = np.linspace(0, 1.5, 400)
    return Path(
        lambda at: np.stack([np.interp(at, x, layers[:, k]) for k in range(4)], axis=1),
        view_cosine=float(rng.uniform(0.65, 1)),
        light_cosine=float(rng.uniform(0.5, 1)),
        phase_cosine=float(rng.uniform(-1, -0.3)),
    )


@pytest.fixture(scope="module")
def errors() -> dict[str, np.ndarray]:
    """Relative errors against 3000 midpoint steps over 24 uneven columns."""
    found: dict[str, list[np.ndarray]] = {}
    for seed in range(24):
        path = uneven(seed)
        truth = midpoint_sum(path, ORGANIC, samples=3000)
        for name, value in {
            "left 10": left_sum(path, ORGANIC, samples=10),
            "left 200": left_sum(path, ORGANIC, samples=200),
            "pieces 6": piecewise_linear(path, ORGANIC, nodes=6),
            "pieces 8": piecewise_linear(path, ORGANIC, nodes=8),
        }.items():
            found.setdefault(name, []).append(value / truth - 1)
    return {name: np.array(values) for name, values in found.items()}


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def test_one_layer_has_the_closed_form() -> None:
    """Extinction along view and light path in a homogeneous slab integrates by hand."""
    slab = Tissue(np.full((4, 3), 3.0), np.full((4, 3), 5.0), np.zeros(4))
    path = flat(np.array([0.1, 0.1, 0.1, 0.1]))
    rate = 5.0 * (1 + 0.8 / 0.7)
    length = 0.4 / 0.8
    expected = 3.0 / (4 * math.pi) / 0.7 * (1 - math.exp(-rate * length)) / rate
    np.testing.assert_allclose(piecewise_linear(path, slab, nodes=6), expected, rtol=1e-6)
    np.testing.assert_allclose(midpoint_sum(path, slab, samples=4000), expected, rtol=1e-3)


def test_the_thesiss_sum_is_too_bright(errors: dict[str, np.ndarray]) -> None:
    assert 0.10 < errors["left 10"].mean() < 0.35
    assert errors["left 10"].min() > 0
    assert 0.004 < errors["left 200"].mean() < 0.03


def test_eight_nodes_beat_two_hundred_samples(errors: dict[str, np.ndarray]) -> None:
    assert rms(errors["pieces 8"]) < 0.01
    assert rms(errors["pieces 8"]) < 0.5 * rms(errors["left 200"])
    assert abs(errors["pieces 8"].mean()) < 0.003


def test_six_nodes_stay_within_three_percent(errors: dict[str, np.ndarray]) -> None:
    assert rms(errors["pieces 6"]) < 0.03
    assert rms(errors["pieces 6"]) < 0.2 * rms(errors["left 10"])


def test_the_phase_function_is_normalised() -> None:
    cosines = (np.arange(20000) + 0.5) / 10000 - 1
    for g in (0.0, 0.3, 0.8):
        values = [float(henyey_greenstein(c, np.array(g))) for c in cosines[10::20]]
        assert np.mean(values) * 4 * math.pi == pytest.approx(1.0, rel=2e-3)


def test_the_gain_makes_the_mean_column_white() -> None:
    gain = subsurface_gain(MEANS_MM, ORGANIC)
    path = Path(lambda at: np.tile(MEANS_MM, (len(at), 1)), 1.0, 1.0, -1.0)
    np.testing.assert_allclose(
        math.pi * gain * midpoint_sum(path, ORGANIC, samples=4000), 1.0, rtol=0.005
    )


def test_thicker_pigment_in_front_darkens() -> None:
    pigment = Tissue(
        ORGANIC.sigma_s, ORGANIC.sigma_t + np.array([[20.0], [0], [0], [0]]), np.zeros(4)
    )
    thin = piecewise_linear(flat(np.array([0.01, 0.2, 0.2, 0.05])), pigment, nodes=8)
    thick = piecewise_linear(flat(np.array([0.06, 0.2, 0.2, 0.05])), pigment, nodes=8)
    assert (thick < 0.8 * thin).all()
