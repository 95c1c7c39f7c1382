"""The geometry of card, blind spot and angles: round trips, known cases, outliers, uncertainty."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from study.design.viewing import (
    BLIND_SPOT_DEG,
    BLIND_SPOT_ERROR,
    CARD_WIDTH_MM,
    LEFT_EYE_MM,
    Measured,
    angle_deg,
    arc_minutes,
    distance_from_blind_spot,
    distance_of,
    robust,
    scale_from_card,
    scale_from_diagonal,
    scale_shown,
)


def dot_of(distance_mm: float, mark_mm: float) -> float:
    """Return where the dot vanishes for an eye at 0 that looks at a mark to its right."""
    seen_deg = math.degrees(math.atan2(mark_mm, distance_mm))
    return distance_mm * math.tan(math.radians(seen_deg - BLIND_SPOT_DEG))


@given(st.floats(200, 2500), st.floats(-0.05, 0.5))
def test_the_distance_comes_back_wherever_the_mark_stands(distance: float, share: float) -> None:
    mark = share * distance
    assert distance_of(mark, dot_of(distance, mark)) == pytest.approx(distance, rel=1e-9)


def test_a_mark_straight_ahead_is_the_textbooks_case() -> None:
    apart = 600 * math.tan(math.radians(BLIND_SPOT_DEG))
    assert distance_of(0.0, -apart) == pytest.approx(600)
    # Middle between both: twice the half angle, and not the tangent of the whole.
    half = 600 * math.tan(math.radians(BLIND_SPOT_DEG / 2))
    assert distance_of(half, -half) == pytest.approx(600)
    assert 2 * half / math.tan(math.radians(BLIND_SPOT_DEG)) == pytest.approx(592, abs=1)


def test_places_that_cannot_be_are_refused() -> None:
    with pytest.raises(ValueError, match=r"the dot lies 20\.0 mm to the right of the fixation"):
        distance_of(10.0, 30.0)
    with pytest.raises(ValueError, match="so far aside that no distance gives their angle"):
        distance_of(1000.0, 990.0)


def test_a_card_gives_the_size_of_a_pixel_and_how_well_it_is_known() -> None:
    found = scale_from_card([342.4, 342.4])
    assert found.value == pytest.approx(0.25)
    # Half a millimetre of setting in 85.6, twice: 0.41 %.
    assert found.se / found.value == pytest.approx(0.5 / CARD_WIDTH_MM / math.sqrt(2))
    assert scale_from_card([330, 355]).se > 3 * found.se


def test_a_diagonal_gives_the_size_of_a_pixel() -> None:
    found = scale_from_diagonal(24.0, (1920, 1080))
    assert found.value == pytest.approx(0.2767, abs=1e-4)
    assert found.se / found.value == pytest.approx(0.02)


def test_one_press_far_off_does_not_count() -> None:
    found, counts = robust([600, 604, 598, 601, 910])
    assert counts == (True, True, True, True, False)
    assert found.value == pytest.approx(600.5)
    assert robust([600] * 5) == (Measured(600, 0.0), (True,) * 5)


def test_five_presses_give_the_distance_and_people_are_most_of_its_error() -> None:
    scale = Measured(0.25, 0.001)
    rng = np.random.default_rng(5)
    for distance in (450.0, 600.0, 1200.0):
        mark = distance * math.tan(math.radians(BLIND_SPOT_DEG / 2))
        dots = rng.normal(dot_of(distance, mark + LEFT_EYE_MM) - LEFT_EYE_MM, 1.5, 5)
        places = [(mark / 0.25, dot / 0.25) for dot in dots]
        found, counts = distance_from_blind_spot(places, scale)
        assert found.value == pytest.approx(distance, rel=0.02)
        assert found.se / found.value == pytest.approx(BLIND_SPOT_ERROR, rel=0.05)
        assert len(counts) == 5
    # What others measured: 3.25 cm off on average at 43 to 66 cm (Li et al. 2020).
    assert pytest.approx(3.25, abs=0.05) == 0.8 * BLIND_SPOT_ERROR * 55


def test_the_angle_of_an_iris_and_its_error() -> None:
    exact = Measured(1.0, 0.0)
    angle = angle_deg(
        160, shown_scale=exact, mm_per_px=Measured(0.25, 0.0), distance_mm=Measured(600, 44.4)
    )
    assert angle.value == pytest.approx(math.degrees(2 * math.atan(20 / 600)))
    assert angle.se / angle.value == pytest.approx(0.074, rel=0.01)
    smaller = angle_deg(
        160,
        shown_scale=Measured(0.5, 0.01),
        mm_per_px=Measured(0.25, 0.0),
        distance_mm=Measured(600, 0.0),
    )
    assert smaller.value == pytest.approx(angle.value / 2, rel=1e-3)
    assert smaller.se / smaller.value == pytest.approx(0.02, rel=0.01)


@given(st.floats(1, 2000), st.floats(0.05, 1.0), st.floats(200, 2000), st.floats(0.01, 0.2))
def test_the_angles_error_is_what_a_shift_of_the_distance_does(
    size: float, scale: float, distance: float, share: float
) -> None:
    def angle(at: float) -> Measured:
        return angle_deg(
            size,
            shown_scale=Measured(1.0, 0.0),
            mm_per_px=Measured(scale, 0.0),
            distance_mm=Measured(at, share * distance),
        )

    step = 1e-4 * distance
    slope = (angle(distance + step).value - angle(distance - step).value) / (2 * step)
    assert angle(distance).se == pytest.approx(abs(slope) * share * distance, rel=1e-3)


def test_two_pixels_of_a_common_screen_are_three_arc_minutes() -> None:
    assert arc_minutes(2, mm_per_px=0.25, distance_mm=600) == pytest.approx(2.865, abs=0.001)


def test_the_shown_scale_is_the_last_plays_and_varies_with_the_plays() -> None:
    assert scale_shown([], width_px=1280) is None
    steady = scale_shown([1.0, 1.0], width_px=1280)
    assert steady is not None
    assert steady.value == 1.0
    assert 0 < steady.se < 1e-5
    changed = scale_shown([1.0, 0.8], width_px=1280)
    assert changed is not None
    assert (changed.value, round(changed.se, 3)) == (0.8, 0.1)


def test_a_small_laptop_reaches_beyond_a_metre() -> None:
    # 1366 pixels on 309 mm, mark and dot 24 pixels from either end: twice what a chair needs.
    half = (1366 / 2 - 24) * 309 / 1366
    assert distance_of(half + LEFT_EYE_MM, LEFT_EYE_MM - half) == pytest.approx(1240, abs=20)
