"""Drawing tubes: place, width, order and smooth edges."""

from __future__ import annotations

import numpy as np

from renderer.textures.tubes import Tubes, draw_tubes, join_tubes


def straight(*, y_mm: float, half_width_mm: float, crest: float, tone: float) -> Tubes:
    """Return one tube from x = -0.8 to 0.8 mm."""
    x = np.arange(-0.8, 0.8, 0.01).astype(np.float32)
    same = np.ones_like(x)
    return Tubes(
        x_mm=x,
        y_mm=y_mm * same,
        half_width_mm=half_width_mm * same,
        crest=crest * same,
        drop=0.5 * same,
        tone=tone * same,
        tube=np.zeros(x.size, np.int64),
    )


def test_a_tube_lies_where_its_points_are_with_its_width() -> None:
    tube = straight(y_mm=0.25, half_width_mm=0.1, crest=0.8, tone=0.5)
    height, tone = draw_tubes(tube, 200, half_size_mm=1.0)
    column = height[:, 100]
    assert abs(np.argmax(column) - 124.5) < 1.0
    assert abs((column > 0.35).sum() * 0.01 - 0.2) < 0.03
    assert abs(column.max() - 0.8) < 0.02
    assert abs(tone[124, 100] - 0.5) < 0.01
    assert height[:, :15].max() == 0.0


def test_there_is_no_gap_along_a_slanting_tube() -> None:
    s = np.arange(-0.7, 0.7, 0.008).astype(np.float32)
    same = np.ones_like(s)
    tube = Tubes(s, 0.6 * s, 0.03 * same, same, 0.5 * same, same, np.zeros(s.size, np.int64))
    height, _ = draw_tubes(tube, 200, half_size_mm=1.0)
    assert height[:, 40:160].max(axis=0).min() > 0.8


def test_the_higher_tube_wins_whatever_the_order() -> None:
    low = straight(y_mm=0.0, half_width_mm=0.2, crest=0.4, tone=0.1)
    high = straight(y_mm=0.0, half_width_mm=0.05, crest=0.9, tone=0.9)
    there = draw_tubes(join_tubes([low, high]), 128, half_size_mm=1.0)
    back = draw_tubes(join_tubes([high, low]), 128, half_size_mm=1.0)
    np.testing.assert_array_equal(there[0], back[0])
    np.testing.assert_array_equal(there[1], back[1])
    assert there[1][64, 64] > 0.8
    assert there[1][75, 64] < 0.2


def test_joined_tubes_keep_apart() -> None:
    one = straight(y_mm=0.0, half_width_mm=0.1, crest=0.5, tone=0.5)
    joined = join_tubes([one, one, one])
    assert joined.tube[-1] == 2
    assert (np.diff(joined.tube) >= 0).all()


def test_what_lies_outside_the_square_is_left_out() -> None:
    tube = straight(y_mm=3.0, half_width_mm=0.2, crest=0.9, tone=0.9)
    height, _ = draw_tubes(tube, 64, half_size_mm=1.0)
    assert height.max() == 0.0
