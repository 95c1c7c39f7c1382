"""PSNR and SSIM against closed forms; rectangles that hold the eyes."""

from __future__ import annotations

import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.clip_values import DISTANCES
from renderer.detail import Detail
from renderer.encoding.fidelity import eye_rectangles, psnr_db, ssim

LOW = Detail.uniform("low")


def test_psnr_of_a_constant_error_is_its_closed_form() -> None:
    a = np.full((16, 16, 3), 100, np.uint8)
    assert psnr_db(a, a + 5) == pytest.approx(20 * np.log10(255 / 5))
    assert psnr_db(a, a) == 99.0


def test_ssim_of_flat_patches_is_its_luminance_term() -> None:
    a, b = np.full((32, 32, 3), 100, np.uint8), np.full((32, 32, 3), 120, np.uint8)
    c1 = (0.01 * 255) ** 2
    assert ssim(a, b) == pytest.approx((2 * 100 * 120 + c1) / (100**2 + 120**2 + c1), rel=1e-6)
    noise = np.random.default_rng(3).integers(0, 255, (32, 32, 3)).astype(np.uint8)
    assert ssim(noise, noise) == pytest.approx(1.0)
    assert ssim(noise, noise[::-1]) < 0.3


@pytest.mark.parametrize("distance", DISTANCES)
def test_rectangles_stay_on_the_picture_and_do_not_overlap(distance: str) -> None:
    spec = ClipSpec(left=LOW, right=LOW, distance=distance)
    for azimuth in (-60.0, 0.0, 60.0):
        (rows_l, cols_l), (rows_r, cols_r) = eye_rectangles(spec, azimuth)
        for rows, cols in ((rows_l, cols_l), (rows_r, cols_r)):
            assert 0 <= rows.start < rows.stop <= spec.height
            assert 0 <= cols.start < cols.stop <= spec.width
        assert (cols_l.start + cols_l.stop) < (cols_r.start + cols_r.stop)
