"""S-CIELAB: plain areas differ as CIEDE2000 says, and what is too fine to see does not count."""

from __future__ import annotations

import numpy as np
import pytest
from skimage.color import deltaE_ciede2000, rgb2lab

from renderer.lod.visibility import visible_difference


def plain(*colour: int) -> np.ndarray:
    return np.broadcast_to(np.array(colour, np.uint8), (40, 80, 3)).copy()


def test_plain_areas_differ_as_their_colours_do() -> None:
    one, other = plain(120, 110, 100), plain(124, 110, 103)
    plainly = deltaE_ciede2000(*(rgb2lab(p[:1, :1] / 255.0) for p in (one, other)))[0, 0]
    assert visible_difference(one, other) == pytest.approx(plainly, rel=1e-3)
    assert visible_difference(one, one) == 0.0


def test_fine_grain_is_seen_less_than_a_coarse_pattern() -> None:
    x = np.arange(80)
    fine, coarse = plain(120, 120, 120), plain(120, 120, 120)
    fine[:, x % 2 == 0] += 10
    coarse[:, x % 40 < 20] += 10
    flat = plain(125, 125, 125)
    assert visible_difference(fine, flat) < 0.2 * visible_difference(coarse, flat)
