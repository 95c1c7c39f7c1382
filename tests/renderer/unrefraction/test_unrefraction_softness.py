"""The limbus's softness says which way up an eye is."""

from __future__ import annotations

import math

import numpy as np
import pytest

from renderer.unrefraction.ellipse import Ellipse
from renderer.unrefraction.softness import EVEN, WAVE, Softness, find_softness

RAYS = 240
LIMBUS = Ellipse(300.0, 280.0, 240.0, 228.0, -0.3)


def sides(roll: float, *, wander: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Return the edge's inner and outer points as the law has them, 3 % of the radius apart."""
    t = np.arange(RAYS) / RAYS * 2 * np.pi
    along = np.stack([np.cos(t), -np.sin(t)], axis=1)
    at = LIMBUS.radius_at(-t)[:, None]
    width = 0.03 * (1.0 - WAVE * np.cos(2 * (t - roll)) + wander * np.sin(7 * t))[:, None]
    middle = [LIMBUS.x, LIMBUS.y]
    return middle + at * (1 - width / 2) * along, middle + at * (1 + width / 2) * along


def measured(inner: np.ndarray, outer: np.ndarray) -> Softness | None:
    return find_softness(inner, outer, LIMBUS, rays=RAYS, tolerance=5.0)


def told_roll(softness: Softness) -> float:
    rolls = np.radians(np.arange(-90.0, 90.0, 0.5))
    return float(rolls[np.argmin([np.sum(softness.errors(r) ** 2) for r in rolls])])


@pytest.mark.parametrize("roll_deg", [-30.0, 0.0, 17.0, 60.0])
def test_the_softest_parts_of_the_edge_say_which_way_is_up(roll_deg: float) -> None:
    found = measured(*sides(math.radians(roll_deg), wander=0.1))
    assert found is not None
    assert math.degrees(told_roll(found)) == pytest.approx(roll_deg, abs=1.5)
    assert np.abs(found.errors(math.radians(roll_deg))).max() < 0.3
    assert np.abs(found.errors(math.radians(roll_deg + 90.0))).max() > 3.0


def test_lids_leave_less_to_say_and_are_no_edge() -> None:
    inner, outer = sides(math.radians(17.0), wander=0.1)
    clean = measured(inner, outer)
    up = np.abs(inner[:, 1] - LIMBUS.y) > 0.7 * LIMBUS.radius
    lidded = [np.where(up[:, None], p * [1.0, 0.8] + [0.0, 56.0], p) for p in (inner, outer)]
    covered = measured(*lidded)
    assert clean is not None
    assert covered is not None
    assert np.linalg.norm(covered.weight) < 0.8 * np.linalg.norm(clean.weight)
    assert np.linalg.norm(clean.weight) < math.sqrt(2.0) / EVEN
    assert math.degrees(told_roll(covered)) == pytest.approx(17.0, abs=8.0)
    few = np.arange(RAYS) < 50
    assert measured(inner[few], outer[few]) is None, "50 rays are no limbus"
