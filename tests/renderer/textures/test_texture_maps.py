"""Maps: box filter, normals from a known slope, compact storage, colour encoding."""

from __future__ import annotations

import numpy as np
import pytest

from renderer.colour import linear_to_srgb, srgb_to_linear
from renderer.textures.sizes import (
    check_size,
    normals_from_height,
    pack_albedo,
    pack_range,
    shrink,
    smoothstep,
    unpack_albedo,
    unpack_range,
)


def test_shrinking_takes_means_of_blocks() -> None:
    field = np.arange(16, dtype=np.float32).reshape(4, 4)
    np.testing.assert_array_equal(shrink(field, 2), [[2.5, 4.5], [10.5, 12.5]])
    assert shrink(np.ones((8, 8, 3), np.float32), 1).shape == (1, 1, 3)


def test_a_slope_to_the_right_tilts_the_normal_to_the_left() -> None:
    height = np.tile(np.arange(8, dtype=np.float32) * 0.1, (8, 1))
    normal = normals_from_height(height, 0.1)
    np.testing.assert_allclose(normal[4, 4], [-np.sqrt(0.5), 0.0, np.sqrt(0.5)], atol=1e-6)
    upwards = normals_from_height(np.ascontiguousarray(height.T), 0.1)
    assert upwards[4, 4, 1] < -0.7


def test_packing_keeps_dark_albedo_exact_to_a_thousandth() -> None:
    albedo = np.geomspace(0.002, 0.95, 500).astype(np.float32)
    np.testing.assert_allclose(unpack_albedo(pack_albedo(albedo)), albedo, rtol=1e-3)


def test_packing_a_range_is_exact_to_its_step() -> None:
    field = np.linspace(0.0, 0.6, 777).astype(np.float32)
    np.testing.assert_allclose(unpack_range(pack_range(field, 0.6), 0.6), field, atol=6e-6)


def test_smoothstep_runs_either_way() -> None:
    x = np.array([0.0, 1.0, 2.0, 3.0], np.float32)
    np.testing.assert_allclose(smoothstep(1.0, 2.0, x), [0, 0, 1, 1])
    np.testing.assert_allclose(smoothstep(2.0, 1.0, x), [1, 1, 0, 0])


def test_srgb_goes_there_and_back() -> None:
    codes = np.arange(256)
    np.testing.assert_allclose(linear_to_srgb(srgb_to_linear(codes)) * 255.0, codes, atol=0.01)
    assert float(srgb_to_linear(128)) == pytest.approx(0.2159, abs=1e-4)


def test_sizes_are_powers_of_two_up_to_the_largest() -> None:
    check_size(64, 64)
    with pytest.raises(ValueError, match="128 is no map size; choose a power of two from 1 to 64"):
        check_size(128, 64)
