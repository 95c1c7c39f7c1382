"""PSNR and SSIM against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from renderer.encoding.fidelity import psnr_db, ssim


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
